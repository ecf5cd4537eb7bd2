"""
The linear error model of the navigator whose vertical channel is aided.

Inertial form, resolved in the true n: with delta the inertial attitude error, p the Cartesian
position error and s its inertial velocity,

    delta = beta + gamma,   gamma' = -omega_in x delta
    p' = s - omega_in x p,  s' = delta x f + df - (g/R) p + Omega x (Omega x p) - omega_in x s

with p_U = 0.  It is the psi-angle model of Benson 1975 (Groves section 5.7) in inertial velocity.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid


def propagate_errors(truth, omega_in, f_n, beta, df_n, fine_s, per_step, rotation, position,
                     velocity):
    """
    Return attitude (n, 3), rad, and position (n, 3), m, errors at every per_step-th fine instant.

    truth, omega_in, f_n, beta, df_n: (m, ...) on a grid of fine_s; beta: attitude error without
    the turning of n; df_n: error of the specific force.  position, velocity: initial errors in n.
    Over a step the coefficients are their means; RK4 carries the slow state.
    """
    def mean(x):
        body = x[:-1].reshape(-1, per_step, *x.shape[1:]).mean(axis=1)
        ends = (x[per_step::per_step] - x[:-1:per_step]) / (2.0 * per_step)
        return body + ends

    spin = ellipsoid.rotation_rate(rotation)
    sin, cos = np.sin(truth.lat), np.cos(truth.lat)
    r_n, r_e = ellipsoid.radii(sin)
    g = ellipsoid.gravity(sin, truth.height)
    pull = np.stack((g / (r_e + truth.height), g / (r_n + truth.height)), axis=-1)
    pull[:, 0] += spin * spin
    pull[:, 1] += (spin * sin) ** 2
    force = mean(np.cross(beta, f_n) + df_n)
    turn = mean(-np.cross(omega_in, beta))
    rows = zip(mean(omega_in).tolist(), mean(f_n).tolist(), force.tolist(), turn.tolist(),
               mean(pull).tolist())

    h = fine_s * per_step
    east, north, _ = position
    v = truth.v_n[0]
    tilt = (-north / (r_n[0] + truth.height[0]), east / (r_e[0] + truth.height[0]),
            east * math.tan(truth.lat[0]) / (r_e[0] + truth.height[0]))
    carried = quaternion.cross(tilt, tuple(v))
    turning = quaternion.cross((0.0, spin * cos[0], spin * sin[0]), (east, north, 0.0))
    state = (0.0, 0.0, 0.0, east, north, velocity[0] + carried[0] + turning[0],
             velocity[1] + carried[1] + turning[1])
    states = [state]
    for row in rows:
        state = _rk4(state, row, h)
        states.append(state)
    states = np.array(states)
    place = np.concatenate([states[:, 3:5], np.zeros((len(states), 1))], axis=1)
    return states[:, :3] + beta[::per_step], place


def _rate(y, row):
    g_e, g_n, g_u, p_e, p_n, s_e, s_n = y
    (w_e, w_n, w_u), (f_e, f_n, f_u), (a_e, a_n, _), (t_e, t_n, t_u), (k_e, k_n) = row
    # p_U = 0 at all times, hence s_U = (omega_in x p)_U
    s_u = w_e * p_n - w_n * p_e
    return (t_e - (w_n * g_u - w_u * g_n), t_n - (w_u * g_e - w_e * g_u),
            t_u - (w_e * g_n - w_n * g_e),
            s_e + w_u * p_n, s_n - w_u * p_e,
            a_e + g_n * f_u - g_u * f_n - k_e * p_e - (w_n * s_u - w_u * s_n),
            a_n + g_u * f_e - g_e * f_u - k_n * p_n - (w_u * s_e - w_e * s_u))


def _rk4(y, row, h):
    def ahead(k, step):
        return tuple(a + step * b for a, b in zip(y, k))

    k1 = _rate(y, row)
    k2 = _rate(ahead(k1, 0.5 * h), row)
    k3 = _rate(ahead(k2, 0.5 * h), row)
    k4 = _rate(ahead(k3, h), row)
    return tuple(a + h / 6.0 * (b + 2.0 * (c + d) + e)
                 for a, b, c, d, e in zip(y, k1, k2, k3, k4))
