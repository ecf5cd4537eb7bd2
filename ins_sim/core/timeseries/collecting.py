"""Histories collected in blocks: joined in memory, or by another object with the same methods."""

import numpy as np


class Collected:
    """
    Joins the blocks of a history in memory.

    The columns are joined one after the other and release their blocks, so that memory holds the
    history once, plus one column.
    """

    def __init__(self):
        self._kind, self._columns = None, {}

    def append(self, block):
        """Add the next block, a History."""
        self._kind = type(block)
        for name, values in block.arrays().items():
            # Copy a column of a wider table; a view would keep the whole table in memory.
            self._columns.setdefault(name, []).append(np.ascontiguousarray(values))

    def history(self):
        """Return the History of all blocks, or None if there was none."""
        if self._kind is None:
            return None
        return self._kind(**{name: np.concatenate(self._columns.pop(name))
                             for name in list(self._columns)})
