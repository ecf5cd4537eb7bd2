"""
Reduce the number of points of a curve for drawing without losing its extremes.

A curve is divided into stretches with equal numbers of points. The first and last points of each
stretch and those with the smallest and largest x and y are kept, in their order. A spike of a
single sample therefore stays visible. If a stretch is not wider than a pixel, the curve looks the
same as with all points.
"""

import numpy as np

# Number of stretches, at least the width of a figure in pixels; each keeps at most six points.
STRETCHES = 1000


def kept_points(x, y, stretches=STRETCHES):
    """
    Return the indices of the points of a curve that are drawn, ascending.

    If x or y (n,) is not finite somewhere in a stretch, the first such point is kept too, so that
    the curve is interrupted there.
    """
    count = len(x)
    size = -(-count // stretches)
    if size <= 6:
        return np.arange(count)
    bounds = np.arange(0, count, size)
    # The last stretch is filled up with its last point.
    index = np.minimum(bounds[:, None] + np.arange(size), count - 1)
    gaps = ~(np.isfinite(x) & np.isfinite(y))
    kept = [bounds, index[:, -1]]
    rows = np.arange(len(bounds))
    for values in (x, y):
        low = np.where(gaps, np.inf, values)[index]
        kept.append(index[rows, low.argmin(axis=1)])
        high = np.where(gaps, -np.inf, values)[index]
        kept.append(index[rows, high.argmax(axis=1)])
    if gaps.any():
        kept.append(index[rows, gaps[index].argmax(axis=1)])
    return np.unique(np.concatenate(kept))


def thinned_curve(x, y, stretches=STRETCHES):
    """Return x, y as float arrays without the points that are not drawn."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    kept = kept_points(x, y, stretches)
    return x[kept], y[kept]


def band_points(x, low, high):
    """Return the indices of the points that are drawn of the band between two curves."""
    return np.union1d(kept_points(x, low), kept_points(x, high))
