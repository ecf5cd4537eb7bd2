"""Conventions of motions: axes, angles, heading, and readings of an IMU at rest."""

import math

import numpy as np
from scipy.spatial.transform import Rotation

from ins_sim.core.earth import ellipsoid
from support.conventional import matrix, motion_of

# RFU to FLU: forward is +y, left is -x of (right, forward, up).
FLU_FROM_RFU = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def test_attitude_of_the_paper():
    """C of (right, forward, up) is Rz(psi) Rx(theta) Ry(gamma) (Bogdanov and Fomichev 2018)."""
    motion = motion_of('static', motion__psi_deg=20.0, motion__theta_deg=10.0,
                       motion__gamma_deg=-35.0)
    c = Rotation.from_euler('ZXY', [20.0, 10.0, -35.0], degrees=True).as_matrix()
    np.testing.assert_allclose(matrix(motion.at(np.array([0])).q_nb[0]), c @ FLU_FROM_RFU.T,
                               atol=1e-15)


def test_psi_zero_looks_north_theta_lifts_the_nose_gamma_lowers_the_right_wing():
    """
    psi = 0 is north, theta raises the nose, gamma lowers the right wing; psi turns to the west.

    These signs can be checked by hand.
    """
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
    The cruise has a course of 300 deg, north-west, with the nose along the course.

    The heading deviates by up to 0.8 deg from the course, and the nose is up by at most 3.8 deg,
    which shortens its level component by 0.0022.
    """
    cruise = motion_of('cruise').at(np.array([2_000_000_000_000]))
    forward = matrix(cruise.q_nb[0])[:, 0]
    assert forward[0] < 0 < forward[1]
    np.testing.assert_allclose(forward[:2], cruise.v_n[0, :2] / np.linalg.norm(cruise.v_n[0]),
                               atol=math.radians(0.8) + 0.0022)


def test_imu_at_rest_reads_gravity_up_and_earth_rate():
    """At rest an IMU reads +g on z, and the rotation rate of the Earth (REP-145)."""
    truth = motion_of('static', motion__theta_deg=0.0).at(np.array([0]))
    lat = math.radians(55.0)
    np.testing.assert_allclose(truth.f_ib_b[0], [0, 0, ellipsoid.gravity(math.sin(lat), 0.0)],
                               atol=1e-15)
    w = 7.292115e-5
    np.testing.assert_allclose(truth.omega_ib_b[0], [w * math.cos(lat), 0, w * math.sin(lat)],
                               atol=1e-18)
    assert not motion_of('static', earth__rotation=False).at(np.array([0])).omega_ib_b.any()
