"""Decide when a bag file has reached its time span, with log times of one or several clocks."""

# Log times closer than this to those of a clock belong to that clock.
NEAR_NS = 10_000_000_000
MOST = 16
# Number of messages after which another clock, or a long silence, begins a new file.
LEAST = 100


class LogClocks:
    """
    Decides where a new file begins: when one of the clocks has advanced by split_ns.

    Topics stamped since the start of a computer and topics stamped since 1970 are decades apart;
    this difference does not count as time span of a file.
    """

    def __init__(self, split_ns):
        self._split_ns, self._near_ns = split_ns, max(split_ns, NEAR_NS)
        # [first time in this file or None, last time] of each clock, the most recent clock last.
        self._clocks, self._count = [], 0

    def begins_file(self, log_ns):
        """Return whether a new file begins with the next message, which has this log time."""
        found = None
        for clock in reversed(self._clocks):
            if abs(log_ns - clock[1]) < self._near_ns:
                found = clock
                break
        if found is None:
            found = [None, log_ns]
            begins = self._count >= LEAST
        else:
            self._clocks.remove(found)
            begins = found[0] is not None and log_ns - found[0] >= self._split_ns
        if begins:
            for clock in self._clocks:
                clock[0] = None
            found[0], self._count = None, 0
        self._clocks.append(found)
        del self._clocks[:-MOST]
        found[0] = log_ns if found[0] is None else found[0]
        found[1] = log_ns
        self._count += 1
        return begins
