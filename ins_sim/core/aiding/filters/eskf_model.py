"""Linear error model of the error-state Kalman filter: twenty states."""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.matrix import skew
from ins_sim.core.navigation.error_dynamics import inertial_rows
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import applied, product

SIZE = 20
P, V, PHI, BA, BG = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), slice(12, 15)
ETA, MU, KX, KZ = slice(15, 17), 17, 18, 19
DOWN, TILT = (2, 5), slice(6, 8)
STATES = (*(f'{name}_{axis}' for name in ('position', 'velocity', 'attitude') for axis in 'enu'),
          *(f'{name}_{axis}' for name in ('accelerometer_bias', 'gyro_bias') for axis in 'xyz'),
          'eta_x', 'eta_y', 'mounting', 'scale_x', 'scale_z')


# Rows of F that are not zero, and number of nonzero columns: the columns from ETA on are zero.
MOVING, CAUSES = np.array((*range(9), 15, 16)), 15


def dynamics(lat, height, v, c, f_n, spin):
    """
    Return the rows MOVING and the first CAUSES columns of F in x' = F x, (11, 15).

    The arguments are those of ``error_dynamics.inertial_rows``. The nine rows of that function
    are followed by two for eta' = (C' dV + C' [V x] phi), forward and left.
    """
    v_e, v_n, v_u = v
    c_ex, c_ey, _, c_nx, c_ny, _, c_ux, c_uy, _ = c
    return np.array((
        *inertial_rows(lat, height, v, c, f_n, spin),
        (0.0, 0.0, 0.0, c_ex, c_nx, c_ux,
         c_nx * v_u - c_ux * v_n, c_ux * v_e - c_ex * v_u, c_ex * v_n - c_nx * v_e,
         0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0, c_ey, c_ny, c_uy,
         c_ny * v_u - c_uy * v_n, c_uy * v_e - c_ey * v_u, c_ey * v_n - c_ny * v_e,
         0.0, 0.0, 0.0, 0.0, 0.0, 0.0)))


def transition(n):
    """Return the transition matrix (20, 20), given ``error_dynamics.change`` of the rows."""
    phi = np.eye(SIZE)
    phi[MOVING, :CAUSES] += n
    return phi


def propagated(p, n):
    """Return (1 + N) P (1 + N)', given a covariance P (20, 20) and the ``change`` N."""
    left = p.copy()
    left[MOVING] += product(n, p[:CAUSES])
    both = left.copy()
    both[:, MOVING] += product(left[:, :CAUSES], n.T)
    return both


def meter(mean, mu, kx, kz):
    """
    Return the predicted reading of the velocity meter and its derivatives.

    Parameters
    ----------
    mean : mean velocity in b, forward and left, m/s
    mu : mounting error, rad; positive if the antennas are turned left
    kx, kz : forward and lateral scale errors

    Returns
    -------
    read : (2,) predicted reading, m/s
    of_mean : (2, 2) derivative with respect to the mean velocity
    columns : (2, 3) derivative with respect to mu, kx, kz

    """
    s, c = elementary.sincos(mu)
    turned = c * mean[0] + s * mean[1], c * mean[1] - s * mean[0]
    read = np.array(((1.0 + kx) * turned[0], (1.0 + kz) * turned[1]))
    of_mean = np.array((((1.0 + kx) * c, (1.0 + kx) * s), (-(1.0 + kz) * s, (1.0 + kz) * c)))
    columns = np.array((((1.0 + kx) * turned[1], turned[0], 0.0),
                        (-(1.0 + kz) * turned[0], 0.0, turned[1])))
    return read, of_mean, columns


def meter_matrix(mean, mu, kx, kz, time_s):
    """Return the predicted reading (2,) and H (2, 20) of a fix whose window is time_s long."""
    read, of_mean, columns = meter(mean, mu, kx, kz)
    h = np.zeros((2, SIZE))
    h[:, ETA] = of_mean / time_s
    h[:, MU:] = columns
    return read, h


def gnss_matrix(c, lever, omega):
    """
    Return H (6, 20) for the position (m) and velocity (m/s) of the antenna, east, north, up.

    Parameters
    ----------
    c : (3, 3) C_nb
    lever : (3,) position of the antenna relative to the IMU, in b, m
    omega : (3,) angular rate of b relative to the Earth, in b, rad/s

    """
    h = np.zeros((6, SIZE))
    h[0:3, P] = h[3:6, V] = np.eye(3)
    h[0:3, PHI] = -skew(applied(c, lever))
    h[3:6, PHI] = -skew(applied(c, quaternion.cross(omega, lever)))
    h[3:6, BG] = product(c, skew(lever))
    return h
