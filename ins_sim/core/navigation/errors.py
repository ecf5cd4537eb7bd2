"""Errors of the navigation solution against the truth, and their drift."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.frames import level_frame


def position_error(lat, lon, height, lat_t, lon_t, height_t):
    """Return East, North, Up from the true point (..._t) to another, floats, m."""
    return ellipsoid.offset(lat_t, lon_t, height_t, (lat, lon, height))


def level_errors(solution, truth):
    """
    Return attitude, velocity and position errors of a solution, tuples of three floats.

    solution, truth: (lat, lon, height, v_n, q_nb).  The attitude error is that of q_nb, each in
    its own n: q_nb = exp(error) q_nb_true (phi-angle), rad.
    """
    lat, lon, height, v, q_nb = solution
    lat_t, lon_t, height_t, v_t, q_nb_t = truth
    turned = quaternion.logarithm(quaternion.multiply(q_nb, quaternion.conjugate(q_nb_t)))
    return (turned, (v[0] - v_t[0], v[1] - v_t[1], v[2] - v_t[2]),
            position_error(lat, lon, height, lat_t, lon_t, height_t))


class ErrorMeter:
    """
    Attitude, velocity and position errors in East, North, Up, and the drift of the attitude.

    The attitude error is inertial: the rotation from the true to the computed q_ib, resolved in n
    (A_z' A_z^T of Bogdanov and Fomichev 2018; docs/theory.md, "Errors"). Its growth is
    accumulated as beta' = C_ni d(error_i), so that the rotation of n in inertial space does not
    count. The drift is the least-squares slope of beta over all samples since the start (running
    form: Welford 1962).
    """

    def __init__(self, spin):
        self._spin = spin
        self._last = None
        self._count = 0

    def measure(self, t_s, state, truth):
        """
        Return attitude, velocity, position and drift, tuples of three floats.

        t_s: time since the start, s; state: (q_ib, lat, lon, height, v); truth: (lat, lon,
        height, v_n, q_nb).
        """
        q_ib, lat, lon, height, v = state
        lat_t, lon_t, height_t, v_t, q_nb_t = truth
        turned = self._spin * t_s
        q_nb = quaternion.multiply(quaternion.conjugate(level_frame(lat_t, lon_t + turned)), q_ib)
        delta = quaternion.logarithm(quaternion.multiply(q_nb, quaternion.conjugate(q_nb_t)))
        position = position_error(lat, lon, height, lat_t, lon_t, height_t)
        velocity = (v[0] - v_t[0], v[1] - v_t[1], v[2] - v_t[2])
        return delta, velocity, position, self._slope(t_s, lat_t, lon_t + turned, delta)

    def _slope(self, t, lat, lon, delta):
        if self._last is None:
            self.beta = delta
            self._mean_t, self._mean_b = t, delta
            self._s_tt, self._s_tb = 0.0, (0.0, 0.0, 0.0)
        else:
            lat_0, lon_0, delta_0 = self._last
            # turn of n in i over the interval, at its middle
            mid, d_lon = 0.5 * (lat + lat_0), math.remainder(lon - lon_0, 2.0 * math.pi)
            turn = (lat_0 - lat, d_lon * math.cos(mid), d_lon * math.sin(mid))
            mean = (0.5 * (delta[0] + delta_0[0]), 0.5 * (delta[1] + delta_0[1]),
                    0.5 * (delta[2] + delta_0[2]))
            c = quaternion.cross(turn, mean)
            b = self.beta
            self.beta = b = (b[0] + delta[0] - delta_0[0] + c[0],
                             b[1] + delta[1] - delta_0[1] + c[1],
                             b[2] + delta[2] - delta_0[2] + c[2])
            n = self._count
            off, p = t - self._mean_t, self._mean_b
            db = (b[0] - p[0], b[1] - p[1], b[2] - p[2])
            weight = off * n / (n + 1.0)
            self._s_tt += weight * off
            s = self._s_tb
            self._s_tb = (s[0] + weight * db[0], s[1] + weight * db[1], s[2] + weight * db[2])
            self._mean_t += off / (n + 1.0)
            self._mean_b = (p[0] + db[0] / (n + 1.0), p[1] + db[1] / (n + 1.0),
                            p[2] + db[2] / (n + 1.0))
        self._last = (lat, lon, delta)
        self._count += 1
        if self._s_tt == 0.0:
            return 0.0, 0.0, 0.0
        s, per = self._s_tb, 1.0 / self._s_tt
        return s[0] * per, s[1] * per, s[2] * per
