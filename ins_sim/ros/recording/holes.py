"""Samples that are missing in a steady stream, seen by its stamps alone.  No ROS is imported."""

import math

# steps are counted by classes so narrow
CLASS = 0.02
# a stream is steady where so much of its steps is the usual one, give or take NEAR
STEADY, NEAR = 0.5, 0.2
LEAST = 20
# a longer silence is a pause, not samples lost; so many periods and so long
PAUSE, PAUSE_NS = 1000.0, 10_000_000_000


class Holes:
    """
    Counts the samples that a stream lacks against its own usual step.

    The usual step is the middle one of all, so that it is right while fewer than half of the
    samples are missing.  ``take`` is called with every stamp.
    """

    def __init__(self):
        self._last_ns = None
        # class of the step: [how many, their sum]
        self._classes = {}

    def take(self, stamp_ns):
        """Take a stamp, ns; what jumps back starts anew."""
        last_ns, self._last_ns = self._last_ns, stamp_ns
        if last_ns is not None and stamp_ns > last_ns:
            step_ns = stamp_ns - last_ns
            found = self._classes.setdefault(math.ceil(math.log(step_ns) / CLASS), [0, 0])
            found[0] += 1
            found[1] += step_ns

    def count(self):
        """Return the number of samples missing and the usual step, ns; (0, None) if not steady."""
        steps = sum(n for n, _ in self._classes.values())
        if steps < LEAST:
            return 0, None
        seen = 0
        for _, (n, total_ns) in sorted(self._classes.items()):
            seen += n
            if 2 * seen > steps:
                usual_ns = total_ns / n
                break
        means = [(n, total_ns / n) for n, total_ns in self._classes.values()]
        if sum(n for n, mean in means if abs(mean / usual_ns - 1.0) <= NEAR) < STEADY * steps:
            return 0, None
        longest_ns = max(PAUSE * usual_ns, PAUSE_NS)
        missing = sum(n * (round(mean / usual_ns) - 1) for n, mean in means
                      if usual_ns < mean <= longest_ns)
        return missing, usual_ns
