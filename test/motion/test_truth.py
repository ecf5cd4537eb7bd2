"""Velocity, rate and force of every motion compared with differences of its poses."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ins_sim.core.earth import ellipsoid
from ins_sim.settings.motion import MOTIONS
from support.conventional import matrix, motion_of

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


@pytest.mark.parametrize('kind', [kind for kind in MOTIONS if kind not in (
    'recording', 'guided')])
def test_truth_is_consistent_by_finite_differences(kind):
    """
    Velocity, rate and force agree with sixth-order differences of positions and attitudes.

    The differences span 20 ms. Their truncation is the difference from those over 40 ms divided by
    2^6 - 1; a half of that divisor leaves room for the next order. An ECEF coordinate rounds to
    2^-30 m, an angle to 2^-52 of the largest one, 2 pi rad a second.
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
