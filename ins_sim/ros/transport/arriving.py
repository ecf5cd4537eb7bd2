"""Delay fixes until they have arrived, judged by stamps. This module does not import ROS."""

from collections import deque


class Arriving:
    """
    Stage that holds back the fixes of a sensor until the truth has reached their arrival_ns.

    It raises StreamFault when the sensor does.
    """

    def __init__(self, instrument):
        self.instrument = instrument
        self._waiting = deque()
        self._now_ns = None

    def reset(self):
        """Reset the sensor, and discard the fixes that have not arrived yet."""
        self.instrument.reset()
        self._waiting.clear()
        self._now_ns = None

    def advance(self, t_ns, push, *sample):
        """Call push(t_ns, *sample) with a truth sample; return the fixes that have arrived."""
        fixes = push(t_ns, *sample)
        self._now_ns = t_ns
        return self.add(fixes)

    def add(self, fixes):
        """Add new fixes; return those that have arrived, in order."""
        waiting = self._waiting
        for fix in fixes:
            # Lock-step may repeat the first sample and thus its fix.
            if not waiting or fix.t_ns > waiting[-1].t_ns:
                waiting.append(fix)
        due = []
        while waiting and self._now_ns is not None and waiting[0].arrival_ns <= self._now_ns:
            due.append(waiting.popleft())
        return due
