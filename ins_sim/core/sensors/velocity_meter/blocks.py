"""Blocks of samples in pieces, and sums over a piece with the bits of one addition at a time."""

import numpy as np


def pieces(ends):
    """
    Yield first and stop of the pieces of a block.

    ends (n,): whether a sample is the last one of a piece; the last sample of the block is.
    """
    edges = [0, *(np.flatnonzero(ends) + 1).tolist()]
    if edges[-1] < len(ends):
        edges.append(len(ends))
    yield from zip(edges[:-1], edges[1:])


def in_order(total, values):
    """Return floats (m,) and values (m, n) added to them one after the other."""
    sums = np.cumsum(np.column_stack((total, values)), axis=1)
    return tuple(sums[:, -1].tolist())
