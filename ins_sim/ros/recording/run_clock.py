"""When a recorded message is logged: at its stamp, or when it came.  No ROS is imported."""

from ins_sim.messages.cdr import LAYOUTS, STAMP_END_NS, stamp_of

JUMP_NS = 1_000_000_000


def is_stamped(type_name):
    """Return whether messages of a type are logged at a stamp they carry."""
    return type_name in LAYOUTS


class RunClock:
    """
    The time of a run as its stamps tell it, for the messages that have none.

    It is the newest stamp heard, and runs on with the time of reception until the next one.
    """

    def __init__(self):
        self._stamp_ns = self._received_ns = None

    def hear(self, data, received_ns):
        """
        Return the stamp of a message, ns, or None if a bag cannot hold it.

        The first stamps of a run may jitter to before the epoch: they count as zero.
        """
        stamp_ns = stamp_of(data)
        if stamp_ns is None or not -JUMP_NS < stamp_ns < STAMP_END_NS:
            return None
        stamp_ns = max(stamp_ns, 0)
        newest = self._stamp_ns
        # topics lag behind one another; but a run that starts anew takes the clock along
        if newest is None or stamp_ns > newest or stamp_ns < newest - JUMP_NS:
            self._stamp_ns, self._received_ns = stamp_ns, received_ns
        return stamp_ns

    def now(self, received_ns):
        """Return the time of the run at a time of reception, ns; None before the first stamp."""
        if self._stamp_ns is None:
            return None
        return self._stamp_ns + max(0, received_ns - self._received_ns)
