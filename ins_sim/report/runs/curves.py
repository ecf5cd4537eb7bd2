"""The curves of a history that may be longer than memory."""

import numpy as np

from ..charts.thinning import kept_points, STRETCHES

# Rows that are read at once.
BLOCK = 65536


def history_curves(history, columns):
    """
    Return {name: [(t_ns, values), ...]} of the columns of a History, thinned.

    columns: {name: function of a block of the history that returns (n, k) values}. Each column
    keeps the extremes of at least STRETCHES stretches (``charts.thinning``).
    """
    found, count = {}, len(history)
    for block in history.blocks(BLOCK):
        # Twice as many as are drawn, whose borders lie elsewhere.
        stretches = max(1, -(-2 * STRETCHES * len(block) // count))
        t_ns = block.t_ns[:]
        # Times as floats only choose the points.
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
    Return a column of values (n, k) at times t_s (m,), linearly between those at t_known (n,).

    Both times ascend. t_known and values may be columns in a file, which are read block by block.
    Beyond the ends the result is NaN.
    """
    result = np.full(len(t_s), np.nan)
    for first in range(0, len(t_known), block):
        # One row more, so that no interval is left out between two blocks.
        known = t_known[first:first + block + 1]
        low, high = np.searchsorted(t_s, known[0]), np.searchsorted(t_s, known[-1], 'right')
        result[low:high] = np.interp(t_s[low:high], known,
                                     values[first:first + block + 1][:, column])
    return result
