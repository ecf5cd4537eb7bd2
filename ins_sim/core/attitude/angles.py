"""Roll, pitch and compass heading of q_nb, rotations about axes, and the inverse conversions."""

import math

import numpy as np

from ins_sim.core.numerics import elementary, taylor
from . import quaternion


def from_compass(roll, pitch, heading):
    """
    Return q_nb (n, 4) from (n,) roll (right side down), pitch (nose up), heading (clockwise), rad.

    Equal to ``from_angles`` with psi = -heading.
    """
    angles = (-np.asarray(heading, dtype=float), pitch, roll)
    q = from_angles(*(taylor.Series(np.atleast_1d(np.asarray(a, dtype=float))[None])
                      for a in angles))
    return np.stack([x.value for x in q], axis=-1)


def to_compass(q_nb):
    """Return roll, pitch, heading (0 to 2 pi), rad, of q_nb (..., 4)."""
    q = np.moveaxis(np.asarray(q_nb, dtype=float), -1, 0)
    zero, one = np.zeros_like(q[0]), np.ones_like(q[0])
    # The vertical resolved in b gives roll and pitch; the forward axis in n gives the heading.
    up = quaternion.rotate_back(q, (zero, zero, one))
    east, north, _ = quaternion.rotate(q, (one, zero, zero))
    pitch = elementary.atan2(up[0], np.sqrt(up[1] * up[1] + up[2] * up[2]))
    return (elementary.atan2(up[1], up[2]), pitch,
            elementary.atan2(east, north) % (2.0 * math.pi))


def within_half_turn_deg(angle):
    """Return an angle, deg, reduced to +-180; an angle already in that range keeps its bits."""
    return np.where(np.abs(angle) <= 180.0, angle, (angle + 180.0) % 360.0 - 180.0)


def about_axis(axis, angle):
    """Return the quaternion Series of a rotation by the angle Series about axis 0, 1 or 2."""
    s, c = taylor.sincos(angle * 0.5)
    zero = s * 0.0
    return tuple(s if k == axis else zero for k in range(3)) + (c,)


def from_angles(psi, theta, gamma):
    """
    Return q_nb (FLU to ENU) of Series psi (counter-clockwise), theta, gamma, rad.

    C = Rz(psi) Rx(theta) Ry(gamma) of Bogdanov and Fomichev 2018 acts on axes (right, forward,
    up); on (forward, left, up) it is Rz(psi + 90 deg) Ry(-theta) Rx(gamma).
    """
    sz, cz = taylor.sincos((psi + 0.5 * math.pi) * 0.5)
    sy, cy = taylor.sincos(theta * -0.5)
    sx, cx = taylor.sincos(gamma * 0.5)
    cyx, syx, cysx, sycx = cy * cx, sy * sx, cy * sx, sy * cx
    return (cz * cysx - sz * sycx, cz * sycx + sz * cysx, sz * cyx - cz * syx,
            cz * cyx + sz * syx)


def from_rpy(roll, pitch, yaw):
    """Return q_bs from roll, pitch, yaw about the fixed axes x, y, z (URDF), floats, rad."""
    return quaternion.multiply(
        quaternion.exponential((0.0, 0.0, yaw)),
        quaternion.multiply(quaternion.exponential((0.0, pitch, 0.0)),
                            quaternion.exponential((roll, 0.0, 0.0))))


def roll_of_matrix(c):
    """Return gamma, rad, from C_nb = Rz Ry(-theta) Rx(gamma), nine floats row by row."""
    return elementary.atan2(c[7], c[8])
