"""The guided motion: closed forms, derivatives, known interval, wind, turns and closure."""

import math

from ins_sim.core.earth import ellipsoid, frames
from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.earth.sphere_metric import across_leg
from ins_sim.core.attitude import quaternion
from ins_sim.core.motion.guided.steered import SteeredHistory
import numpy as np
import pytest
from support.flown import air_velocity, in_body
from support.guided.flights import fly, guided, instants, PERIOD_NS, stirring

FORCE, LAG_S = 20.0, 0.4


def test_closed_forms_solve_the_equations():
    """The closed forms agree with RK4 of 0.1 ms to (1e-4/0.4)^4/120 of the command per second."""
    history, period_ns = SteeredHistory(FORCE, LAG_S, 200_000_000, (100.0, -2.0)), 200_000_000
    rng, state, command = np.random.default_rng(2), np.array([100.0, -2.0, 0.0]), 0.0

    def rates(y, u):
        return np.array([y[1], -FORCE * y[2], (u - y[2]) / LAG_S])

    for k in range(5):
        new, h = rng.normal() * 0.1, 1e-4
        history.command(k * period_ns, new)
        for j in range(2000):
            u = [command + (new - command) * (j + part) / 2000 for part in (0.0, 0.5, 1.0)]
            a = rates(state, u[0])
            b = rates(state + 0.5 * h * a, u[1])
            c = rates(state + 0.5 * h * b, u[1])
            d = rates(state + h * c, u[2])
            state = state + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        command = new
        z, v_z, beta, reached, _ = history.one((k + 1) * period_ns)
        assert (z, v_z, beta) == pytest.approx(tuple(state), abs=1e-11)
        assert reached == pytest.approx(command, abs=1e-15)


def test_before_the_first_command_it_flies_straight():
    """Without a command the motion is straight: before the first one, and after ``begin``."""
    motion = guided(offset_m=50.0, offset_rate_m_s=1.5)
    motion.begin(2_000_000_000)
    states = motion.states(np.array([-3_000_000_000, 0, 2_000_000_000]))
    assert states.z.tolist() == [45.5, 50.0, 53.0]
    assert not states.beta.any() and not states.command.any()
    motion.command(2_000_000_000, 0.1)
    assert motion.states(np.array([0])).z[0] == 50.0
    motion.begin(0)
    assert motion.known_ns == 0 and motion.states(np.array([0])).z[0] == 50.0


def test_what_is_not_known_is_refused():
    """Future instants, a forgotten past, commands at other times and NaN commands are refused."""
    motion = fly(guided(), 2.0)
    assert motion.end_s == 2.0 and motion.known_ns == 2_000_000_000
    for ask in (lambda: motion.at(np.array([2_000_000_001])), lambda: motion.one(2_000_000_001)):
        with pytest.raises(ValueError, match='for 2.000000001 s; expected at most 2.000000'):
            ask()
    with pytest.raises(ValueError, match='command is for 1.990000000 s; expected one for 2.0000'):
        motion.command(1_990_000_000, 0.0)
    for command in (math.nan, math.inf):
        with pytest.raises(ValueError, match='command at 2.000000000 s is .*; expected a number'):
            motion.command(2_000_000_000, command)
    motion.forget(1_500_000_000)
    with pytest.raises(ValueError, match='1.500000000 s; expected later than 1.500000000 s'):
        motion.at(np.array([1_500_000_000]))


def test_any_cutting_gives_the_same_bits():
    """Blocks, single instants, later commands and a forgotten past change no bit."""
    route = {'wind_m_s': 8.0, 'wind_from_deg': 250.0, 'gust_m_s': 0.5}
    t_ns = instants(6.0, 2_500_000)
    whole = fly(guided(route), 8.0).at(t_ns)
    motion = guided(route)
    parts, done = [], 0
    for k in range(600):
        motion.command(k * PERIOD_NS, stirring(k * PERIOD_NS * 1e-9))
        motion.forget(k * PERIOD_NS - 500_000_000)
        while done < len(t_ns) and t_ns[done] <= motion.known_ns:
            parts.append(motion.one(int(t_ns[done])))
            done += 1
    columns = (whole.lat, whole.lon, whole.height, whole.v_n, whole.q_nb, whole.omega_ib_b,
               whole.f_ib_b)
    for found, expected in zip(zip(*parts), columns):
        assert np.array_equal(np.array(found), expected)
    assert np.array_equal(motion.at(t_ns[-9:]).f_ib_b, whole.f_ib_b[-9:])


@pytest.mark.parametrize('route', [{}, {'wind_m_s': 30.0, 'wind_from_deg': 130.0}],
                         ids=('calm', 'wind'))
def test_differences_of_the_pose(route):
    """
    Velocity, force and rate agree with central differences of the pose within the periods.

    Control periods of 0.5 s, steps of 25 ms, three to either side. Latitude, longitude and ECEF
    coordinates are rounded to 2^-30 m, which contributes 1.84 times over h to the first difference
    and 6.1 times over h^2 to the second. v_z and beta change as exp(-t/0.4), whose seventh
    derivatives times h^6/140 are below 1e-9.
    """
    motion, h_ns = fly(guided(route, control_rate_hz=2.0), 40.0), 25_000_000
    h_s = h_ns * 1e-9
    t_ns = np.arange(1, 79) * motion.period_ns + motion.period_ns // 2
    around = [motion.at(t_ns + k * h_ns) for k in range(-3, 4)]
    first = np.array((-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0)) / 60.0
    second = np.array((2.0, -27.0, 270.0, -490.0, 270.0, -27.0, 2.0)) / 180.0
    r = np.array([ellipsoid.ecef(np.sin(x.lat), np.cos(x.lat), np.sin(x.lon), np.cos(x.lon),
                                 x.height) for x in around])
    v_e, a_e = np.tensordot(first, r, 1) / h_s, np.tensordot(second, r, 1) / h_s ** 2
    truth, spin = around[3], (0.0, 0.0, ellipsoid.ROTATION_RATE)
    q_en = frames.level_frame(truth.lat, truth.lon)
    v = np.abs(np.array(quaternion.rotate(q_en, truth.v_n.T)) - v_e).max()
    coriolis = 2.0 * np.array(quaternion.cross(spin, v_e))
    f_n = np.array(quaternion.rotate_back(q_en, a_e + coriolis))
    f_n[2] += ellipsoid.gravity(np.sin(truth.lat), truth.height)
    f = np.abs(np.array(quaternion.rotate(truth.q_nb.T, truth.f_ib_b.T)) - f_n).max()
    q_eb = [quaternion.multiply(frames.level_frame(x.lat, x.lon), x.q_nb.T) for x in around]
    steps = np.array([[quaternion.logarithm(q) for q in np.array(quaternion.multiply(
        quaternion.conjugate(q_eb[3]), q)).T.tolist()] for q in q_eb])
    omega = np.tensordot(first, steps, 1) / h_s + np.stack(
        quaternion.rotate_back(q_eb[3], spin), axis=-1)
    rate = np.abs(omega - truth.omega_ib_b).max()
    print(f'\nvelocity {v:.1e} m/s, force {f:.1e} m/s^2, rate {rate:.1e} rad/s')
    assert v < 3.0 * 2.0 ** -30 * 1.84 / h_s
    assert f < 3.0 * 2.0 ** -30 * 6.1 / h_s ** 2
    assert rate < 1e-9


def test_pose_and_its_first_derivatives_are_continuous():
    """Pose and first derivatives are continuous where the command changes its slope or jumps."""
    motion = fly(guided(), 30.0)
    edges = instants(25.0)[1:]
    before, after = motion.at(edges), motion.at(edges + 1)
    assert np.abs(after.q_nb - before.q_nb).max() < 2e-9
    # beta' is up to 0.5 rad/s; beta'' up to 0.26 rad in a period over 0.4 s: 65 rad/s^2.
    assert np.abs(after.omega_ib_b - before.omega_ib_b).max() < 1e-7
    assert np.abs(after.f_ib_b - before.f_ib_b).max() < 20.0 * 0.5 * 2e-9


def test_attitude_and_side_force_are_those_of_the_sideslip():
    """Without wind the track is beta to the right of the nose, the force Z beta to the left."""
    motion = fly(guided({'attack_deg': 0.0}), 20.0)
    truth, states = motion.at(instants(20.0)), motion.states(instants(20.0))
    v = body_velocity(truth)
    assert np.arctan2(-v[:, 1], v[:, 0]) == pytest.approx(states.beta, abs=5e-6)
    along = np.hypot(v[:, 0], v[:, 1]) ** 2 - states.v_z ** 2
    assert np.sqrt(along) == pytest.approx(200.0, abs=2e-4)
    f_n = np.stack(quaternion.rotate(truth.q_nb.T, truth.f_ib_b.T), axis=-1)
    leg = motion.route.legs[0]
    z, v_z = across_leg(leg, truth.lat, truth.lon, truth.height, truth.v_n.T)
    assert z == pytest.approx(states.z, abs=1e-3) and v_z == pytest.approx(states.v_z, abs=1e-4)
    chi = np.arctan2(truth.v_n[:, 0], truth.v_n[:, 1]) - np.arctan2(states.v_z, 200.0)
    right = f_n[:, 0] * np.cos(chi) - f_n[:, 1] * np.sin(chi)
    # Without bank the Coriolis force on the track is missing: 200 m/s x 2 Omega sin(lat) = 0.024.
    turning = right + FORCE * states.beta
    assert np.ptp(turning) < 1e-3 and abs(turning.mean()) < 0.03


def test_in_wind_the_force_takes_the_sideslip_in_the_air():
    """In wind the commanded beta is relative to the air; the drift angle is added over ground."""
    wind = {'wind_m_s': 20.0, 'wind_from_deg': 120.0, 'attack_deg': 0.0}
    motion = fly(guided(wind), 20.0)
    truth, states = motion.at(instants(20.0)), motion.states(instants(20.0))
    air, ground = in_body(truth, air_velocity(motion, truth)), body_velocity(truth)
    assert np.arctan2(-air[:, 1], air[:, 0]) == pytest.approx(states.beta, abs=5e-6)
    drift = np.arctan2(-ground[:, 1], ground[:, 0]) - states.beta
    assert abs(drift).min() > math.radians(4.0)


def test_turns_are_those_of_the_route():
    """z and v_z are continuous: on legs the vehicle is steered, in turns parallel to the track."""
    motion = guided(offset_m=0.0)
    start, end = motion.turns[0]
    fly(motion, end + 1.1, lambda t: 0.02 if t < 5.0 else 0.0 if t < 10.0 else (
        -0.02 if t < 15.0 else 0.0))
    states = motion.states(np.array([round(x * 1e9) for x in (start - 1.0, end + 1.0)]))
    assert abs(states.v_z) == pytest.approx(0.0, abs=1e-9)
    assert states.z[1] == pytest.approx(states.z[0], abs=1e-6) and abs(states.z[0]) > 10.0
    truth = motion.at(np.array([round(0.5e9 * (start + end))]))
    up = quaternion.rotate_back(tuple(truth.q_nb[0]), (0.0, 0.0, 1.0))
    bank = math.atan2(up[1], up[2])
    assert abs(bank) == pytest.approx(math.atan(200.0 * math.radians(1.2) / 9.80665), rel=0.01)


def test_a_weave_is_refused():
    """A guided motion with a weave is refused with one message."""
    with pytest.raises(ValueError, match='weave_deg is 1 deg with motion.kind guided; expected 0'):
        guided({'weave_deg': 1.0})
