"""Which files of a run are written, and how many of its instants they hold."""

from dataclasses import dataclass, replace
import operator

import numpy as np


@dataclass(frozen=True)
class WantedFiles:
    """
    What is written of a run beside its tables and figures.

    thin: every how many output instants the files hold, from the first one on; csv: whether
    tables are written too; tum: whether trajectories for evo are.  Raises ValueError where thin
    is no whole number of at least 1.
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
        """Return a result whose records of those names have every thin-th instant."""
        records = {name: getattr(result, name, None) for name in names}
        return result if self.thin == 1 else replace(result, **{
            name: _every(record, self.thin) for name, record in records.items()
            if record is not None})

    def lines(self, result):
        """Return what is to be said of a thinned result."""
        count = len(result.errors)
        if self.thin == 1:
            return []
        return [f'the files hold {len(range(0, count, self.thin))} of {count} output instants '
                f'(every {self.thin}th, thin), and every reading of the IMU; tables and figures '
                'are made of all']


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
