"""The interface of a motion, and the check that it is long enough for a run."""

import math

import numpy as np

from ins_sim.core.numerics import taylor
from .truth import truth_from_pose


class Motion:
    """
    A closed-form motion, valid at any time.

    pose maps the Series of time to (lat, lon, height, q_nb); order is the order of that Series.
    period_s is the period of the attitude, or None.
    """

    end_s = math.inf

    def __init__(self, pose, order, earth_rotation, period_s=None):
        self._pose = pose
        self._order = order
        self._rotation = earth_rotation
        self.period_s = period_s

    def at(self, t_ns):
        """Return the Truth at motion times t_ns (n,) int64."""
        t = taylor.Series.time(np.asarray(t_ns) * 1e-9, self._order)
        return truth_from_pose(t_ns, *self._pose(t), self._rotation)


def check_length(generator, motion):
    """Raise ValueError unless the run is finite and lies within the motion."""
    if generator.duration_s == 0.0:
        raise ValueError('duration_s is 0, endless; expected a length in s for an offline run')
    end_s = generator.start_s + generator.duration_s
    if end_s > motion.end_s:
        raise ValueError(f'start_s + duration_s is {end_s:g} s; expected at most {motion.end_s:g}'
                         f' s, {motion.end_name}')
