"""The interface of a motion, and the check that it is long enough for a run."""

from collections.abc import Callable
import math
from typing import Any

import numpy as np

from ins_sim.core.numerics import taylor
from ins_sim.core.timeseries.histories import Truth
from .truth import truth_from_pose


class Motion:
    """
    A motion: the place and the attitude of the vehicle as functions of time.

    The constructor serves motions in closed form, which are valid at any time. A subclass that
    overrides ``at`` may work in another way, as recorded flights do.

    Parameters
    ----------
    pose : callable
        Maps the Taylor series of time, in s, to four values: latitude and longitude (rad) and
        height above the ellipsoid (m), each a Series, and q_nb, a tuple of four Series.
        ``core.numerics.taylor`` has the functions of a Series.
    order : int
        Order of these series. Two is enough, unless the pose is made of derivatives itself.
    earth_rotation : bool
        Whether the Earth turns.
    period_s : float, optional
        Period of the attitude. The prediction averages the drift over it.
    """

    # The last motion time at which the motion may be used, s, and what happens then.
    end_s = math.inf
    end_name = ''
    period_s: float | None = None

    def __init__(self, pose: Callable[[Any], tuple[Any, ...]], order: int, earth_rotation: bool,
                 period_s: float | None = None) -> None:
        self._pose = pose
        self._order = order
        self._rotation = earth_rotation
        self.period_s = period_s

    def at(self, t_ns: np.ndarray) -> Truth:
        """
        Return the Truth at instants.

        Parameters
        ----------
        t_ns : (n,) int64 array
            Motion times, ns.
        """
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
