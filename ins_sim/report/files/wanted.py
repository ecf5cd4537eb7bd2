"""Options for the files of a run: which are written, and how many instants they contain."""

from dataclasses import dataclass, replace
import operator

import numpy as np


@dataclass(frozen=True)
class WantedFiles:
    """
    Files written for a run in addition to its tables and figures.

    Raises ValueError if ``thin`` is not a whole number of at least 1.

    Attributes
    ----------
    thin : the files contain every thin-th output instant, beginning with the first
    csv : whether to write CSV tables too
    tum : whether to write trajectories for evo too
    """

    thin: int = 1
    csv: bool = False
    tum: bool = False

    def __post_init__(self):
        """Check thin."""
        try:
            least = operator.index(self.thin) >= 1
        except TypeError:
            least = False
        if not least or isinstance(self.thin, bool):
            raise ValueError(f'thin is {self.thin!r}; expected a whole number of at least 1')

    def kept(self, result, names=('truth', 'states', 'errors', 'twin')):
        """Return a result whose named records contain only every thin-th instant."""
        records = {name: getattr(result, name, None) for name in names}
        return result if self.thin == 1 else replace(result, **{
            name: _every(record, self.thin) for name, record in records.items()
            if record is not None})

    def lines(self, result):
        """Return a list with a line about the thinning of the files; empty without thinning."""
        count = len(result.errors)
        if self.thin == 1:
            return []
        return [f'the files hold {len(range(0, count, self.thin))} of {count} output instants '
                f'(thin {self.thin}) and every reading of the IMU; tables and figures use '
                'all instants']


class EveryNth:
    """Every n-th row of a column in a file, from the first one on; slices of it are arrays."""

    def __init__(self, column, step):
        self._column, self._step, self.dtype = column, step, column.dtype

    def __len__(self):
        return len(range(0, len(self._column), self._step))

    @property
    def shape(self):
        """Return the shape of the whole array."""
        return len(self), *self._column.shape[1:]

    def __getitem__(self, index):
        start, stop, step = index.indices(len(self))
        return self._column[start * self._step:stop * self._step:step * self._step]


def _every(history, step):
    return type(history)(**{
        name: values[::step] if isinstance(values, np.ndarray) else EveryNth(values, step)
        for name, values in history.arrays().items()})
