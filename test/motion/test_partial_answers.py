"""Attitude and specific force requested alone equal those of the whole truth, for any motion."""

import ins_sim
from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import from_angles
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.numerics import taylor
from ins_sim.core.timeseries.histories import Truth
from ins_sim.settings.motion import MotionSettings, MOTIONS
from ins_sim.settings.place import Datum, Earth
import numpy as np
import pytest
from support.guided.flights import fly, guided

T_NS = 10_000_000 * np.arange(1000, 1300)


def check(motion):
    """Compare the attitude and the force of a motion with its truth."""
    truth = motion.at(T_NS)
    q_nb = tuple(truth.q_nb.T)
    lat, lon, q = motion.attitude_at(T_NS)
    assert (lat == truth.lat).all() and (lon == truth.lon).all()
    assert np.array_equal(q, truth.q_nb)
    assert np.array_equal(motion.body_force_at(T_NS), truth.f_ib_b.T)
    lat, lon, f_n = motion.force_at(T_NS)
    assert (lat == truth.lat).all() and (lon == truth.lon).all()
    # The truth was resolved in b, and is rotated back here: two products of some ten roundings.
    expected = quaternion.rotate(q_nb, tuple(truth.f_ib_b.T))
    off = [np.abs(a - b).max() for a, b in zip(f_n, expected)]
    assert max(off) < 20.0 * np.finfo(float).eps * np.abs(expected).max()


@pytest.mark.parametrize('kind', [kind for kind in MOTIONS if kind != 'recording'])
def test_every_motion_of_the_table(kind):
    """Attitude and force of every motion of the table are right for any set of instants."""
    if kind == 'route':
        motion = ins_sim.open_motion(ins_sim.read_settings('route_flight'))
    elif kind == 'guided':
        motion = fly(guided(), 14.0)
    else:
        motion = make_motion(MotionSettings(kind=kind), Datum(), Earth())
    check(motion)
    assert np.array_equal(motion.attitude_at(T_NS)[2][7:8], motion.attitude_at(T_NS[7:8])[2])


def test_a_recorded_flight(flown):
    """Attitude and force are right for a recorded flight, which overrides the methods."""
    check(flown[0])


class AtAlone(ins_sim.Motion):
    """A user's motion that only has ``at``."""

    def __init__(self, inner):
        self._inner = inner

    def at(self, t_ns):
        """Return the truth of another motion one second later."""
        later = self._inner.at(np.asarray(t_ns) + 10 ** 9)
        return Truth(**{**later.arrays(), 't_ns': t_ns})


class Turned(type(make_motion(MotionSettings(), Datum(), Earth()))):
    """A closed-form motion whose ``at`` is replaced by that of another motion."""

    at = AtAlone.at
    _inner = make_motion(MotionSettings(kind='aggressive'), Datum(), Earth())


def test_a_motion_of_ones_own_with_at_alone():
    """All answers are derived from a user's ``at``, even if the base class has faster methods."""
    check(AtAlone(make_motion(MotionSettings(kind='cruise'), Datum(), Earth())))
    closed = make_motion(MotionSettings(kind='two_axis'), Datum(), Earth())
    closed.__class__ = Turned
    check(closed)


def test_an_attitude_made_of_derivatives():
    """The number of orders lost by derivatives in an attitude is determined automatically."""
    def pose(t):
        level = t.constant(0.0)
        angle = taylor.sin(t * 0.3)
        heading = taylor.atan2(angle.derivative(), angle)
        lean = heading.derivative() * 0.1
        return angle * 1e-6 + 0.9, t * 1e-6, level, from_angles(heading, level, lean)

    check(ins_sim.Motion(pose, 3, True))
