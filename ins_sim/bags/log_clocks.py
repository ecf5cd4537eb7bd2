"""When a file of a bag spans as much as it may, its log times being of one clock or several."""

# log times nearer than this to those of a clock are of that clock
NEAR_NS = 10_000_000_000
MOST = 16
# another clock, or a long silence, begins another file only behind so many messages
LEAST = 100


class LogClocks:
    """
    Tells where another file begins: where one of the clocks has gone on by split_ns.

    Streams of which one is stamped from the start of a computer and another one from 1970 lie
    decades apart; neither makes the file of the other one longer.
    """

    def __init__(self, split_ns):
        self._split_ns, self._near_ns = split_ns, max(split_ns, NEAR_NS)
        # [first in this file or None, last], the newest one last
        self._clocks, self._count = [], 0

    def begins_file(self, log_ns):
        """Take the log time of the next message; return whether another file begins with it."""
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
