"""
The WGS-84 Earth: radii, normal gravity, rotation, Cartesian coordinates.

Every formula is written with operators only, so that it takes floats (kernels), arrays (records)
and Taylor series (motions) alike.  Source: Groves, "Principles of GNSS, Inertial, and Multisensor
Integrated Navigation Systems", 2nd ed., section 2.4; constants: NIMA TR8350.2.
"""

import math

from ins_sim.core.numerics.elementary import sqrt

SEMI_MAJOR = 6378137.0
ECCENTRICITY2 = 6.6943799901413e-3
ROTATION_RATE = 7.292115e-5
# of the sphere that legs of great circles lie on
MEAN_RADIUS = 6371000.0
GRAVITY_EQUATOR = 9.7803253359
GRAVITY_FORMULA = 0.00193185265241


def rotation_rate(rotates):
    """Return the rotation rate of an Earth that rotates or does not, rad/s."""
    return ROTATION_RATE if rotates else 0.0


def radii(sin_lat):
    """Return the meridian radius R_N and the transverse radius R_E, m (Groves 2.105, 2.106)."""
    w2 = 1.0 - ECCENTRICITY2 * (sin_lat * sin_lat)
    w = sqrt(w2)
    transverse = SEMI_MAJOR / w
    return (1.0 - ECCENTRICITY2) * transverse / w2, transverse


def gravity(sin_lat, height):
    """
    Return normal gravity, m/s^2, downward along the ellipsoid normal.

    Somigliana's formula with the free-air term (1 - 2 h / a) (Groves 2.134, first order in h).
    """
    s2 = sin_lat * sin_lat
    surface = GRAVITY_EQUATOR * (1.0 + GRAVITY_FORMULA * s2) / sqrt(1.0 - ECCENTRICITY2 * s2)
    return surface * (1.0 - height * (2.0 / SEMI_MAJOR))


def ecef(sin_lat, cos_lat, sin_lon, cos_lon, height):
    """Return x, y, z in e, m (Groves 2.112)."""
    transverse = radii(sin_lat)[1]
    p = (transverse + height) * cos_lat
    return p * cos_lon, p * sin_lon, (transverse * (1.0 - ECCENTRICITY2) + height) * sin_lat


def geodetic(x, y, z):
    """
    Return latitude, longitude (rad) and height (m) of a point in e, floats, not at the pole.

    Bowring's start and Newton-like fixed point in the reduced latitude; three rounds reach the
    rounding floor (1e-9 m) from -10 km to 1000 km.
    """
    p = math.hypot(x, y)
    flat = math.sqrt(1.0 - ECCENTRICITY2)
    ep2 = ECCENTRICITY2 / (1.0 - ECCENTRICITY2)
    beta = math.atan2(z, p * flat)
    for _ in range(3):
        sb, cb = math.sin(beta), math.cos(beta)
        lat = math.atan2(z + ep2 * flat * SEMI_MAJOR * sb ** 3,
                         p - ECCENTRICITY2 * SEMI_MAJOR * cb ** 3)
        beta = math.atan2(flat * math.sin(lat), math.cos(lat))
    sl, cl = math.sin(lat), math.cos(lat)
    height = p * cl + z * sl - SEMI_MAJOR * math.sqrt(1.0 - ECCENTRICITY2 * sl * sl)
    return lat, math.atan2(y, x), height


def level_angles(east, north, sin_lat, cos_lat, height):
    """
    Return the changes of latitude and longitude, rad, over distances East and North, m.

    The radii are those at the latitude given; rates, m/s, give angular rates.
    """
    r_n, r_e = radii(sin_lat)
    return north / (r_n + height), east / ((r_e + height) * cos_lat)


def level_metres(d_lat, d_lon, sin_lat, cos_lat, height):
    """Return the distances East and North, m, of changes of latitude and longitude, rad."""
    r_n, r_e = radii(sin_lat)
    return d_lon * (r_e + height) * cos_lat, d_lat * (r_n + height)


def moved(lat, lon, height, enu):
    """
    Return latitude, longitude and height of a point East, North, Up (m) of another.

    Metres become angles by the radii at the first point, a float, which leaves the straight
    offset d by d^2 / 2R: 1e-5 m in 10 m and 0.1 m in 1 km. The offset may be arrays or Series.
    """
    east, north, up = enu
    d_lat, d_lon = level_angles(east, north, math.sin(lat), math.cos(lat), height)
    return lat + d_lat, lon + d_lon, height + up


def offset(lat, lon, height, other):
    """
    Return East, North, Up, m, from a point to another, floats; the inverse of ``moved``.

    other: (lat, lon, height). Longitudes may differ by whole turns.
    """
    east, north = level_metres(other[0] - lat, math.remainder(other[1] - lon, 2.0 * math.pi),
                               math.sin(lat), math.cos(lat), height)
    return east, north, other[2] - height
