"""Histories made of blocks: joined in memory, or by any other object with the same two methods."""

import numpy as np


class Collected:
    """
    Joins the blocks of a history in memory.

    The columns are joined one after the other, each losing its blocks, so that the whole history
    is there at most once and one column twice.
    """

    def __init__(self):
        self._kind, self._columns = None, {}

    def append(self, block):
        """Take the next block, a History."""
        self._kind = type(block)
        for name, values in block.arrays().items():
            # a column of a wider table would keep the whole table
            self._columns.setdefault(name, []).append(np.ascontiguousarray(values))

    def history(self):
        """Return the History of all blocks, or None where there was none."""
        if self._kind is None:
            return None
        return self._kind(**{name: np.concatenate(self._columns.pop(name))
                             for name in list(self._columns)})
