"""
The points of a curve that are drawn: so few that it is quick, and so that no extreme is lost.

A curve is cut into stretches of equal numbers of points. Of each, the first and the last point
stay, and those with the least and the largest abscissa and ordinate, in their order. So a spike
of a single sample stands in the figure, and the curve looks the same as one with all its points
where a stretch is no wider than a pixel.
"""

import numpy as np

# A figure of this many pixels at most; a stretch has six points at most.
STRETCHES = 1000


def kept_points(x, y, stretches=STRETCHES):
    """
    Return the indices of the points that are drawn of a curve, ascending.

    x, y: (n,); where one of them is not finite in a stretch, its first such point stays too, so
    that the curve is interrupted there.
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
    """Return the indices of the points that are drawn of the surface between two curves."""
    return np.union1d(kept_points(x, low), kept_points(x, high))
