"""
Conversion of metres on the ellipsoid to angles on the sphere of ``great_circle``.

A velocity (V_E, V_N) at a height h moves the point on the sphere at the rates p = m_E V_E to the
east and q = m_N V_N to the north,

    m_E = 1/((R_E + h) D),  m_N = (1 - e^2)/((R_N + h) D^2),
    D^2 = cos^2 lat + (1 - e^2)^2 sin^2 lat                                        (rad/s)
"""

from ins_sim.core.numerics.elementary import sincos, sqrt
from . import ellipsoid

AXIS_RATIO2 = 1.0 - ellipsoid.ECCENTRICITY2
SQUASH = 1.0 - AXIS_RATIO2 * AXIS_RATIO2


def sphere_metric(sin_lat, cos_lat, height):
    """Return m_E, m_N (1/m), and the derivatives of their logarithms with latitude."""
    r_n, r_e = ellipsoid.radii(sin_lat)
    d2 = 1.0 - SQUASH * (sin_lat * sin_lat)
    w2 = 1.0 - ellipsoid.ECCENTRICITY2 * (sin_lat * sin_lat)
    sc = sin_lat * cos_lat
    bend, slope = sc * (ellipsoid.ECCENTRICITY2 / w2), sc * (SQUASH / d2)
    return (1.0 / ((r_e + height) * sqrt(d2)), AXIS_RATIO2 / ((r_n + height) * d2),
            slope - bend * r_e / (r_e + height), 2.0 * slope - 3.0 * bend * r_n / (r_n + height))


def direction_on_earth(m_e, m_n, chi):
    """
    Return east and north on the ellipsoid of the unit vector along a course on the sphere.

    m_e, m_n: see ``sphere_metric``; chi: course, rad clockwise from north.  The third value
    returned is the length, m, of the displacement that moves the point on the sphere by 1 rad.
    """
    sin_chi, cos_chi = sincos(chi)
    east, north = sin_chi / m_e, cos_chi / m_n
    size = sqrt(east * east + north * north)
    return east / size, north / size, size


def across_leg(leg, lat, lon, height, v_n):
    """
    Return the offset z to the right of a leg, m, and its rate v_z, m/s, of a vehicle.

    Both are in metres on the ellipsoid at the height of the vehicle. The coordinate Z of the leg
    is in metres on the sphere, which differ by up to 0.6 %. The velocity component is normal to
    the line of constant Z.

    Parameters
    ----------
    leg : great_circle.Leg
    lat, lon : position of the vehicle, rad, floats or arrays
    height : m, float or array
    v_n : velocity east, north, up, m/s, floats or arrays

    Returns
    -------
    z : offset to the right of the leg, m
    v_z : its rate, m/s
    """
    _, z = leg.to_xz(lat, lon)
    m_e, m_n, _, _ = sphere_metric(*sincos(lat), height)
    chi = leg.course(lat, lon)
    east, north, _ = direction_on_earth(m_e, m_n, chi)
    sin_chi, cos_chi = sincos(chi)
    # A metre of Z moves the point by cos(chi)/m_E to the east and by -sin(chi)/m_N to the north.
    metres = (cos_chi / m_e * north + sin_chi / m_n * east) / ellipsoid.MEAN_RADIUS
    return z * metres, v_n[0] * north - v_n[1] * east
