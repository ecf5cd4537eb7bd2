"""The flight along a route: derivatives, great circles, turns, wind and weave."""

import math

from support.flown import air_velocity, in_body, instants, on_legs, ROUGH, route, WEAVE, WIND
from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid, frames
from ins_sim.core.attitude.angles import to_compass
from ins_sim.core.numerics.units import STANDARD_GRAVITY
from ins_sim.core.timeseries.histories import Truth

AIRSPEED = 200.0
# Central differences of sixth order, for the first and the second derivative.
FIRST = np.array((-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0)) / 60.0
SECOND = np.array((2.0, -27.0, 270.0, -490.0, 270.0, -27.0, 2.0)) / 180.0


def local(truth):
    """Return q_en (4, n)."""
    return frames.level_frame(truth.lat, truth.lon)


@pytest.mark.parametrize('groups, h_s, v_bound, f_bound, rate_bound', [
    # Sixth-order truncation, turns with 5 s of roll-in; rounding of 1e-9 m, twice over h and h^2.
    ((WIND,), 0.1, 1e-7, 3e-6, 3e-6),
    # The same with gusts up to 8 rad/s: 0.16 m/s x 8^6 h^6 / 140, x 8^7 h^6 / 560.
    ((ROUGH,), 0.05, 5e-6, 2e-5, 3e-6)], ids=('calm', 'rough'))
def test_differences_of_the_pose(groups, h_s, v_bound, f_bound, rate_bound):
    """The truth agrees with differences of Earth-fixed positions and attitudes."""
    motion = route(*groups)
    rng = np.random.default_rng(3)
    t = rng.uniform(1.0, motion.end_s, 2000)
    for start, end in motion.turns:
        t = np.concatenate([t, np.linspace(start - 2.0, end + 2.0, 1000)])
    # Differences must not span the joints, where the third derivative of the bank has steps.
    joints = [x for start, end in motion.turns for x in (start, start + 5.0, end - 5.0, end)]
    t = t[np.abs(t[:, None] - joints).min(axis=1) > 3.1 * h_s]
    t_ns, h_ns = np.round(t * 1e9).astype(np.int64), round(h_s * 1e9)
    around = [motion.at(t_ns + k * h_ns) for k in range(-3, 4)]
    r = np.array([ellipsoid.ecef(*(f(a) for a in (x.lat, x.lon) for f in (np.sin, np.cos)),
                                 x.height) for x in around])
    v_e = np.tensordot(FIRST, r, 1) / h_s
    a_e = np.tensordot(SECOND, r, 1) / h_s ** 2
    truth = around[3]
    q_en = local(truth)
    spin = (0.0, 0.0, ellipsoid.ROTATION_RATE)
    v = np.abs(np.array(quaternion.rotate(q_en, truth.v_n.T)) - v_e).max()
    f_n = np.array(quaternion.rotate_back(q_en, a_e + 2.0 * np.array(quaternion.cross(spin, v_e))))
    f_n[2] += ellipsoid.gravity(np.sin(truth.lat), truth.height)
    f = np.abs(np.array(quaternion.rotate(truth.q_nb.T, truth.f_ib_b.T)) - f_n).max()

    q_eb = [quaternion.multiply(local(x), x.q_nb.T) for x in around]

    def mean_rate(k):
        turned = np.array(quaternion.multiply(quaternion.conjugate(q_eb[3 - k]), q_eb[3 + k])).T
        return np.array([quaternion.logarithm(q) for q in turned.tolist()]) / (2 * k * h_s)

    # Fourth order by Richardson extrapolation; the rotation of the Earth is added.
    omega = (4.0 * mean_rate(1) - mean_rate(2)) / 3.0 + np.stack(
        quaternion.rotate_back(q_eb[3], spin), axis=-1)
    rate = np.abs(omega - truth.omega_ib_b).max()
    print(f'\n{len(t)} instants: velocity {v:.2e} m/s, specific force {f:.2e} m/s^2, '
          f'rate {rate:.2e} rad/s')
    assert v < v_bound and f < f_bound and rate < rate_bound


def test_truth_has_no_steps():
    """Velocity, force, attitude and rate are continuous at the joints of turns, the rate C1."""
    motion = route(WIND)
    for start, end in motion.turns:
        for joint in (start, start + 5.0, end - 5.0, end):
            t_ns = round(joint * 1e9) + np.arange(-4, 5)
            truth = motion.at(t_ns)
            # Within 8 ns the change is limited by the slopes there, and by rounding.
            assert np.abs(np.diff(truth.v_n, axis=0)).max() < 1e-8
            assert np.abs(np.diff(truth.f_ib_b, axis=0)).max() < 1e-6
            assert np.abs(np.diff(truth.omega_ib_b, axis=0)).max() < 1e-9
            # In 2 ms the slope of the rate changes by its derivative, 0.2 rad/s^3, times 2 ms.
            slopes = [np.diff(motion.at(np.array((t, t + 1000000))).omega_ib_b, axis=0) / 1e-3
                      for t in (t_ns[0] - 1000000, t_ns[-1])]
            assert np.abs(slopes[1] - slopes[0]).max() < 2e-3


def test_calm_legs_are_great_circles_at_constant_airspeed():
    """Without weave and gusts Z is zero on legs, and the airspeed is constant, also in turns."""
    motion = route(WIND)
    t_ns = instants(motion, 0.1)
    truth, free = motion.at(t_ns), on_legs(motion, t_ns)
    leg = motion.route.legs_at(truth.lat, truth.lon)
    x, z = motion.route.to_xz(truth.lat, truth.lon, leg)
    speed = np.linalg.norm(air_velocity(motion, truth), axis=1)
    beside, legs, turns = (np.abs(a).max() for a in (z[free], speed[free] - AIRSPEED,
                                                     speed[~free] - AIRSPEED))
    print(f'\n|Z| on legs {beside:.2e} m; airspeed off by {legs:.2e} m/s on legs, '
          f'{turns:.2e} in turns; furthest inside a corner {np.abs(z).max():.0f} m')
    # A few roundings of radians; the expansions neglect 5e-12 of the velocity in the roll-in.
    assert beside < 2e-8 and legs < 1e-11 and turns < 2e-9
    assert (np.diff(np.array(motion.route.starts)[leg[free]] + x[free]) > 0.0).all()


def test_the_flight_starts_and_arrives_at_its_points():
    """
    The flight is at the first point at time zero and at the last point at end_s.

    The motion is defined before and after.
    """
    motion = route(WIND, WEAVE)
    ends = motion.at(np.array((0, round(motion.end_s * 1e9)), dtype=np.int64))
    x = [leg.to_xz(ends.lat[k], ends.lon[k]) for k, leg in ((0, motion.route.legs[0]),
                                                            (1, motion.route.legs[-1]))]
    assert x[0] == pytest.approx((0.0, 0.0), abs=1e-7)
    # The weave displaces by 14 m to the side, and by the drift ahead at its phase on arrival.
    assert x[1] == pytest.approx((motion.route.legs[-1].length, 0.0), abs=14.0)
    calm = route(WIND)
    end_ns = round(calm.end_s * 1e9)
    arrived = calm.at(np.array((-10 ** 9, end_ns, end_ns + 10 ** 9)))
    x, z = calm.route.legs[-1].to_xz(arrived.lat[1:], arrived.lon[1:])
    # The arrival is rounded to half a nanosecond.
    assert x[0] == pytest.approx(calm.route.legs[-1].length, abs=2e-7)
    assert 190.0 < x[1] - x[0] < 210.0 and np.abs(z).max() < 1e-8
    assert -210.0 < calm.route.legs[0].to_xz(arrived.lat[0], arrived.lon[0])[0] < -190.0


def test_turns_are_coordinated_at_their_rate():
    """
    Turns are coordinated: 1.2 deg/s, bank atan(V psi'/g), and nearly no side force.

    This holds in the part of constant rate.
    """
    motion = route(attack_deg=0.0)
    for start, end in motion.turns:
        t_ns = np.round(np.arange(start, end, 0.01) * 1e9).astype(np.int64)
        truth = motion.at(t_ns)
        roll, pitch, heading = to_compass(truth.q_nb)
        rate = np.gradient(np.unwrap(heading), 0.01)
        hold = (t_ns * 1e-9 > start + 5.1) & (t_ns * 1e-9 < end - 5.1)
        lon_rate = np.gradient(truth.lon, 0.01)
        bank = np.arctan(AIRSPEED * (rate - (2.0 * ellipsoid.ROTATION_RATE + lon_rate) * np.sin(
            truth.lat)) / STANDARD_GRAVITY)
        print(f'\nturn of {math.degrees(heading[-1] - heading[0]):.2f} deg: rate '
              f'{np.degrees(rate[hold]).min():.4f} to {np.degrees(rate[hold]).max():.4f} deg/s, '
              f'bank {np.degrees(roll[hold]).mean():.3f} deg, off by '
              f'{np.degrees(np.abs(roll - bank)[1:-1].max()):.1e} deg; side force '
              f'{np.abs(truth.f_ib_b[:, 1]).max():.4f} m/s^2')
        # The great circle's own contribution to the rate: V/R0 tan(lat) = 4.8e-5 rad/s.
        assert np.abs(np.abs(rate[hold]) - math.radians(1.2)).max() < 5e-5
        # Error of the numerical derivative of the heading.
        assert np.abs(roll - bank)[1:-1].max() < 1e-4
        # sin(bank) times three terms: normal minus standard gravity, 0.009; Eotvos effect
        # 2 Omega V cos(lat), 0.0163; V^2/R0, 0.0063 m/s^2.
        assert np.abs(truth.f_ib_b[:, 1]).max() < 0.4 * (0.009 + 0.0163 + 0.0063)
        assert np.abs(pitch).max() < 1e-12


def test_the_nose_is_in_the_wind():
    """The velocity relative to the air is V (cos alpha, 0, -sin alpha) in b, banked or not."""
    alpha = math.radians(3.0)
    expected = AIRSPEED * np.array((math.cos(alpha), 0.0, -math.sin(alpha)))
    for groups, on_leg, in_turn in (((WIND,), 1e-9, 1e-8), ((ROUGH,), 2e-3, 0.5)):
        motion = route(*groups)
        t_ns = instants(motion, 0.1)
        truth, free = motion.at(t_ns), on_legs(motion, t_ns)
        off = np.abs(in_body(truth, air_velocity(motion, truth)) - expected).max(axis=1)
        print(f'\n{groups}: off by {off[free].max():.2e} m/s on legs, {off[~free].max():.2e} in '
              'turns')
        # Rough flight: weave and gusts displace by up to 40 m in axes that turn at 5e-5 rad/s on
        # legs, the weave by 14 m in axes that turn at 0.021 rad/s in turns.
        assert off[free].max() < on_leg and off[~free].max() < in_turn


def test_wind_triangle():
    """North with wind from the west: drift angle asin(8/200), ground speed sqrt(200^2 - 8^2)."""
    motion = route({'points.latitude_deg': (55.0, 56.0), 'points.longitude_deg': (37.0, 37.0)},
                   wind_m_s=8.0, wind_from_deg=270.0, attack_deg=0.0)
    truth = motion.at(instants(motion, 1.0))
    heading = to_compass(truth.q_nb)[2]
    speed = np.linalg.norm(truth.v_n, axis=1)
    print(f'\nheading {np.degrees(heading).mean():.6f} deg, ground speed {speed.mean():.6f} m/s')
    assert np.remainder(heading + math.pi, 2 * math.pi) - math.pi == pytest.approx(
        -math.asin(8.0 / 200.0), abs=1e-10)
    assert speed == pytest.approx(math.sqrt(200.0 ** 2 - 8.0 ** 2), abs=1e-9)
    v_b = in_body(truth, truth.v_n)
    # Wind from the left: the velocity meter sees drift to the right of the nose, V_z1 > 0. The
    # bank against the Coriolis force, 0.14 deg, reduces it by 3e-6.
    assert -v_b[:, 1] == pytest.approx(8.0 * math.sqrt(1 - 0.04 ** 2), rel=4e-6)


def test_the_weave_is_flown():
    """Weave: heading +-1 deg, track +-V A/w, period 25 s, at constant airspeed."""
    points = {'points.latitude_deg': (0.0, 0.0), 'points.longitude_deg': (37.0, 39.0)}
    # With an angle of attack banking would also turn the nose.
    motion = route(points, WEAVE, attack_deg=0.0)
    t_ns = instants(motion, 0.01)
    truth = motion.at(t_ns)
    heading = np.degrees(to_compass(truth.q_nb)[2]) - 90.0
    z = motion.route.legs[0].to_xz(truth.lat, truth.lon)[1]
    ups = t_ns[1:][(heading[:-1] < 0.0) & (heading[1:] >= 0.0)] * 1e-9
    course = np.degrees(np.arctan2(truth.v_n[:, 0], truth.v_n[:, 1])) - 90.0
    speed = np.linalg.norm(truth.v_n, axis=1)
    expected = 200.0 * math.radians(1.0) * 25.0 / (2.0 * math.pi)
    print(f'\nheading {heading.min():.6f} to {heading.max():.6f} deg, period '
          f'{np.diff(ups).mean():.4f} s, track {z.min():.3f} to {z.max():.3f} m '
          f'({expected:.3f}), airspeed off by {np.abs(speed - AIRSPEED).max():.1e} m/s')
    assert heading.max() == pytest.approx(1.0, abs=1e-6)
    assert heading.min() == pytest.approx(-1.0, abs=1e-6)
    assert np.diff(ups) == pytest.approx(25.0, abs=0.011)
    # 2 J1(A) = A (1 - A^2/8); R0 differs from the radius at the equator by 1.1e-3.
    assert z.max() == pytest.approx(expected, rel=2e-3)
    assert np.abs(course - heading).max() < 1e-6
    assert np.abs(speed - AIRSPEED).max() < 1e-9


def test_a_slipping_weave_swings_the_nose_and_not_the_track():
    """Slipping weave: heading +-1 deg, track straight, no bank."""
    points = {'points.latitude_deg': (0.0, 0.0), 'points.longitude_deg': (37.0, 38.0)}
    motion, calm = (route(points, weave, attack_deg=0.0) for weave in (
        {**WEAVE, 'weave': 'slipping'}, {}))
    t_ns = instants(motion, 0.01)
    truth = motion.at(t_ns)
    heading = np.degrees(to_compass(truth.q_nb)[2]) - 90.0
    z = motion.route.legs[0].to_xz(truth.lat, truth.lon)[1]
    v_b = in_body(truth, truth.v_n)
    slip = np.degrees(np.arctan2(v_b[:, 1], v_b[:, 0]))
    print(f'heading {heading.min():.6f} to {heading.max():.6f} deg, |Z| {np.abs(z).max():.1e} m')
    assert heading.max() == pytest.approx(1.0, abs=1e-6)
    assert np.abs(z).max() < 1e-7
    np.testing.assert_allclose(slip, heading, atol=1e-9)
    np.testing.assert_allclose(to_compass(truth.q_nb)[1], to_compass(calm.at(t_ns).q_nb)[1],
                               atol=1e-9)
    assert motion.end_s == calm.end_s


def test_any_cutting_gives_the_same_bits():
    """Truth computed in random blocks has the bits of the whole."""
    motion = route(ROUGH)
    t_ns = instants(motion, 0.05)
    whole = motion.at(t_ns)
    cuts = np.sort(np.random.default_rng(4).integers(1, len(t_ns), 20))
    parts = Truth.concatenate(motion.at(t) for t in np.split(t_ns, cuts) if len(t))
    for name, value in whole.arrays().items():
        assert (getattr(parts, name) == value).all(), name
    again = route(ROUGH).at(t_ns[:100])
    assert (again.lat == whole.lat[:100]).all() and (again.f_ib_b == whole.f_ib_b[:100]).all()


@settings(deadline=None, max_examples=40)
@given(st.floats(-70.0, 70.0), st.floats(-180.0, 180.0), st.floats(0.0, 360.0),
       st.lists(st.floats(-150.0, 150.0), min_size=1, max_size=3), st.floats(0.0, 20.0),
       st.floats(0.0, 360.0), st.floats(0.5, 3.0))
def test_any_route_closes(lat, lon, course, turns, wind, wind_from, rate):
    """
    Any route reaches its last point on great circles, for random corners, winds and rates.

    The slowest turn has a radius of up to 25 km. A turn by 150 deg, plus 10 where meridians
    converge, starts r tan(80 deg) = 142 km before its point: two of them fit on a leg of 333 km.
    """
    lats, lons = [lat], [lon]
    for turn in (*turns, 0.0):
        lats.append(lats[-1] + 3.0 * math.cos(math.radians(course)))
        lons.append(lons[-1] + 3.0 * math.sin(math.radians(course))
                    / math.cos(math.radians(lats[-1])))
        course += turn
    motion = route({'points.latitude_deg': tuple(lats),
                    'points.longitude_deg': tuple(math.remainder(x, 360.0) for x in lons)},
                   wind_m_s=wind, wind_from_deg=wind_from, turn_rate_deg_s=rate, roll_in_s=3.0)
    t_ns = instants(motion, 0.5)
    truth, free = motion.at(t_ns), on_legs(motion, t_ns)
    leg = motion.route.legs_at(truth.lat, truth.lon)
    x, z = motion.route.to_xz(truth.lat, truth.lon, leg)
    assert np.abs(z[free]).max() < 2e-8
    way = np.linalg.norm(np.diff(truth.v_n, axis=0), axis=1)
    # Bound: half a second of the turn.
    assert way.max() < 0.51 * (AIRSPEED + wind) * math.radians(rate)
    last = motion.at(np.array([round(motion.end_s * 1e9)]))
    assert motion.route.legs[-1].to_xz(last.lat, last.lon)[0][0] == pytest.approx(
        motion.route.legs[-1].length, abs=1e-6)
    # Quaternions keep their sign from sample to sample.
    assert ((truth.q_nb[1:] * truth.q_nb[:-1]).sum(axis=1) > 0.9).all()
