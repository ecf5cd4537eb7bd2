"""Fixes that are there later than their instant, by stamps alone.  No ROS is imported."""

from collections import deque


class Arriving:
    """
    An instrument as a stage whose fixes are handed out when the truth has reached arrival_ns.

    Raises StreamFault as the instrument does; reset() is that of both.
    """

    def __init__(self, instrument):
        self.instrument = instrument
        self._waiting = deque()
        self._now_ns = None

    def reset(self):
        """Forget the stream and the fixes on their way."""
        self.instrument.reset()
        self._waiting.clear()
        self._now_ns = None

    def advance(self, t_ns, push, *sample):
        """Return the fixes that are there after the truth of t_ns went to push(t_ns, *sample)."""
        fixes = push(t_ns, *sample)
        self._now_ns = t_ns
        return self.add(fixes)

    def add(self, fixes):
        """Take new fixes; return those that are there, in order."""
        waiting = self._waiting
        for fix in fixes:
            # the first sample may be repeated, and so may be its fix
            if not waiting or fix.t_ns > waiting[-1].t_ns:
                waiting.append(fix)
        due = []
        while waiting and self._now_ns is not None and waiting[0].arrival_ns <= self._now_ns:
            due.append(waiting.popleft())
        return due
