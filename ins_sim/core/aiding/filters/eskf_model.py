"""The linear model of the errors that the aided navigator estimates: twenty states."""

import math

import numpy as np

from ins_sim.core.attitude.matrix import skew
from ins_sim.core.earth import ellipsoid

SIZE = 20
P, V, PHI, BA, BG = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), slice(12, 15)
ETA, MU, KX, KZ = slice(15, 17), 17, 18, 19
DOWN, TILT = (2, 5), slice(6, 8)
STATES = (*(f'{name}_{axis}' for name in ('position', 'velocity', 'attitude') for axis in 'enu'),
          *(f'{name}_{axis}' for name in ('accelerometer_bias', 'gyro_bias') for axis in 'xyz'),
          'eta_x', 'eta_y', 'mounting', 'scale_x', 'scale_z')


def dynamics(lat, height, v, c, f_n, spin):
    """
    Return F of x' = F x, (20, 20).

    lat rad, height m, v (3,) m/s ENU; c (3, 3) C_nb; f_n (3,) specific force in n, m/s^2; spin:
    rate of the Earth, rad/s.  The change of the radii with latitude and that of gravity with
    latitude are left out, parts in 100 of the smallest terms.
    """
    v_e, v_n, v_u = v
    sin, cos = math.sin(lat), math.cos(lat)
    tan = sin / cos
    r_n, r_e = ellipsoid.radii(sin)
    r_n, r_e = r_n + height, r_e + height
    turn = np.array((-v_n / r_n, v_e / r_e, v_e * tan / r_e))
    earth_rate = np.array((0.0, spin * cos, spin * sin))
    # of the position error: rates of the Earth and of transport, rad/s
    d_earth = np.zeros((3, 3))
    d_earth[1, 1], d_earth[2, 1] = -earth_rate[2] / r_n, earth_rate[1] / r_n
    d_turn = np.zeros((3, 3))
    d_turn[0, 2] = v_n / r_n ** 2
    d_turn[1, 2] = -v_e / r_e ** 2
    d_turn[2, 1], d_turn[2, 2] = v_e / (r_e * cos * cos * r_n), -v_e * tan / r_e ** 2
    d_turn_v = np.zeros((3, 3))
    d_turn_v[0, 1], d_turn_v[1, 0], d_turn_v[2, 0] = -1.0 / r_n, 1.0 / r_e, tan / r_e
    f = np.zeros((SIZE, SIZE))
    f[0, 0], f[0, 1], f[0, 2] = v_u / r_e - tan * v_n / r_n, v_e * tan / r_n, -v_e / r_e
    f[1, 1], f[1, 2] = v_u / r_n, -v_n / r_n
    f[0, 3] = f[1, 4] = f[2, 5] = 1.0
    v_cross = skew(v)
    f[V, P] = v_cross @ (2.0 * d_earth + d_turn)
    f[5, 2] += 2.0 * ellipsoid.GRAVITY_EQUATOR / ellipsoid.SEMI_MAJOR
    f[V, V] = v_cross @ d_turn_v - skew(2.0 * earth_rate + turn)
    f[V, PHI] = -skew(f_n)
    f[V, BA] = -c
    f[PHI, P] = -d_earth - d_turn
    f[PHI, V] = -d_turn_v
    f[PHI, PHI] = -skew(earth_rate + turn)
    f[PHI, BG] = -c
    # eta' = (C' dV + C' [V x] phi) forward and left
    back = c.T[:2]
    f[ETA, V] = back
    f[ETA, PHI] = back @ v_cross
    return f


def transition(f, dt):
    """Return exp(F dt) to second order; F being that of mid-interval the rest is dt^3."""
    a = f * dt
    return np.eye(len(f)) + a + 0.5 * (a @ a)


def meter(mean, mu, kx, kz):
    """
    Return the velocity that the meter reads of a mean velocity in b, and its matrices.

    mean: forward and left, m/s; mu rad (antennas turned left), kx, kz: estimates.  Return the
    prediction (2,), its matrix of the mean (2, 2) and its columns of mu, kx, kz (2, 3).
    """
    s, c = math.sin(mu), math.cos(mu)
    turned = c * mean[0] + s * mean[1], c * mean[1] - s * mean[0]
    read = np.array(((1.0 + kx) * turned[0], (1.0 + kz) * turned[1]))
    of_mean = np.array((((1.0 + kx) * c, (1.0 + kx) * s), (-(1.0 + kz) * s, (1.0 + kz) * c)))
    columns = np.array((((1.0 + kx) * turned[1], turned[0], 0.0),
                        (-(1.0 + kz) * turned[0], 0.0, turned[1])))
    return read, of_mean, columns


def meter_matrix(mean, mu, kx, kz, time_s):
    """Return the prediction (2,) and H (2, 20) of a fix whose window is time_s long."""
    read, of_mean, columns = meter(mean, mu, kx, kz)
    h = np.zeros((2, SIZE))
    h[:, ETA] = of_mean / time_s
    h[:, MU:] = columns
    return read, h


def gnss_matrix(c, lever, omega):
    """
    Return H (6, 20) of the antenna's position (m) and velocity (m/s), East, North, Up.

    c (3, 3) C_nb; lever (3,) m, omega (3,) rad/s relative to the Earth, in b.
    """
    h = np.zeros((6, SIZE))
    h[0:3, P] = h[3:6, V] = np.eye(3)
    h[0:3, PHI] = -skew(c @ lever)
    h[3:6, PHI] = -skew(c @ np.cross(omega, lever))
    h[3:6, BG] = c @ skew(lever)
    return h
