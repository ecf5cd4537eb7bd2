"""
Sums over windows that may overlap.

The cycles between the ends of two successive windows form a part, which is summed once. Blocks of
N cycles begin at whole multiples of N. A window consists of the last parts of one block and the
first parts of the next, so its sum needs a single addition whatever its length, and has the same
bits whenever the meter was started.
"""

from typing import Any, NamedTuple

from ins_sim.core.timeseries.fixes import VALID


class Part(NamedTuple):
    """Consecutive cycles: VALID and their sum, or the reason why they cannot be measured."""

    why_not: str
    total: Any


class OpenWindows:
    """
    The windows of N = ``cycles`` cycles that end every ``step`` cycles.

    Parameters
    ----------
    method : SignalWindows or SurrogateWindows
    cycles : N
    step : a divisor of N
    """

    def __init__(self, method, cycles, step):
        self._method, self._cycles, self._step = method, cycles, step
        self.forget()

    def forget(self):
        """Discard all parts; no part is open until the next ``begin``."""
        self.why_not, self._sum, self._is_open = VALID, None, False
        # _tails: of the last block, the sums from the start of each part to the end of the block.
        # _parts, _head: of the present block, the parts and their sum.
        self._tails, self._parts, self._head = {}, [], None

    def begin(self):
        """Open a part."""
        self.why_not, self._sum, self._is_open = VALID, None, True

    @property
    def measures(self):
        """Return whether cycles are to be added: a part is open and measurable so far."""
        return self._is_open and self.why_not == VALID

    @property
    def adds_blocks(self):
        """Return whether ``add_cycles`` can be called."""
        return hasattr(self._method, 'add_cycles')

    def add(self, index, v_last, v):
        """Add the cycle that ends at index periods; v_last, v: V_x1, V_y1, V_z1 at its ends."""
        self._sum = self._method.add(self._sum, index, v_last, v)

    def add_cycles(self, v):
        """Add n cycles; v (3, n + 1): velocities at their ends, m/s."""
        self._sum = self._method.add_cycles(self._sum, v)

    def end(self, index):
        """
        End the part at ``index`` periods and return the Part that is the window ending there.

        The result is None if the start of the window was not seen.
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
        """Return two consecutive Parts as one; first may be None."""
        if first is None:
            return then
        for part in (first, then):
            if part.why_not != VALID:
                return part
        return Part(VALID, self._method.joined(first.total, then.total))
