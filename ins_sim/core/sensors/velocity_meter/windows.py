"""
The sums of windows that may overlap.

The cycles from one end of a window to the next are a part, summed once.  A window is made of the
last parts of one block of N cycles, the blocks beginning at whole multiples of N, and of the first
parts of the next, so that its sum takes one addition whatever its length, and has the same bits
wherever the meter began.
"""

from typing import Any, NamedTuple

from ins_sim.core.timeseries.fixes import VALID


class Part(NamedTuple):
    """Consecutive cycles: VALID or why they cannot be measured, and their sum where they can."""

    why_not: str
    total: Any


class OpenWindows:
    """
    The windows of N = ``cycles`` cycles that end every ``step`` of them, step a divisor of N.

    method: SignalWindows or SurrogateWindows.
    """

    def __init__(self, method, cycles, step):
        self._method, self._cycles, self._step = method, cycles, step
        self.forget()

    def forget(self):
        """Open no part until the next ``begin``."""
        self.why_not, self._sum, self._is_open = VALID, None, False
        # of the last block: the sum from the start of a part to its end; of this one: its parts
        # and their sum
        self._tails, self._parts, self._head = {}, [], None

    def begin(self):
        """Begin a part."""
        self.why_not, self._sum, self._is_open = VALID, None, True

    @property
    def measures(self):
        """Return whether cycles are added: a part is open, and all of it could be measured."""
        return self._is_open and self.why_not == VALID

    @property
    def adds_blocks(self):
        """Return whether ``add_cycles`` can be called."""
        return hasattr(self._method, 'add_cycles')

    def add(self, index, v_last, v):
        """Add the cycle that ends at index periods; v_last, v: V_x1, V_y1, V_z1 at its ends."""
        self._sum = self._method.add(self._sum, index, v_last, v)

    def add_cycles(self, v):
        """Add cycles; v (3, n + 1): at their ends, m/s."""
        self._sum = self._method.add_cycles(self._sum, v)

    def end(self, index):
        """
        End the part at index periods; return the Part that is the window ending there.

        None, if the window was not seen from its start.
        """
        if not self._is_open:
            return None
        total = None
        if self.why_not == VALID:
            total = self._method.whole(self._sum, index, self._step)
        part = Part(self.why_not, total)
        self._parts.append((index - self._step, part))
        self._head = self._joined(self._head, part)
        if index % self._cycles == 0:
            self._end_block()
            return self._tails.get(index - self._cycles)
        tail = self._tails.get(index - self._cycles)
        return None if tail is None else self._joined(tail, self._head)

    def _end_block(self):
        self._tails, tail = {}, None
        for start, part in reversed(self._parts):
            tail = self._tails[start] = part if tail is None else self._joined(part, tail)
        self._parts, self._head = [], None

    def _joined(self, first, then):
        """Return the Part of two consecutive ones; first may be None."""
        if first is None:
            return then
        for part in (first, then):
            if part.why_not != VALID:
                return part
        return Part(VALID, self._method.joined(first.total, then.total))
