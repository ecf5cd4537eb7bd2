"""
The WGS-84 Earth: radii, normal gravity, rotation, Cartesian coordinates.

Formulas that take floats, arrays and Taylor series alike are written with operators only.
Source: Groves, "Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems", 2nd
ed., section 2.4; constants: NIMA TR8350.2.
"""

import math

from ins_sim.core.numerics.elementary import atan2, shorter_turn, sincos, sqrt

SEMI_MAJOR = 6378137.0
ECCENTRICITY2 = 6.6943799901413e-3
# Ratio of the semi-minor to the semi-major axis, 1 - f.
AXIS_RATIO = math.sqrt(1.0 - ECCENTRICITY2)
ROTATION_RATE = 7.292115e-5
# Radius of the sphere used for great-circle legs, m.
MEAN_RADIUS = 6371000.0
GRAVITY_EQUATOR = 9.7803253359
GRAVITY_FORMULA = 0.00193185265241
# Centrifugal acceleration at the equator divided by gravity, omega^2 a^2 b / GM.
GRAVITY_RATIO = 0.00344978650684
# a0, a1, a2 of normal gravity to second order in height h, relative to that at the surface:
# 1 - h (a0 - a1 sin^2 lat) + a2 h^2 (Heiskanen and Moritz, "Physical Geodesy", 2-123; Groves
# 2.139).
SECOND_ORDER = (2.0 / SEMI_MAJOR * (2.0 - AXIS_RATIO + GRAVITY_RATIO),
                4.0 / SEMI_MAJOR * (1.0 - AXIS_RATIO), 3.0 / (SEMI_MAJOR * SEMI_MAJOR))
# Argument ``terms`` of the gravity functions for each value of settings.place.Earth.gravity. It is
# None, rather than a number, for free_air: the compiler then leaves out the second-order code.
GRAVITY_TERMS = {'free_air': None, 'second_order': SECOND_ORDER}


def rotation_rate(rotates):
    """Return the rotation rate of the Earth, rad/s, or zero if it does not rotate."""
    return ROTATION_RATE if rotates else 0.0


def radii_and_gravity(sin_lat, height, terms):
    """
    Return the meridian radius R_N, the transverse radius R_E, m, and normal gravity, m/s^2.

    Radii: Groves 2.105, 2.106. Gravity points down along the ellipsoid normal: Somigliana's
    formula (Groves 2.134) with the free-air term (1 - 2 h / a), or with the SECOND_ORDER terms.
    1 / sqrt(1 - e^2 sin^2) is computed as the binomial series in x = e^2 sin^2 <= 0.0067, whose
    remainder is below 1e-18.

    Parameters
    ----------
    sin_lat, height : sine of latitude, and height above the ellipsoid (m)
    terms : one of the values of GRAVITY_TERMS

    """
    sin2 = sin_lat * sin_lat
    x = sin2 * ECCENTRICITY2
    x2 = x * x
    per_w = (x * 0.5 + 1.0) + x2 * ((x * 0.3125 + 0.375) + x2 * (
        (x * 0.24609375 + 0.2734375) + x2 * (x * 0.20947265625 + 0.2255859375)))
    surface = (sin2 * (GRAVITY_EQUATOR * GRAVITY_FORMULA) + GRAVITY_EQUATOR) * per_w
    if terms is None:
        fall = 1.0 - height * (2.0 / SEMI_MAJOR)
    else:
        fall = 1.0 - height * (terms[0] - sin2 * terms[1] - height * terms[2])
    return (per_w * per_w * per_w * ((1.0 - ECCENTRICITY2) * SEMI_MAJOR), per_w * SEMI_MAJOR,
            surface * fall)


def radii(sin_lat):
    """Return the meridian radius R_N and the transverse radius R_E, m, at a latitude."""
    return radii_and_gravity(sin_lat, 0.0, None)[:2]


def gravity(sin_lat, height, terms=None):
    """Return normal gravity, m/s^2, down; terms: one of the values of GRAVITY_TERMS."""
    return radii_and_gravity(sin_lat, height, terms)[2]


def ecef(sin_lat, cos_lat, sin_lon, cos_lon, height):
    """Return x, y, z in the Earth-fixed frame e, m (Groves 2.112)."""
    transverse = radii(sin_lat)[1]
    p = (transverse + height) * cos_lat
    return p * cos_lon, p * sin_lon, (transverse * (1.0 - ECCENTRICITY2) + height) * sin_lat


def geodetic_directions(x, y, z):
    """
    Return sine and cosine of latitude, sine and cosine of longitude, and height of a point in e.

    Fixed-point iteration in the reduced latitude from Bowring's starting value; three iterations
    are exact to rounding (1e-9 m) at heights from -10 km to 1000 km. On the axis of the Earth the
    longitude is returned as zero. The arguments are floats, in m.
    """
    p = sqrt(x * x + y * y)
    sin_lon, cos_lon = (y / p, x / p) if p > 0.0 else (0.0, 1.0)
    sin, cos = _direction(z, p * AXIS_RATIO)
    for _ in range(3):
        sin_lat, cos_lat = _direction(
            z + ECCENTRICITY2 / (1.0 - ECCENTRICITY2) * AXIS_RATIO * SEMI_MAJOR * sin * sin * sin,
            p - ECCENTRICITY2 * SEMI_MAJOR * cos * cos * cos)
        sin, cos = _direction(AXIS_RATIO * sin_lat, cos_lat)
    height = p * cos_lat + z * sin_lat - SEMI_MAJOR * sqrt(
        1.0 - ECCENTRICITY2 * (sin_lat * sin_lat))
    return sin_lat, cos_lat, sin_lon, cos_lon, height


def _direction(y, x):
    """Return sine and cosine of the angle of the vector (x, y), floats, not both zero."""
    r = sqrt(x * x + y * y)
    return y / r, x / r


def geodetic(x, y, z):
    """Return latitude, longitude (rad) and height (m) of a point in e, floats."""
    sin_lat, cos_lat, _, _, height = geodetic_directions(x, y, z)
    return atan2(sin_lat, cos_lat), atan2(y, x), height


def level_angles(east, north, sin_lat, cos_lat, height):
    """
    Return the changes of latitude and longitude, rad, for distances east and north, m.

    The radii are evaluated at the given latitude. Velocities, m/s, give angular rates, rad/s.
    """
    r_n, r_e = radii(sin_lat)
    return north / (r_n + height), east / ((r_e + height) * cos_lat)


def level_metres(d_lat, d_lon, sin_lat, cos_lat, height):
    """Return the distances east and north, m, for changes of latitude and longitude, rad."""
    r_n, r_e = radii(sin_lat)
    return d_lon * (r_e + height) * cos_lat, d_lat * (r_n + height)


def moved(lat, lon, height, enu):
    """
    Return latitude, longitude (rad) and height (m) of a point moved by east, north, up (m).

    Metres are converted to angles with the radii at the starting point. For an offset d along a
    straight line the error is d^2 / 2R: 1e-5 m in 10 m and 0.1 m in 1 km. The starting point
    consists of floats; the offset may be floats, arrays or Series.
    """
    east, north, up = enu
    d_lat, d_lon = level_angles(east, north, *sincos(lat), height)
    return lat + d_lat, lon + d_lon, height + up


def offset(lat, lon, height, other):
    """
    Return the offset east, north, up, m, from a point to another; the inverse of ``moved``.

    other: (lat, lon, height). Longitudes may differ by whole turns.
    """
    return offset_at(lat, lon, height, other, *sincos(lat))


def offset_at(lat, lon, height, other, sin_lat, cos_lat):
    """Return ``offset`` if sine and cosine of the latitude are already known."""
    east, north = level_metres(other[0] - lat, shorter_turn(other[1] - lon), sin_lat, cos_lat,
                               height)
    return east, north, other[2] - height
