"""
Advance position and velocity in Cartesian inertial coordinates.

Near a pole longitude is undefined and 1 / cos(lat) is large, and a long step may turn the local
level frame by a large angle. In the inertial frame i neither is a problem. With position r and
velocity v in i, the rate of the Earth Omega and normal gravity g,

    v' = f + g + Omega x (Omega x r),   r' = v.

Position and velocity at mid-interval are found in two passes, which makes the step second order
in dt.
"""

from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.elementary import atan2, sincos
from .vertical_channel import DAMPED, damped, FROM_TRUTH


def advance(place, delta_v_i, dt, earth_rate, earth_angle, channel, reference, gravity=None):
    """Advance PLACE as ``mechanization.small_step`` does, at any place and over any interval."""
    lat, lon, height, v_e, v_n, v_u, _, _, _, _, _, _, _, _, _, _, _, bias, age, _, _, _ = place
    sin_lat, cos_lat = sincos(lat)
    sin_lon, cos_lon = sincos(lon + earth_angle)
    reference_height, reference_up, c1, c2, c3 = reference
    r = ellipsoid.ecef(sin_lat, cos_lat, sin_lon, cos_lon, height)
    v = in_inertial((v_e, v_n, v_u), r, sin_lat, cos_lat, sin_lon, cos_lon, earth_rate)
    half, end = 0.5 * dt, v
    for _ in range(2):
        # Add the mean velocity over the first half, for constant acceleration.
        m = (r[0] + half * (0.75 * v[0] + 0.25 * end[0]),
             r[1] + half * (0.75 * v[1] + 0.25 * end[1]),
             r[2] + half * (0.75 * v[2] + 0.25 * end[2]))
        a, m_h = gravitation(m, earth_rate, gravity)
        end = (v[0] + delta_v_i[0] + dt * a[0], v[1] + delta_v_i[1] + dt * a[1],
               v[2] + delta_v_i[2] + dt * a[2])
    r = (r[0] + half * (v[0] + end[0]), r[1] + half * (v[1] + end[1]),
         r[2] + half * (v[2] + end[2]))
    s_lat, c_lat, s_lon, c_lon, h = ellipsoid.geodetic_directions(r[0], r[1], r[2])
    e, n, u = in_level(end, r, s_lat, c_lat, s_lon, c_lon, earth_rate)
    if channel == FROM_TRUTH:
        h, u = reference_height, reference_up
    elif channel == DAMPED:
        h, u, bias = damped(h, u, bias, m_h - reference_height, dt, c1, c2, c3)
    # Add the change to the last longitude, so that full turns are kept.
    d_lon = atan2(s_lon * cos_lon - c_lon * sin_lon, c_lon * cos_lon + s_lon * sin_lon)
    per_north, per_east = ellipsoid.level_angles(1.0, 1.0, s_lat, max(c_lat, 1e-9), h)
    per_dt = 1.0 / dt
    return (atan2(s_lat, c_lat), lon + (d_lon - dt * earth_rate), h, e, n, u, s_lat, c_lat, s_lon,
            c_lon, 0.0, 0.0, (e - v_e) * per_dt, (n - v_n) * per_dt, (u - v_u) * per_dt, per_north,
            per_east, bias, age + 1.0, 0.0, 0.0, 0.0)


def in_inertial(v_n, r, sin_lat, cos_lat, sin_lon, cos_lon, earth_rate):
    """Return the inertial velocity, in i, of a point r that has the velocity v_n relative to e."""
    e, n, u = v_n
    level = u * cos_lat - n * sin_lat
    return (level * cos_lon - e * sin_lon - earth_rate * r[1],
            level * sin_lon + e * cos_lon + earth_rate * r[0], n * cos_lat + u * sin_lat)


def in_level(v_i, r, sin_lat, cos_lat, sin_lon, cos_lon, earth_rate):
    """Return the velocity relative to e, east, north, up; the inverse of ``in_inertial``."""
    x, y, z = v_i[0] + earth_rate * r[1], v_i[1] - earth_rate * r[0], v_i[2]
    level = cos_lon * x + sin_lon * y
    return (cos_lon * y - sin_lon * x, cos_lat * z - sin_lat * level,
            cos_lat * level + sin_lat * z)


def gravitation(r, earth_rate, gravity=None):
    """Return gravitation, normal gravity minus centrifugal, in i (m/s^2), and the height (m)."""
    sin_lat, cos_lat, sin_lon, cos_lon, height = ellipsoid.geodetic_directions(r[0], r[1], r[2])
    g = ellipsoid.gravity(sin_lat, height, gravity)
    square = earth_rate * earth_rate
    return (-g * cos_lat * cos_lon - square * r[0], -g * cos_lat * sin_lon - square * r[1],
            -g * sin_lat), height
