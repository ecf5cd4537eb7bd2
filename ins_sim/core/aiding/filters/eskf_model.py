"""The linear model of the errors that the aided navigator estimates: twenty states."""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.matrix import skew
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import applied, product

SIZE = 20
P, V, PHI, BA, BG = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), slice(12, 15)
ETA, MU, KX, KZ = slice(15, 17), 17, 18, 19
DOWN, TILT = (2, 5), slice(6, 8)
STATES = (*(f'{name}_{axis}' for name in ('position', 'velocity', 'attitude') for axis in 'enu'),
          *(f'{name}_{axis}' for name in ('accelerometer_bias', 'gyro_bias') for axis in 'xyz'),
          'eta_x', 'eta_y', 'mounting', 'scale_x', 'scale_z')


# Rows of F that are not zero, and how many columns are not: those from ETA on are.
MOVING, CAUSES = np.array((*range(9), 15, 16)), 15


def dynamics(lat, height, v, c, f_n, spin):
    """
    Return the rows MOVING and the first CAUSES columns of F of x' = F x, (11, 15).

    lat rad, height m, v (3,) m/s ENU; c: C_nb, nine floats; f_n (3,) specific force in n, m/s^2;
    spin: rate of the Earth, rad/s.  The change of the radii with latitude and that of gravity
    with latitude are left out, parts in 100 of the smallest terms.
    """
    v_e, v_n, v_u = v
    f_e, f_n, f_u = f_n
    c_ex, c_ey, c_ez, c_nx, c_ny, c_nz, c_ux, c_uy, c_uz = c
    sin, cos = elementary.sincos(lat)
    tan = sin / cos
    r_n, r_e = ellipsoid.radii(sin)
    r_n, r_e = r_n + height, r_e + height
    # How the rates of the Earth (o) and of transport (t) change with position (n: with that to
    # the north, u: up), per m, and the latter with velocity, per m/s.
    o_un, o_nn = spin * cos / r_n, -spin * sin / r_n
    t_eu, t_nu = v_n / (r_n * r_n), -v_e / (r_e * r_e)
    t_un, t_uu = v_e / (r_e * cos * cos * r_n), -v_e * tan / (r_e * r_e)
    by_e, by_n = 1.0 / r_e, 1.0 / r_n
    up_by_e = tan / r_e
    # Rate of n in inertial space, and the same with that of the Earth twice.
    w_e, w_n, w_u = -v_n / r_n, spin * cos + v_e / r_e, spin * sin + v_e * tan / r_e
    x_n, x_u = w_n + spin * cos, w_u + spin * sin
    d_nn, d_un = 2.0 * o_nn, 2.0 * o_un + t_un
    gradient = 2.0 * ellipsoid.GRAVITY_EQUATOR / ellipsoid.SEMI_MAJOR
    return np.array((
        (v_u / r_e - tan * v_n / r_n, v_e * tan / r_n, -v_e / r_e,
         1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, v_u / r_n, -v_n / r_n,
         0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, v_n * d_un - v_u * d_nn, v_n * t_uu - v_u * t_nu,
         v_n * up_by_e - v_u * by_e, x_u, -x_n,
         0.0, f_u, -f_n, -c_ex, -c_ey, -c_ez, 0.0, 0.0, 0.0),
        (0.0, -v_e * d_un, v_u * t_eu - v_e * t_uu,
         -v_e * up_by_e - x_u, -v_u * by_n, w_e,
         -f_u, 0.0, f_e, -c_nx, -c_ny, -c_nz, 0.0, 0.0, 0.0),
        (0.0, v_e * d_nn, v_e * t_nu - v_n * t_eu + gradient,
         v_e * by_e + x_n, v_n * by_n - w_e, 0.0,
         f_n, -f_e, 0.0, -c_ux, -c_uy, -c_uz, 0.0, 0.0, 0.0),
        (0.0, 0.0, -t_eu, 0.0, by_n, 0.0,
         0.0, w_u, -w_n, 0.0, 0.0, 0.0, -c_ex, -c_ey, -c_ez),
        (0.0, -o_nn, -t_nu, -by_e, 0.0, 0.0,
         -w_u, 0.0, w_e, 0.0, 0.0, 0.0, -c_nx, -c_ny, -c_nz),
        (0.0, -o_un - t_un, -t_uu, -up_by_e, 0.0, 0.0,
         w_n, -w_e, 0.0, 0.0, 0.0, 0.0, -c_ux, -c_uy, -c_uz),
        # eta' = (C' dV + C' [V x] phi) forward and left
        (0.0, 0.0, 0.0, c_ex, c_nx, c_ux,
         c_nx * v_u - c_ux * v_n, c_ux * v_e - c_ex * v_u, c_ex * v_n - c_nx * v_e,
         0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0, c_ey, c_ny, c_uy,
         c_ny * v_u - c_uy * v_n, c_uy * v_e - c_ey * v_u, c_ey * v_n - c_ny * v_e,
         0.0, 0.0, 0.0, 0.0, 0.0, 0.0)))


def change(f, dt):
    """
    Return exp(F dt) less 1 to second order, in the rows and columns of ``dynamics``.

    F being that of mid-interval, what is left out is of the order dt^3.
    """
    a = f * dt
    # Of the columns, only the first nine are rows too.
    return a + 0.5 * product(a[:, :9], a[:9])


def transition(n):
    """Return the transition matrix (20, 20) of a ``change``."""
    phi = np.eye(SIZE)
    phi[MOVING, :CAUSES] += n
    return phi


def propagated(p, n):
    """Return (1 + N) P (1 + N)' of a covariance (20, 20) and a ``change``."""
    left = p.copy()
    left[MOVING] += product(n, p[:CAUSES])
    both = left.copy()
    both[:, MOVING] += product(left[:, :CAUSES], n.T)
    return both


def meter(mean, mu, kx, kz):
    """
    Return the velocity that the meter reads of a mean velocity in b, and its matrices.

    mean: forward and left, m/s; mu rad (antennas turned left), kx, kz: estimates.  Return the
    prediction (2,), its matrix of the mean (2, 2) and its columns of mu, kx, kz (2, 3).
    """
    s, c = elementary.sincos(mu)
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
    h[0:3, PHI] = -skew(applied(c, lever))
    h[3:6, PHI] = -skew(applied(c, quaternion.cross(omega, lever)))
    h[3:6, BG] = product(c, skew(lever))
    return h
