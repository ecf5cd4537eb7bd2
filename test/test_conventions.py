"""The conventions of ``ins_sim/__init__.py``, line by line, against independent computations."""

import math

from hypothesis import given, settings as hypothesis_settings, strategies as st
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from studies import settings

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import taylor
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.settings.place import Datum
from ins_sim.settings.motion import MOTION_KINDS

VECTORS = st.tuples(*[st.floats(-3.0, 3.0)] * 3)
# RFU to FLU: forward is +y, left is -x of (right, forward, up)
FLU_FROM_RFU = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def motion_of(kind, **more):
    """Return a motion of a kind at the test datum."""
    s = settings({'motion.kind': kind, 'datum.latitude_deg': 55.0, 'datum.longitude_deg': 37.0},
                 **more).motion_generator
    return make_motion(s.motion, s.datum, s.earth)


def matrix(q):
    """Return C of a quaternion by SciPy."""
    return Rotation.from_quat(q).as_matrix()


@given(VECTORS, VECTORS)
def test_quaternions_are_scipys(a, b):
    """Product, rotation, exponential, logarithm: scalar last, Hamilton, active b to n."""
    p, q = quaternion.exponential(a), quaternion.exponential(b)
    ra, rb = Rotation.from_rotvec(a), Rotation.from_rotvec(b)
    np.testing.assert_allclose(matrix(quaternion.multiply(p, q)), (ra * rb).as_matrix(),
                               atol=1e-14)
    np.testing.assert_allclose(quaternion.rotate(p, b), ra.apply(b), atol=1e-13)
    np.testing.assert_allclose(quaternion.rotate_back(p, b), ra.inv().apply(b), atol=1e-13)
    np.testing.assert_allclose(quaternion.logarithm(quaternion.multiply(p, q)),
                               (ra * rb).as_rotvec(), atol=1e-7)


@given(st.tuples(*[st.floats(-1e-3, 1e-3)] * 3), st.floats(1e-9, 1.0))
def test_logarithm_inverts_exponential_at_any_size(direction, scale):
    """Relative to the angle, from 1e-12 rad to pi: the atan2 form loses nothing."""
    phi = tuple(1e3 * scale * x for x in direction)
    back = quaternion.logarithm(quaternion.exponential(phi))
    np.testing.assert_allclose(back, phi, rtol=1e-14, atol=1e-15 * np.linalg.norm(phi) + 1e-300)


def test_attitude_of_the_paper():
    """C of (right, forward, up) is Rz(psi) Rx(theta) Ry(gamma); ours is that of (F, L, U)."""
    motion = motion_of('static', motion__psi_deg=20.0, motion__theta_deg=10.0,
                       motion__gamma_deg=-35.0)
    c = Rotation.from_euler('ZXY', [20.0, 10.0, -35.0], degrees=True).as_matrix()
    np.testing.assert_allclose(matrix(motion.at(np.array([0])).q_nb[0]), c @ FLU_FROM_RFU.T,
                               atol=1e-15)


def test_psi_zero_looks_north_theta_lifts_the_nose_gamma_lowers_the_right_wing():
    """Signs a person can check: psi turns towards west."""
    def axes(**angles):
        q = motion_of('static', **{'motion__theta_deg': 0.0, **angles}).at(np.array([0])).q_nb[0]
        return matrix(q).T

    forward, left, up = axes()
    np.testing.assert_allclose([forward, left, up], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
                               atol=1e-15)
    assert axes(motion__psi_deg=10.0)[0][0] < 0
    assert axes(motion__theta_deg=10.0)[0][2] > 0
    assert axes(motion__gamma_deg=10.0)[1][2] > 0


def test_heading_of_flights_is_clockwise():
    """
    The cruise flies the course of 300 deg, north-west, and looks along it.

    The heading sways by up to 0.8 deg about the course, and the nose stands 3.8 deg up at most,
    which shortens its level part by 0.0022.
    """
    cruise = motion_of('cruise').at(np.array([2_000_000_000_000]))
    forward = matrix(cruise.q_nb[0])[:, 0]
    assert forward[0] < 0 < forward[1]
    np.testing.assert_allclose(forward[:2], cruise.v_n[0, :2] / np.linalg.norm(cruise.v_n[0]),
                               atol=math.radians(0.8) + 0.0022)


def test_imu_at_rest_reads_gravity_up_and_earth_rate():
    """REP-145: +g on z at rest; angular velocity relative to inertial space."""
    truth = motion_of('static', motion__theta_deg=0.0).at(np.array([0]))
    lat = math.radians(55.0)
    np.testing.assert_allclose(truth.f_ib_b[0], [0, 0, ellipsoid.gravity(math.sin(lat), 0.0)],
                               atol=1e-15)
    w = 7.292115e-5
    np.testing.assert_allclose(truth.omega_ib_b[0], [w * math.cos(lat), 0, w * math.sin(lat)],
                               atol=1e-18)
    assert not motion_of('static', earth__rotation=False).at(np.array([0])).omega_ib_b.any()


def test_normal_gravity_and_radii():
    """WGS-84: equator 9.7803253359, pole 9.8321849379, 45 deg 9.8061977695 m/s^2 (TR8350.2)."""
    assert ellipsoid.gravity(0.0, 0.0) == 9.7803253359
    assert ellipsoid.gravity(1.0, 0.0) == pytest.approx(9.8321849379, abs=2e-10)
    assert ellipsoid.gravity(math.sqrt(0.5), 0.0) == pytest.approx(9.8061977695, abs=2e-9)
    assert ellipsoid.gravity(0.0, 1000.0) == pytest.approx(9.7803253359 * (1 - 2000 / 6378137.0))
    assert ellipsoid.radii(0.0) == (pytest.approx(6335439.327, abs=1e-3), 6378137.0)
    assert ellipsoid.radii(1.0)[0] == pytest.approx(6399593.626, abs=1e-3)


@given(st.floats(-89.9, 89.9), st.floats(-180, 180), st.floats(-1e4, 1e5))
def test_geodetic_inverts_ecef(lat, lon, height):
    """Round trip to a nanometre in height and 1e-15 rad, from -10 km to 100 km."""
    a, b = math.radians(lat), math.radians(lon)
    x = ellipsoid.ecef(math.sin(a), math.cos(a), math.sin(b), math.cos(b), height)
    back = ellipsoid.geodetic(*x)
    assert abs(back[0] - a) < 1e-15 + 2e-16 * abs(a) * 4
    assert abs(math.remainder(back[1] - b, 2 * math.pi)) < 1e-15
    assert abs(back[2] - height) < 4e-9


@given(st.floats(-80, 80), st.floats(-180, 180), st.floats(-2, 2), st.floats(-2, 2), VECTORS)
@hypothesis_settings(deadline=None)
def test_map_frame_round_trip(lat, lon, d_lat, d_lon, phi):
    """Pose in map and back, up to hundreds of kilometres from the datum."""
    frame = MapFrame(Datum(lat, lon, 100.0), True)
    here = (math.radians(lat + d_lat), math.radians(lon + d_lon), 5000.0, (10.0, 20.0, 3.0),
            quaternion.exponential(phi))
    back = frame.geodetic_one(*frame.pose_one(*here))
    assert abs(back[0] - here[0]) < 2e-15
    assert abs(math.remainder(back[1] - here[1], 2 * math.pi)) < 1e-14
    assert abs(back[2] - 5000.0) < 1e-8
    np.testing.assert_allclose(back[3], here[3], atol=1e-13)
    np.testing.assert_allclose(matrix(back[4]), matrix(here[4]), atol=1e-14)
    arrays = frame.pose(*(np.array([x]) for x in here))
    for one, many in zip(frame.pose_one(*here), arrays):
        np.testing.assert_allclose(many[0], one, rtol=1e-15, atol=1e-9)


def test_map_is_the_tangent_plane_at_the_datum():
    """East and North on the plane, the origin at the datum, the ground falls away below."""
    frame = MapFrame(Datum(55.0, 37.0, 0.0), True)
    level = quaternion.IDENTITY
    lat, lon = math.radians(55.0), math.radians(37.0)
    r, _, _ = frame.pose_one(lat, lon, 0.0, (0.0, 0.0, 0.0), level)
    np.testing.assert_allclose(r, 0.0, atol=1e-8)
    r, _, _ = frame.pose_one(lat + 1e-3, lon, 0.0, (0.0, 0.0, 0.0), level)
    # over this way the radius of the meridian changes by 3 e^2 sin(lat) cos(lat) 1e-3 = 1e-5
    radius = ellipsoid.radii(math.sin(lat))[0]
    assert r[1] == pytest.approx(1e-3 * radius, rel=1e-5)
    assert r[2] == pytest.approx(-0.5 * r[1] ** 2 / radius, rel=1e-5)


FIRST = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60.0
SECOND = np.array([2, -27, 270, -490, 270, -27, 2]) / 180.0


def differences(motion, centre, h_ns):
    """
    Return v_n, f_ib_b and omega_ib_b of a motion at an instant, from seven poses h_ns apart.

    In e: v = dr/dt; f = C_en^T (a + 2 W x v) - g; rates from attitudes relative to i.
    """
    offsets, dt = np.arange(-3, 4), h_ns * 1e-9
    truth = motion.at(centre + h_ns * offsets)
    s, c = np.sin(truth.lat), np.cos(truth.lat)
    r = np.stack(ellipsoid.ecef(s, c, np.sin(truth.lon), np.cos(truth.lon), truth.height), -1)
    v_e, a_e = FIRST @ r / dt, SECOND @ r / dt ** 2
    frames = [Rotation.from_euler('z', lon + np.pi / 2) * Rotation.from_euler('x', np.pi / 2 - lat)
              for lat, lon in zip(truth.lat, truth.lon)]
    spin = np.array([0.0, 0.0, ellipsoid.ROTATION_RATE])
    c_en, c_nb = frames[3].as_matrix(), matrix(truth.q_nb[3])
    f_e = a_e + 2 * np.cross(spin, v_e) + c_en @ [0, 0, ellipsoid.gravity(s[3], truth.height[3])]
    turned = [Rotation.from_rotvec(spin * k * dt) * frame * Rotation.from_quat(q)
              for k, frame, q in zip(offsets, frames, truth.q_nb)]
    steps = np.array([(turned[3].inv() * t).as_rotvec() for t in turned])
    return c_en.T @ v_e, c_nb.T @ c_en.T @ f_e, FIRST @ steps / dt


@pytest.mark.parametrize('kind', MOTION_KINDS[:-1])
def test_truth_is_consistent_by_finite_differences(kind):
    """
    Velocity, rate and force follow from positions and attitudes by a scheme of their own.

    Sixth-order central differences over 20 ms.  Their truncation is the difference from those
    over 40 ms divided by 2^6 - 1; a half of that divisor leaves room for the next order.  An ECEF
    coordinate rounds to 2^-30 m, an angle to 2^-52 of the largest one, 2 pi rad a second.
    """
    motion, h_ns = motion_of(kind), 20_000_000
    h, first, second = h_ns * 1e-9, np.abs(FIRST).sum(), np.abs(SECOND).sum()
    for centre in (0, 137_000_000, 400_000_000_000):
        truth = motion.at(np.array([centre]))
        rounding = (2.0 ** -30 * first / h, 2.0 ** -30 * second / h ** 2,
                    2.0 ** -52 * (1.0 + 2.0 * math.pi * centre * 1e-9) * first / h)
        for found, coarse, exact, rounded in zip(
                differences(motion, centre, h_ns), differences(motion, centre, 2 * h_ns),
                (truth.v_n[0], truth.f_ib_b[0], truth.omega_ib_b[0]), rounding):
            truncation = np.abs(coarse - found).max() / 32.0
            np.testing.assert_allclose(found, exact, rtol=0, atol=truncation + rounded)


def test_taylor_series_against_closed_forms():
    """Derivatives of a composed function to third order against its exact ones."""
    t = np.array([0.3, -1.2, 2.5])
    x = taylor.Series.time(t, 3)
    s = taylor.sin(x * 2.0) * taylor.tanh(x) / taylor.sqrt(x * x + 1.0)
    h = 1e-3

    def f(t):
        return np.sin(2 * t) * np.tanh(t) / np.sqrt(t * t + 1)

    np.testing.assert_allclose(s.value, f(t), rtol=1e-15)
    np.testing.assert_allclose(s.derivative().value,
                               (f(t - 2 * h) - 8 * f(t - h) + 8 * f(t + h) - f(t + 2 * h))
                               / (12 * h), rtol=1e-9)
    np.testing.assert_allclose(s.derivative().derivative().value,
                               (f(t + h) - 2 * f(t) + f(t - h)) / h ** 2, rtol=1e-4)
    angle = taylor.atan2(taylor.sin(x), taylor.sincos(x)[1])
    np.testing.assert_allclose(angle.derivative().c, [[1.0] * 3, [0.0] * 3, [0.0] * 3], atol=1e-14)
    soft = taylor.log_cosh(x * 1000.0)
    np.testing.assert_allclose(soft.value, np.abs(1000 * t) - np.log(2), rtol=1e-12)
