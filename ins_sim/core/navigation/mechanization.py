"""
Strapdown mechanization: advance position and velocity over one sampling interval.

The inertial attitude q_ib is integrated separately, from the gyros alone
(``attitude.integration``). The step resolves the velocity increment in the local level frame at
mid-interval. Sines and cosines of latitude and of inertial longitude are advanced from one
mid-interval to the next by small rotations. The position at mid-interval is extrapolated with the
acceleration of the previous interval; the velocity there follows from the velocity increment of
this interval and the Coriolis acceleration of the previous one, which changes slowly. The step is
therefore straight-line arithmetic in + - * / (docs/theory/strapdown.md; Savage, "Strapdown
Inertial Navigation Integration Algorithm Design", JGCD 21, 1998).

The state is a tuple of floats called PLACE, in rad, m, s. Its members, in this order:

* latitude, longitude, height; velocity east, north, up;
* at the middle of the last interval: sine and cosine of latitude, sine and cosine of inertial
  longitude; then the two angles from there to the end of the interval;
* acceleration east, north, up over the last interval;
* 1 / (R_N + h) and 1 / ((R_E + h) cos lat) at its middle;
* bias of the vertical acceleration, estimated by the damping;
* number of steps since the sines were last computed from the angles;
* Coriolis acceleration east, north, up over the last interval.
"""

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.elementary import sincos
from . import polar_step
from .vertical_channel import DAMPED, damped, FROM_TRUTH

PLACE = ('lat', 'lon', 'height', 'v_e', 'v_n', 'v_u', 'sin_lat', 'cos_lat', 'sin_lon', 'cos_lon',
         'rest_lat', 'rest_lon', 'a_e', 'a_n', 'a_u', 'per_north', 'per_east', 'vertical_bias',
         'age', 'c_e', 'c_n', 'c_u')
# Number of steps after which the sines are computed from the angles again. Between these
# computations the rounding error grows by 1e-16 per step.
RENEWED_EVERY = 256.0
# The step is done in Cartesian coordinates if cos(lat) is below POLAR (within 3 deg of a pole,
# where a flight may turn n by more than 1 mrad/s), or if n turns by more than TURN, rad, in half
# an interval.
POLAR, TURN = 0.05, 4e-3


def begin(lat, lon, height, v, earth_angle):
    """
    Return PLACE at the start.

    Parameters
    ----------
    lat, lon, height : latitude (rad), longitude (rad), height (m)
    v : (3,) velocity east, north, up, m/s
    earth_angle : angle of the rotation from i to e, zero at the start of the run, rad

    """
    return renewed((lat, lon, height, v[0], v[1], v[2], 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0,
                    0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), earth_angle)


def renewed(place, earth_angle):
    """Return PLACE with sines and radii recomputed from latitude, longitude and height."""
    lat, lon, h, v_e, v_n, v_u, _, _, _, _, _, _, a_e, a_n, a_u, _, _, bias, _, c_e, c_n, c_u = (
        place)
    sin_lat, cos_lat = sincos(lat)
    sin_lon, cos_lon = sincos(lon + earth_angle)
    per_north, per_east = ellipsoid.level_angles(1.0, 1.0, sin_lat, cos_lat, h)
    return (lat, lon, h, v_e, v_n, v_u, sin_lat, cos_lat, sin_lon, cos_lon, 0.0, 0.0, a_e, a_n,
            a_u, per_north, per_east, bias, 0.0, c_e, c_n, c_u)


def advance(place, q_ib, delta_v, dt, earth_rate, earth_angle, channel, reference,
            gravity=None):
    """
    Advance position and velocity over one sampling interval.

    Parameters
    ----------
    place : PLACE at the start of the interval
    q_ib : quaternion of the body relative to the inertial frame, at the start of the interval
    delta_v : integral of specific force, rotated to the body axes at the start, m/s
    dt : length of the interval, s
    earth_rate : rotation rate of the Earth, rad/s; 0 for an Earth that does not rotate
    earth_angle : angle of the rotation from i to e at the start of the interval, rad
    channel : how height and vertical velocity are found: FROM_TRUTH, FREE or DAMPED
    reference : a tuple of height, vertical velocity, c1, c2, c3. Height and vertical velocity at
        the end of the interval are used by FROM_TRUTH, the height also by DAMPED; c1, c2, c3 of
        ``vertical_channel.damping`` are used by DAMPED
    gravity : terms of the gravity formula, one of ``ellipsoid.GRAVITY_TERMS``

    Returns
    -------
    PLACE at the end of the interval

    """
    if place[18] >= RENEWED_EVERY:
        place = renewed(place, earth_angle)
    delta_v_i = quaternion.rotate(q_ib, delta_v)
    if is_small(place, dt, earth_rate):
        return small_step(place, delta_v_i, dt, earth_rate, channel, reference, gravity)
    return polar_step.advance(place, delta_v_i, dt, earth_rate, earth_angle, channel, reference,
                              gravity)


def is_small(place, dt, earth_rate):
    """Return whether n turns so little in an interval that ``small_step`` is accurate."""
    limit = TURN / (0.5 * dt)
    north, east = place[4] * place[15], place[3] * place[16] + earth_rate
    return place[7] > POLAR and -limit < north < limit and -limit < east < limit


def turned(s, c, d):
    """Return sine and cosine of an angle increased by d, |d| < 0.01, exact to rounding."""
    d2 = d * d
    sd = d * (1.0 - d2 * (1.0 / 6.0) * (1.0 - d2 * 0.05))
    cd = 1.0 - d2 * (0.5 - d2 * (1.0 / 24.0 - d2 * (1.0 / 720.0)))
    return s * cd + c * sd, c * cd - s * sd


def coriolis(m_e, m_n, m_u, cos_m, sin_m, per_north, per_east, earth_rate):
    """Return -(2 Omega + rho) x V, east, north, up, m/s^2, at the velocity V = (m_e, m_n, m_u)."""
    w_e = -m_n * per_north
    about_axis = m_e * per_east + 2.0 * earth_rate
    w_n, w_u = about_axis * cos_m, about_axis * sin_m
    return w_u * m_n - w_n * m_u, w_e * m_u - w_u * m_e, w_n * m_e - w_e * m_n


def small_step(place, delta_v_i, dt, earth_rate, channel, reference, gravity=None):
    """
    Advance PLACE as ``advance`` does; n must turn by less than 0.01 rad (``is_small``).

    delta_v_i: velocity increment in i, m/s; for the other arguments see ``advance``.
    """
    (lat, lon, height, v_e, v_n, v_u, sin_lat, cos_lat, sin_lon, cos_lon, rest_lat, rest_lon, a_e,
     a_n, a_u, per_north, per_east, bias, age, c_e, c_n, c_u) = place
    x, y, z = delta_v_i
    reference_height, reference_up, c1, c2, c3 = reference
    half, quarter = 0.5 * dt, 0.25 * dt
    # Position at mid-interval, extrapolated with the acceleration of the previous interval.
    m_h = height + half * (v_u + quarter * a_u)
    if channel == FROM_TRUTH:
        m_h = 0.5 * (height + reference_height)
    to_lat = half * (v_n + quarter * a_n) * per_north
    to_lon = half * (v_e + quarter * a_e) * per_east
    sin_m, cos_m = turned(sin_lat, cos_lat, rest_lat + to_lat)
    sin_l, cos_l = turned(sin_lon, cos_lon, rest_lon + (to_lon + half * earth_rate))
    # 1 / (R_N + h) and 1 / ((R_E + h) cos lat), with a single division for speed.
    r_n, r_e, g = ellipsoid.radii_and_gravity(sin_m, m_h, gravity)
    r_n, r_e = r_n + m_h, (r_e + m_h) * cos_m
    per_both = 1.0 / (r_n * r_e)
    per_north, per_east = per_both * r_e, per_both * r_n
    # Resolve the velocity increment in n at mid-interval.
    level = cos_l * x + sin_l * y
    e = v_e + (cos_l * y - sin_l * x)
    n = v_n + (cos_m * z - sin_m * level)
    u = v_u + (cos_m * level + sin_m * z - dt * g)
    # V' = f + g - (2 Omega + rho) x V at the mean velocity of both ends; that mean uses the
    # Coriolis acceleration of the previous interval.
    m_e, m_n = 0.5 * (v_e + e) + half * c_e, 0.5 * (v_n + n) + half * c_n
    m_u = 0.5 * (v_u + (reference_up if channel == FROM_TRUTH else u + dt * c_u))
    c_e, c_n, c_u = coriolis(m_e, m_n, m_u, cos_m, sin_m, per_north, per_east, earth_rate)
    e, n, u = e + dt * c_e, n + dt * c_n, u + dt * c_u
    h = height + half * (v_u + u)
    if channel == FROM_TRUTH:
        h, u = reference_height, reference_up
    elif channel == DAMPED:
        h, u, bias = damped(h, u, bias, m_h - reference_height, dt, c1, c2, c3)
    d_lat, d_lon = half * (v_n + n) * per_north, half * (v_e + e) * per_east
    per_dt = 1.0 / dt
    return (lat + d_lat, lon + d_lon, h, e, n, u, sin_m, cos_m, sin_l, cos_l, d_lat - to_lat,
            d_lon - to_lon + half * earth_rate, (e - v_e) * per_dt, (n - v_n) * per_dt,
            (u - v_u) * per_dt, per_north, per_east, bias, age + 1.0, c_e, c_n, c_u)
