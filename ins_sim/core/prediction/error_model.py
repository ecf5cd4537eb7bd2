"""
Linear error model of a navigator whose vertical channel is aided.

Inertial form, resolved in the true n, with the inertial attitude error delta, the Cartesian
position error p and its inertial velocity s:

    delta = beta + gamma,   gamma' = -omega_in x delta
    p' = s - omega_in x p,  s' = delta x f + df - (g/R) p + Omega x (Omega x p) - omega_in x s

with p_U = 0. This is the psi-angle model of Benson 1975 (Groves section 5.7) in inertial velocity.
"""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import compilation, elementary


class ErrorModel:
    """
    Attitude and position errors, propagated in blocks on a grid in time.

    The coefficients of a step are means over its fine intervals; the slow state is propagated by
    RK4.

    Parameters
    ----------
    fine_s : interval of the grid, s
    per_step : intervals of a step
    rotation : whether the Earth rotates
    position, velocity : initial errors in n, m and m/s
    gravity : one of ``ellipsoid.GRAVITY_TERMS``
    """

    def __init__(self, fine_s, per_step, rotation, position, velocity, gravity=None):
        self._per_step, self._step_s = per_step, fine_s * per_step
        self._spin = ellipsoid.rotation_rate(rotation)
        self._start, self._state = (position, velocity), None
        self._gravity = gravity

    def advance(self, truth, omega_in, f_n, beta, df_n):
        """
        Return the errors of attitude (n + 1, 3), rad, and position (n + 1, 3), m, after n steps.

        Parameters
        ----------
        truth, omega_in, f_n : (n per_step + 1, ...); the first instant is the last one of the
            previous block, in all arguments
        beta : attitude error, without the effect of the rotation of n
        df_n : error of the specific force

        """
        sin, cos = elementary.sincos(truth.lat)
        r_n, r_e = ellipsoid.radii(sin)
        g = ellipsoid.gravity(sin, truth.height, self._gravity)
        spin = self._spin
        pull = np.stack((g / (r_e + truth.height), g / (r_n + truth.height)), axis=-1)
        pull[:, 0] += spin * spin
        level = spin * sin
        pull[:, 1] += level * level
        if self._state is None:
            self._state = self._first_state(truth, r_n, r_e, sin, cos)
        means = [self._means(values) for values in (
            omega_in, f_n, np.cross(beta, f_n) + df_n, -np.cross(omega_in, beta), pull)]
        states = np.empty((len(pull) // self._per_step + 1, 7))
        states[0] = self._state
        count = len(states) - 1
        self._state = compilation.run(advance_through, count,
                                      (self._state, self._step_s, count, *means), states[1:])
        place = np.concatenate([states[:, 3:5], np.zeros((count + 1, 1))], axis=1)
        return states[:, :3] + beta[::self._per_step], place

    def _first_state(self, truth, r_n, r_e, sin, cos):
        (east, north, _), velocity = self._start
        tilt = (-north / (r_n[0] + truth.height[0]), east / (r_e[0] + truth.height[0]),
                east * (sin[0] / cos[0]) / (r_e[0] + truth.height[0]))
        carried = quaternion.cross(tilt, tuple(truth.v_n[0]))
        turning = quaternion.cross((0.0, self._spin * cos[0], self._spin * sin[0]),
                                   (east, north, 0.0))
        return (0.0, 0.0, 0.0, east, north, velocity[0] + carried[0] + turning[0],
                velocity[1] + carried[1] + turning[1])

    def _means(self, x):
        """Return the means over the steps, by the trapezoidal rule."""
        n = self._per_step
        total = x[:-1:n]
        for k in range(1, n):
            total = total + x[k:-1:n]
        return total / n + (x[n::n] - x[:-1:n]) / (2.0 * n)


def advance_through(state, h, count, omega_in, f_n, force, turn, pull, out):
    """Advance over steps whose coefficients are in flat columns; return the final state."""
    for k in range(count):
        i, j = 3 * k, 2 * k
        state = advance_errors(
            state, (omega_in[i], omega_in[i + 1], omega_in[i + 2]),
            (f_n[i], f_n[i + 1], f_n[i + 2]), (force[i], force[i + 1]),
            (turn[i], turn[i + 1], turn[i + 2]), (pull[j], pull[j + 1]), h)
        for axis in range(7):
            out[7 * k + axis] = state[axis]
    return state


def advance_errors(y, omega_in, f_n, force, turn, pull, h):
    """
    Advance the slow state by one step with RK4; return it.

    Parameters
    ----------
    y : gamma (3), p_E, p_N, s_E, s_N, in rad, m and m/s
    omega_in, f_n : (3,) means over the step, rad/s and m/s^2
    force : (2,) mean horizontal force error, east and north, m/s^2
    turn : (3,) mean rotation of beta, rad/s
    pull : (2,) mean factors of p_E and p_N, 1/s^2
    h : length of the step, s

    """
    row = (*omega_in, *f_n, *force, *turn, *pull)
    k1 = _rate(y, row)
    k2 = _rate(_ahead(y, k1, 0.5 * h), row)
    k3 = _rate(_ahead(y, k2, 0.5 * h), row)
    a, b, c, d, e, f, g = _rate(_ahead(y, k3, h), row)
    p, q, r, s, t, u, v = y
    sixth = h / 6.0
    return (p + sixth * (k1[0] + 2.0 * (k2[0] + k3[0]) + a),
            q + sixth * (k1[1] + 2.0 * (k2[1] + k3[1]) + b),
            r + sixth * (k1[2] + 2.0 * (k2[2] + k3[2]) + c),
            s + sixth * (k1[3] + 2.0 * (k2[3] + k3[3]) + d),
            t + sixth * (k1[4] + 2.0 * (k2[4] + k3[4]) + e),
            u + sixth * (k1[5] + 2.0 * (k2[5] + k3[5]) + f),
            v + sixth * (k1[6] + 2.0 * (k2[6] + k3[6]) + g))


def _ahead(y, k, step):
    a, b, c, d, e, f, g = y
    p, q, r, s, t, u, v = k
    return (a + step * p, b + step * q, c + step * r, d + step * s, e + step * t, f + step * u,
            g + step * v)


def _rate(y, row):
    g_e, g_n, g_u, p_e, p_n, s_e, s_n = y
    w_e, w_n, w_u, f_e, f_n, f_u, a_e, a_n, t_e, t_n, t_u, k_e, k_n = row
    # p_U = 0 at all times, hence s_U = (omega_in x p)_U.
    s_u = w_e * p_n - w_n * p_e
    return (t_e - (w_n * g_u - w_u * g_n), t_n - (w_u * g_e - w_e * g_u),
            t_u - (w_e * g_n - w_n * g_e),
            s_e + w_u * p_n, s_n - w_u * p_e,
            a_e + g_n * f_u - g_u * f_n - k_e * p_e - (w_n * s_u - w_u * s_n),
            a_n + g_u * f_e - g_e * f_u - k_n * p_n - (w_u * s_e - w_e * s_u))
