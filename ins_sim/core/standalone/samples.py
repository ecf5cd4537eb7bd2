"""Live samples of an IMU: their order, and the step of their stamps."""

from typing import NamedTuple

import numpy as np

from ins_sim.core.postprocessing.imu_record import RecordedImu

# Number of steps whose median is the typical step.
MOST_STEPS = 1000
# Number of consecutive samples older than the newest one after which the clock has jumped back.
JUMP = 10


class ImuSample(NamedTuple):
    """A sample: stamp, ns; rate, rad/s, and specific force, m/s^2, in b; tag of the caller."""

    t_ns: int
    omega: tuple
    f: tuple
    tag: object = None


def recorded(samples):
    """Return the RecordedImu of ImuSamples."""
    return RecordedImu(np.array([s.t_ns for s in samples], dtype=np.int64),
                       np.array([s.omega for s in samples]), np.array([s.f for s in samples]),
                       np.full((len(samples), 4), np.nan))


class TypicalStep:
    """
    The median of the first MOST_STEPS steps of the stamps.

    ``known`` tells whether there are enough steps.
    """

    FEWEST = 10

    def __init__(self):
        self._steps, self._median = [], None

    def take(self, step_ns):
        """Register a step, ns."""
        if len(self._steps) < MOST_STEPS:
            self._steps.append(step_ns)
            self._median = None

    @property
    def known(self):
        """Return whether there are enough steps."""
        return len(self._steps) >= self.FEWEST

    @property
    def median_ns(self):
        """Return the median step, ns."""
        if self._median is None:
            self._median = float(np.median(self._steps))
        return self._median
