"""Cutting of blocks into pieces, and sums with the same bits as one addition at a time."""

import numpy as np


def pieces(ends):
    """
    Yield (first, stop) of the pieces of a block.

    Parameters
    ----------
    ends : (n,) bool, whether a sample is the last one of a piece; the last sample of the block
        always ends one
    """
    edges = [0, *(np.flatnonzero(ends) + 1).tolist()]
    if edges[-1] < len(ends):
        edges.append(len(ends))
    yield from zip(edges[:-1], edges[1:])


def in_order(total, values):
    """Return floats (m,) plus values (m, n), added one after the other."""
    sums = np.cumsum(np.column_stack((total, values)), axis=1)
    return tuple(sums[:, -1].tolist())
