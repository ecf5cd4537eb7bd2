"""
Metres on the ellipsoid and angles on the sphere of the great circles (``great_circle``).

A velocity (V_E, V_N) at a height h moves the point on the sphere by p = m_E V_E to the East and
q = m_N V_N to the North,

    m_E = 1/((R_E + h) D),  m_N = (1 - e^2)/((R_N + h) D^2),
    D^2 = cos^2 lat + (1 - e^2)^2 sin^2 lat                                        (rad/s)
"""

from ins_sim.core.numerics.elementary import sincos, sqrt
from . import ellipsoid

FLATTENING2 = 1.0 - ellipsoid.ECCENTRICITY2
SQUASH = 1.0 - FLATTENING2 * FLATTENING2


def sphere_metric(sin_lat, cos_lat, height):
    """Return m_E, m_N (1/m), and how their logarithms change with latitude."""
    r_n, r_e = ellipsoid.radii(sin_lat)
    d2 = 1.0 - SQUASH * (sin_lat * sin_lat)
    w2 = 1.0 - ellipsoid.ECCENTRICITY2 * (sin_lat * sin_lat)
    sc = sin_lat * cos_lat
    bend, slope = sc * (ellipsoid.ECCENTRICITY2 / w2), sc * (SQUASH / d2)
    return (1.0 / ((r_e + height) * sqrt(d2)), FLATTENING2 / ((r_n + height) * d2),
            slope - bend * r_e / (r_e + height), 2.0 * slope - 3.0 * bend * r_n / (r_n + height))


def direction_on_earth(m_e, m_n, chi):
    """
    Return East, North of the unit vector on the ellipsoid of a course on the sphere.

    m_e, m_n: of ``sphere_metric``; chi: rad, clockwise from north.  The third is the length, m,
    of the displacement that moves the point on the sphere by one radian.
    """
    sin_chi, cos_chi = sincos(chi)
    east, north = sin_chi / m_e, cos_chi / m_n
    size = sqrt(east * east + north * north)
    return east / size, north / size, size


def across_leg(leg, lat, lon, height, v_n):
    """
    Return the offset z to the right of a leg, m, and its rate v_z, m/s, of a vehicle.

    leg: great_circle.Leg; lat, lon: rad; height: m; v_n: East, North, Up, m/s; floats or arrays.
    Metres are those of the ellipsoid at that height: the coordinate Z of the leg is metres on the
    sphere, up to 0.6 % different.  The velocity is taken across the line of constant Z.
    """
    _, z = leg.to_xz(lat, lon)
    m_e, m_n, _, _ = sphere_metric(*sincos(lat), height)
    chi = leg.course(lat, lon)
    east, north, _ = direction_on_earth(m_e, m_n, chi)
    sin_chi, cos_chi = sincos(chi)
    # A metre of Z moves the point by cos(chi)/m_E to the East and by -sin(chi)/m_N to the North.
    metres = (cos_chi / m_e * north + sin_chi / m_n * east) / ellipsoid.MEAN_RADIUS
    return z * metres, v_n[0] * north - v_n[1] * east
