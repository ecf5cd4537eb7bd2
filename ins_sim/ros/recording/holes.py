"""Count missing samples of a steady stream from its stamps. This module does not import ROS."""

import math

# Steps between stamps are counted in logarithmic classes of this width.
CLASS = 0.02
# A stream is steady if at least this part of its steps is within NEAR (relative) of the usual one.
STEADY, NEAR = 0.5, 0.2
LEAST = 20
# A silence longer than both limits (periods; ns) is a pause, not lost samples.
PAUSE, PAUSE_NS = 1000.0, 10_000_000_000


class Holes:
    """
    Counts the missing samples of a stream, given its usual step.

    The usual step is the median of all steps, which is right while fewer than half of the samples
    are missing. The owner calls ``take`` with every stamp.
    """

    def __init__(self):
        self._last_ns = None
        # {class of the step: [number of steps, their sum in ns]}
        self._classes = {}

    def take(self, stamp_ns):
        """Count the step to a new stamp, ns; after a jump back, start again from that stamp."""
        last_ns, self._last_ns = self._last_ns, stamp_ns
        if last_ns is not None and stamp_ns > last_ns:
            step_ns = stamp_ns - last_ns
            found = self._classes.setdefault(math.ceil(math.log(step_ns) / CLASS), [0, 0])
            found[0] += 1
            found[1] += step_ns

    def count(self):
        """Return the number of missing samples and the usual step, ns; (0, None) if unsteady."""
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
