"""Covariances on the topics ins/* of an offline run, computed while its messages are written."""

from collections import deque
import warnings

import numpy as np

from ins_sim.core.sensors.imu.with_errors import reported_variances
from ins_sim.core.simulation.free_covariance import (disagreement, published_covariance,
                                                     PublishedCovariance)
from ins_sim.core.simulation.inertial import navigate_blocks


class CovarianceSource:
    """
    PublishedCovariances of a SimulationResult, in the order of its states.

    settings: SimulationSettings; run, motion: the result, and the motion of this run.
    The strapdown runs once more over the readings, together with the covariance, and gives the
    same bits.
    """

    def __init__(self, settings, run, motion):
        sentence = disagreement(settings.strapdown, reported_variances(settings.imu_sensor))
        if sentence:
            warnings.warn(sentence, stacklevel=2)
        self._free = published_covariance(settings.strapdown)
        self._steps, self._show = deque(), self._free.show
        self._free.show = self._note
        self._blocks = navigate_blocks(settings.strapdown, motion, run.imu.blocks(),
                                       covariance=self._free)
        self._done_ns = None

    def _note(self, free):
        self._steps.append(self._show(free))
        return self._steps[-1]

    def at(self, t_ns):
        """Return the PublishedCovariance (arrays of n rows) at instants t_ns (n,) of states."""
        last_ns = int(t_ns[-1]) if len(t_ns) else None
        while last_ns is not None and (self._done_ns is None or self._done_ns < last_ns):
            truth, _, _ = next(self._blocks)
            if len(truth):
                self._done_ns = int(truth.t_ns[-1])
        first_ns = int(t_ns[0]) if len(t_ns) else 0
        while len(self._steps) > 1 and self._steps[1].t_ns <= first_ns:
            self._steps.popleft()
        steps = [step for step in self._steps if last_ns is not None and step.t_ns <= last_ns]
        columns = [np.array(c, dtype=float).reshape(len(steps), width)
                   for c, width in zip(zip(*(step[1:] for step in steps)) if steps else [()] * 4,
                                       (36, 9, 9, 9))]
        stamps = np.array([step.t_ns for step in steps], dtype=np.int64)
        k = np.searchsorted(stamps, t_ns, side='right') - 1
        return PublishedCovariance(stamps[k], *(c[k] for c in columns))
