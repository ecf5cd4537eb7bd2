"""Pairing of two live streams of values by equal stamps."""

import math


class StampPairs:
    """
    Pairs values of a first and a second stream that have the same stamp.

    The streams may have different rates, and either may be ahead. If a stream jumps back, its
    earlier values are forgotten.

    Parameters
    ----------
    depth : number of newest values kept of each stream
    """

    def __init__(self, depth):
        self._depth = depth
        self.clear()

    def clear(self):
        """Forget all values."""
        self._first, self._second = {}, {}

    @property
    def waiting(self):
        """Return whether a value of the first stream may still get its counterpart."""
        return bool(self._first) and max(self._first) > max(self._second, default=-math.inf)

    def push_first(self, t_ns, value):
        """Process a first-stream value; return [(t_ns, first, second)] of the pair, or []."""
        return self._push(self._first, self._second, t_ns, value)

    def push_second(self, t_ns, value):
        """Process a second-stream value; return the same as ``push_first``."""
        return [(t, first, second) for t, second, first in self._push(
            self._second, self._first, t_ns, value)]

    def _push(self, mine, theirs, t_ns, value):
        if mine and t_ns < next(reversed(mine)):
            mine.clear()
        mine[t_ns] = value
        for old in [t for t in theirs if t < t_ns]:
            # An older value already has its counterpart, or will not get one.
            del theirs[old]
        while len(mine) > self._depth:
            del mine[next(iter(mine))]
        return [(t_ns, value, theirs[t_ns])] if t_ns in theirs else []
