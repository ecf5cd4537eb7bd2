"""The interface of a motion, and checks that a motion is valid for the whole run."""

from collections.abc import Callable
import math
from typing import Any

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics import instants, taylor
from ins_sim.core.timeseries.histories import Truth
from .truth import translation, truth_from_pose

HALF_PI = 0.5 * math.pi
# Number of instants at which the positions of a run are checked in advance.
LOOKS = 1000

# Latitude, longitude, and either the attitude or the specific force at that place.
Answer = tuple[Any, Any, Any]


class Motion:
    """
    A motion: position and attitude of the vehicle as functions of time.

    The constructor serves motions in closed form, which are valid at any time. A subclass may
    instead override ``at``, as recorded flights do; its ``attitude_at``, ``force_at`` and
    ``body_force_at`` are then derived from ``at``, unless it overrides them as well.

    Parameters
    ----------
    pose : callable
        Maps the Taylor series of time, in s, to four values: latitude and longitude (rad) and
        height above the ellipsoid (m), each a Series, and q_nb, a tuple of four Series.
        Functions of a Series are in ``core.numerics.taylor``.
    order : int
        Order of these series. Two is enough, unless the pose itself contains derivatives.
    earth_rotation : bool
        Whether the Earth rotates.
    period_s : float, optional
        Period of the attitude. The prediction averages the drift over it.
    path : callable, optional
        Maps the Taylor series of time, of order 2, to latitude, longitude and height alone, if
        that is faster than the pose.
    gravity : str
        Dependence of normal gravity on height, ``free_air`` or ``second_order``.
    """

    # The last motion time at which the motion may be used, s, and a name for that end.
    end_s = math.inf
    end_name = ''
    period_s: float | None = None

    def __init__(self, pose: Callable[[Any], tuple[Any, ...]], order: int, earth_rotation: bool,
                 period_s: float | None = None,
                 path: Callable[[Any], tuple[Any, ...]] | None = None,
                 gravity: str = 'free_air') -> None:
        self._pose = pose
        self._path_alone = path
        self._order = order
        self._rotation = earth_rotation
        self._gravity = gravity
        self._attitude_order: int | None = None
        self.period_s = period_s

    def __init_subclass__(cls, **keywords: Any) -> None:
        """Derive all other answers from ``at`` in a class that overrides only ``at``."""
        super().__init_subclass__(**keywords)
        if 'at' in vars(cls):
            for name, by_truth in (('attitude_at', _attitude_of), ('force_at', _force_of),
                                   ('body_force_at', _body_force_of)):
                if name not in vars(cls):
                    setattr(cls, name, by_truth)

    def check_end(self, end_s: float) -> None:
        """Raise ValueError if a run up to motion time end_s, s, is longer than the motion."""
        if end_s > self.end_s:
            raise ValueError(f'start_s + duration_s is {end_s:g} s; expected at most '
                             f'{self.end_s:g} s, {self.end_name}')

    def at(self, t_ns: np.ndarray) -> Truth:
        """
        Return the Truth at instants.

        Parameters
        ----------
        t_ns : (n,) int64 array
            Motion times, ns.
        """
        t = taylor.Series.time(np.asarray(t_ns) * 1e-9, self._order)
        pose = self._pose(t)
        check_latitude(t_ns, pose[0].value)
        return truth_from_pose(t_ns, *pose, self._rotation, self._gravity)

    def attitude_at(self, t_ns: np.ndarray) -> Answer:
        """
        Return the position and attitude of ``at``, faster.

        Parameters
        ----------
        t_ns : (n,) int64 array
            Motion times, ns.

        Returns
        -------
        lat, lon : (n,) arrays
            Latitude and longitude, rad; floats if the position is fixed.
        q_nb : (n, 4) array
            Attitude relative to the local level frame.
        """
        seconds = np.asarray(t_ns) * 1e-9
        if self._attitude_order is None:
            # Add the order that is lost if the attitude itself is computed from derivatives.
            q_nb = self._pose(taylor.Series.time(seconds[:1], self._order))[3]
            self._attitude_order = self._order - min(len(x.c) - 1 for x in q_nb)
        lat, lon, _, q_nb = self._pose(taylor.Series.time(seconds, self._attitude_order))
        check_latitude(t_ns, lat.value)
        return lat.value, lon.value, np.stack([x.value for x in q_nb], axis=-1)

    def force_at(self, t_ns: np.ndarray) -> Answer:
        """
        Return the specific force in the local level frame, without the attitude of the body.

        Parameters
        ----------
        t_ns : (n,) int64 array
            Motion times, ns.

        Returns
        -------
        lat, lon : (n,) arrays
            Latitude and longitude, rad; floats if the position is fixed.
        f_n : tuple of three (n,) arrays
            Specific force east, north, up, m/s^2; floats if it is constant.
        """
        seconds = np.asarray(t_ns) * 1e-9
        if self._path_alone is None:
            lat, lon, height = self._pose(taylor.Series.time(seconds, self._order))[:3]
        else:
            lat, lon, height = self._path_alone(taylor.Series.time(seconds, 2))
        check_latitude(t_ns, lat.value)
        return lat.value, lon.value, translation(lat, lon, height, self._rotation,
                                                 self._gravity)[2]

    def body_force_at(self, t_ns: np.ndarray) -> Any:
        """
        Return the specific force of ``at``; faster for motions that support it.

        Parameters
        ----------
        t_ns : (n,) int64 array
            Motion times, ns.

        Returns
        -------
        f_b : tuple of three (n,) arrays
            Specific force along the axes of the body, m/s^2.
        """
        return _body_force_of(self, t_ns)


def _attitude_of(motion, t_ns):
    """Return ``attitude_at`` of a motion, derived from its truth."""
    truth = motion.at(t_ns)
    return truth.lat, truth.lon, truth.q_nb


def _force_of(motion, t_ns):
    """Return ``force_at`` of a motion, derived from its truth."""
    truth = motion.at(t_ns)
    f_n = quaternion.rotate(np.moveaxis(truth.q_nb, -1, 0), np.moveaxis(truth.f_ib_b, -1, 0))
    return truth.lat, truth.lon, f_n


def _body_force_of(motion, t_ns):
    """Return ``body_force_at`` of a motion, derived from its truth."""
    return tuple(motion.at(t_ns).f_ib_b.T)


def check_latitude(t_ns, lat):
    """Raise ValueError if a latitude, rad, an array, is beyond a pole."""
    if len(lat) and not abs(lat).max() <= HALF_PI:
        k = int(np.argmax(abs(lat) > HALF_PI))
        raise ValueError(f'the motion crosses a pole before {instants.seconds(t_ns[k])} of motion '
                         f'time, where its latitude would be {math.degrees(lat[k]):.6g} deg; '
                         'expected at most 90 deg north or south: choose a datum farther from '
                         'the pole')


def check_places(motion, start_s, span_s):
    """Raise ValueError if a motion without an end crosses a pole during the span, s."""
    if motion.end_s == math.inf:
        motion.force_at(np.round((start_s + span_s * np.arange(LOOKS + 1) / LOOKS) * 1e9
                                 ).astype(np.int64))


def check_length(generator, motion):
    """Raise ValueError unless the run is finite, within the motion, and does not pass a pole."""
    if generator.duration_s == 0.0:
        raise ValueError('duration_s is 0, endless; expected a length in s for an offline run')
    end_s = generator.start_s + generator.duration_s
    motion.check_end(end_s)
    check_places(motion, generator.start_s, generator.duration_s)
