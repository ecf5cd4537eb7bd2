"""Extract curves from a history that may not fit into memory."""

import numpy as np

from ..charts.thinning import kept_points, STRETCHES

# Number of rows read at once.
BLOCK = 65536


class HistoryDifference:
    """Difference of two Histories with the same instants, computed block by block."""

    def __init__(self, one, other):
        self._one, self._other, self.t_ns = one, other, one.t_ns

    def __len__(self):
        return len(self._one)

    def blocks(self, length):
        """Yield the difference in blocks of consecutive rows."""
        for one, other in zip(self._one.blocks(length), self._other.blocks(length)):
            taken = other.arrays()
            yield type(one)(t_ns=one.t_ns, **{
                name: values - taken[name] for name, values in one.arrays().items()
                if name != 't_ns'})


def history_curves(history, columns):
    """
    Return {name: [(t_ns, values), ...]} of the columns of a History, thinned.

    columns: {name: function of a block of the history that returns (n, k) values}. Each column
    keeps the extremes of at least STRETCHES stretches (``charts.thinning``).
    """
    found, count = {}, len(history)
    for block in history.blocks(BLOCK):
        # The curve is thinned again when it is drawn, to stretches with other borders; twice as
        # many stretches here leave enough points for that.
        stretches = max(1, -(-2 * STRETCHES * len(block) // count))
        t_ns = block.t_ns[:]
        # The times as floats serve only to select the points.
        t = (t_ns - t_ns[0]).astype(float)
        for name, values in columns.items():
            for k, column in enumerate(values(block).T):
                kept = kept_points(t, column, stretches)
                found.setdefault((name, k), []).append((t_ns[kept], column[kept]))
    curves = {}
    for (name, _), parts in found.items():
        curves.setdefault(name, []).append(
            tuple(np.concatenate(arrays) for arrays in zip(*parts)))
    return curves


def interpolated(t_s, t_known, values, column, block=BLOCK):
    """
    Interpolate a column of values (n, k), given at times t_known (n,), linearly at times t_s (m,).

    Both times ascend. t_known and values may be columns in a file, which are read block by block.
    Outside the range of t_known the result is NaN.
    """
    result = np.full(len(t_s), np.nan)
    for first in range(0, len(t_known), block):
        # Read one row more, so that the interval between two blocks is included.
        known = t_known[first:first + block + 1]
        low, high = np.searchsorted(t_s, known[0]), np.searchsorted(t_s, known[-1], 'right')
        result[low:high] = np.interp(t_s[low:high], known,
                                     values[first:first + block + 1][:, column])
    return result
