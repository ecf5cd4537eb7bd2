"""
Errors of the navigation solution against the truth, and their drift.

All functions are pure and take floats (live) or arrays (offline). ``ErrorMeter`` keeps the state
of the drift from sample to sample.
"""

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.frames import frame_of_halves
from ins_sim.core.numerics import elementary


def position_error(lat, lon, height, lat_t, lon_t, height_t):
    """Return the offset east, north, up of a point from the true point (..._t), m."""
    return ellipsoid.offset(lat_t, lon_t, height_t, (lat, lon, height))


def level_errors(solution, truth):
    """
    Return the attitude, velocity and position errors of a solution, three tuples of three.

    Parameters
    ----------
    solution, truth : (lat, lon, height, v_n, q_nb) in rad, rad, m, m/s; floats or arrays

    Returns
    -------
    attitude : rotation vector of the phi-angle error, q_nb = exp(error) q_nb_true, rad; each
        attitude is relative to the level frame at its own position
    velocity, position : solution minus truth, east, north, up, m/s and m

    """
    lat, lon, height, v, q_nb = solution
    lat_t, lon_t, height_t, v_t, q_nb_t = truth
    return (attitude_error(q_nb, q_nb_t), velocity_error(v, v_t),
            position_error(lat, lon, height, lat_t, lon_t, height_t))


def attitude_error(q_nb, q_nb_t):
    """Return the rotation vector, rad, from the true to the computed attitude: q = exp(.) q_t."""
    return quaternion.logarithm(quaternion.multiply(q_nb, quaternion.conjugate(q_nb_t)))


def velocity_error(v, v_t):
    """Return the velocity minus the true one, m/s."""
    return v[0] - v_t[0], v[1] - v_t[1], v[2] - v_t[2]


def inertial_errors(state, truth, earth_angle):
    """
    Return the attitude, velocity and position errors of a strapdown, three tuples of three.

    The attitude error is inertial: the rotation from the true to the computed q_ib, resolved in n
    (A_z' A_z^T of Bogdanov and Fomichev 2018; docs/theory/error_definitions.md).

    Parameters
    ----------
    state : (q_ib, lat, lon, height, v) in rad, rad, m, m/s; floats or arrays
    truth : (lat, lon, height, v_n, q_nb)
    earth_angle : angle of the rotation from i to e, zero at the start of the run, rad

    """
    q_ib, lat, lon, height, v = state
    lat_t, lon_t, height_t, v_t, q_nb_t = truth
    sin_half, cos_half = elementary.sincos(0.5 * lat_t)
    q_in = frame_of_halves(sin_half, cos_half, *elementary.sincos(0.5 * (lon_t + earth_angle)))
    delta = attitude_error(quaternion.multiply(quaternion.conjugate(q_in), q_ib), q_nb_t)
    sin_lat, cos_lat = 2.0 * sin_half * cos_half, 1.0 - 2.0 * sin_half * sin_half
    position = ellipsoid.offset_at(lat_t, lon_t, height_t, (lat, lon, height), sin_lat, cos_lat)
    return delta, velocity_error(v, v_t), position


# Initial state of ``drift``. Members: the last sample (latitude and inertial longitude of the
# truth, attitude error); the accumulated error beta relative to its start; and, over all samples,
# the count and the sums of t, t^2, beta and t beta.
NO_DRIFT = ((0.0, 0.0, (0.0, 0.0, 0.0)), (0.0, 0.0, 0.0), 0.0, 0.0, 0.0, (0.0, 0.0, 0.0),
            (0.0, 0.0, 0.0))


def drift(carry, t, lat, lon, delta):
    """
    Return the new state of the accumulation and the drift of the attitude after a sample.

    The growth of the error is accumulated as beta' = C_ni d(error_i), so that the rotation of n
    in inertial space does not count. The drift is the least-squares slope of beta over all
    samples since the start.

    Parameters
    ----------
    carry : state of the accumulation, at first NO_DRIFT
    t : time since the start, s
    lat, lon : latitude and inertial longitude of the truth, rad
    delta : (3,) attitude error, rad

    Returns
    -------
    carry, drift : the new state, and the drift (3,), rad/s

    """
    last, beta, count, s_t, s_tt, s_b, s_tb = carry
    if count > 0.0:
        lat_0, lon_0, delta_0 = last
        # Rotation of n in i over the interval, evaluated at its middle.
        d_lon = elementary.shorter_turn(lon - lon_0)
        sin, cos = elementary.sincos(0.5 * (lat + lat_0))
        mean = (0.5 * (delta[0] + delta_0[0]), 0.5 * (delta[1] + delta_0[1]),
                0.5 * (delta[2] + delta_0[2]))
        c = quaternion.cross((lat_0 - lat, d_lon * cos, d_lon * sin), mean)
        beta = (beta[0] + (delta[0] - delta_0[0] + c[0]), beta[1] + (delta[1] - delta_0[1] + c[1]),
                beta[2] + (delta[2] - delta_0[2] + c[2]))
    count, s_t, s_tt = count + 1.0, s_t + t, s_tt + t * t
    s_b = s_b[0] + beta[0], s_b[1] + beta[1], s_b[2] + beta[2]
    s_tb = s_tb[0] + t * beta[0], s_tb[1] + t * beta[1], s_tb[2] + t * beta[2]
    spread = count * s_tt - s_t * s_t
    per = 1.0 / (spread + (spread == 0.0))
    slope = ((count * s_tb[0] - s_t * s_b[0]) * per, (count * s_tb[1] - s_t * s_b[1]) * per,
             (count * s_tb[2] - s_t * s_b[2]) * per)
    return ((lat, lon, delta), beta, count, s_t, s_tt, s_b, s_tb), slope


class ErrorMeter:
    """Measures attitude, velocity and position errors in east, north, up, and attitude drift."""

    def __init__(self, spin):
        self.spin = spin
        self.carry = NO_DRIFT

    def measure(self, t_s, state, truth):
        """
        Return attitude error, velocity error, position error and drift, tuples of three floats.

        t_s: time since the start, s; state, truth: see ``inertial_errors``.
        """
        earth_angle = self.spin * t_s
        delta, velocity, position = inertial_errors(state, truth, earth_angle)
        self.carry, slope = drift(self.carry, t_s, truth[0], truth[1] + earth_angle, delta)
        return delta, velocity, position, slope
