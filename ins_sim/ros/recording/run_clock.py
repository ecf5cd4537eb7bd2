"""
Determine the log time of recorded messages: the stamp, or the time of reception.

This module does not import ROS.
"""

from ins_sim.messages.cdr import LAYOUTS, STAMP_END_NS, stamp_of

JUMP_NS = 1_000_000_000


def is_stamped(type_name):
    """Return whether messages of a type are logged at their own stamps."""
    return type_name in LAYOUTS


class RunClock:
    """
    Time of a run derived from its stamps, for messages that have no stamp.

    It is the newest stamp received, advanced by the wall time since its reception.
    """

    def __init__(self):
        self._stamp_ns = self._received_ns = None

    def hear(self, data, received_ns):
        """
        Return the stamp of a message, ns, or None if a bag cannot store it.

        Jitter may put the first stamps of a run before the epoch; they are set to zero.
        """
        stamp_ns = stamp_of(data)
        if stamp_ns is None or not -JUMP_NS < stamp_ns < STAMP_END_NS:
            return None
        stamp_ns = max(stamp_ns, 0)
        newest = self._stamp_ns
        # A slightly older stamp is that of a topic that lags; a jump back is a new run.
        if newest is None or stamp_ns > newest or stamp_ns < newest - JUMP_NS:
            self._stamp_ns, self._received_ns = stamp_ns, received_ns
        return stamp_ns

    def now(self, received_ns):
        """Return the run time at a time of reception, ns, or None before the first stamp."""
        if self._stamp_ns is None:
            return None
        return self._stamp_ns + max(0, received_ns - self._received_ns)
