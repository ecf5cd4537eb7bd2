"""
Orthodromic coordinates: distances along and across great circles between turning points.

The sphere has the Earth's mean radius R0; a point is represented on it by its geocentric latitude,
tan(phi_c) = (1 - e^2) tan(phi), and its longitude. On the leg between the unit vectors u1 and u2,

    n = u1 x u2 / |u1 x u2|,  e2 = n x u1,  X = R0 atan2(u.e2, u.u1),  Z = -R0 asin(u.n)

X increases along the leg from its first point, Z to its right (Ivanov 2015;
docs/theory/orthodromic.md). Lengths on the sphere differ from those on the ellipsoid by up to
0.6 %.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.elementary import atan2, sincos, sqrt
from . import ellipsoid
from .sphere_metric import AXIS_RATIO2

# Smallest angle between two points, and to the antipode, rad (6 m): for closer ones the great
# circle through them is ill-conditioned.
LEAST_ANGLE = 1e-6


def unit_vector(lat, lon):
    """Return the unit vectors in e, three components, of points at geodetic lat, lon (rad)."""
    (sl, cl), (sin_lon, cos_lon) = sincos(lat), sincos(lon)
    sl = AXIS_RATIO2 * sl
    norm = sqrt(sl * sl + cl * cl)
    return cl * cos_lon / norm, cl * sin_lon / norm, sl / norm


def coordinates(u):
    """Return geodetic lat, lon (rad) of vectors of any length in e, three components."""
    p = sqrt(u[0] * u[0] + u[1] * u[1])
    return atan2(u[2], AXIS_RATIO2 * p), atan2(u[1], u[0])


def dot(a, b):
    """Return the scalar product of two vectors of three components."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


class Leg:
    """
    The great circle from (lat1, lon1) to (lat2, lon2), rad, floats.

    length: distance between the points, m.  u1, u2, n, e2: unit vectors in e, three floats each.
    Methods take floats or arrays.  Raises ValueError if the points coincide or are antipodes.
    """

    def __init__(self, lat1, lon1, lat2, lon2):
        self.u1, self.u2 = unit_vector(lat1, lon1), unit_vector(lat2, lon2)
        normal = quaternion.cross(self.u1, self.u2)
        size = sqrt(dot(normal, normal))
        angle = atan2(size, dot(self.u1, self.u2))
        if not LEAST_ANGLE < angle < math.pi - LEAST_ANGLE:
            kind = 'the same point' if angle < 1.0 else 'antipodes'
            raise ValueError(
                f'the leg from {math.degrees(lat1):.9g}, {math.degrees(lon1):.9g} deg to '
                f'{math.degrees(lat2):.9g}, {math.degrees(lon2):.9g} deg joins {kind}; expected '
                'points with one great circle through them')
        # For a short leg the product is not exactly normal to u1, which would appear as Z.
        slip = dot(normal, self.u1)
        normal = tuple(x - slip * u for x, u in zip(normal, self.u1))
        size = sqrt(dot(normal, normal))
        self.n = tuple(x / size for x in normal)
        self.e2 = quaternion.cross(self.n, self.u1)
        self.length = ellipsoid.MEAN_RADIUS * angle

    def to_xz(self, lat, lon):
        """Return X, Z (m) of points at geodetic lat, lon (rad); X within half a turn."""
        u = unit_vector(lat, lon)
        along, across = dot(u, self.u1), dot(u, self.e2)
        # atan2 instead of asin: equally exact near the leg and far from it.
        return (ellipsoid.MEAN_RADIUS * atan2(across, along),
                -ellipsoid.MEAN_RADIUS * atan2(dot(u, self.n),
                                               sqrt(along * along + across * across)))

    def from_xz(self, x, z):
        """Return geodetic lat, lon (rad) of points at X, Z (m)."""
        return coordinates(self.direction(x, z))

    def direction(self, x, z):
        """Return the unit vectors in e, three components, of points at X, Z (m)."""
        (sin_x, cos_x), (sin_z, cos_z) = (sincos(d / ellipsoid.MEAN_RADIUS) for d in (x, z))
        along, across, side = cos_z * cos_x, cos_z * sin_x, -sin_z
        return tuple(along * p + across * q + side * r
                     for p, q, r in zip(self.u1, self.e2, self.n))

    def course(self, lat, lon):
        """
        Return chi, the direction of increasing X, rad clockwise from north, at points lat, lon.

        It rotates small displacements and velocities: E = X sin(chi) + Z cos(chi),
        N = X cos(chi) - Z sin(chi).
        """
        return course_of(unit_vector(lat, lon), self.n)


def course_of(u, n):
    """Return the course, rad, at u of the great circle with the pole n; three components each."""
    ahead = quaternion.cross(n, u)
    # East is (-u_y, u_x, 0)/p and north is (-u_x u_z, -u_y u_z, p^2)/p.
    east = u[0] * ahead[1] - u[1] * ahead[0]
    north = (u[0] * u[0] + u[1] * u[1]) * ahead[2] - u[2] * (u[0] * ahead[0] + u[1] * ahead[1])
    return atan2(east, north)


class GreatCircleRoute:
    """
    A route of great-circle legs between turning points.

    The change from one leg to the next is at the bisector: the great circle through the turning
    point that halves the angle between the legs, so that a turn flown inside the corner changes
    legs at its middle. Legs are followed in order only, so that a route may cross itself.

    Parameters
    ----------
    lat, lon : turning points, rad, sequences of two or more

    Attributes
    ----------
    legs : a Leg for each pair of turning points
    starts : distance along the route to the first point of each leg, m
    length : total length, m

    Raises
    ------
    ValueError : with one sentence, for an invalid route
    """

    def __init__(self, lat, lon):
        if len(lat) != len(lon):
            raise ValueError(f'the route has {len(lat)} latitudes and {len(lon)} longitudes; '
                             'expected as many of each')
        if len(lat) < 2:
            raise ValueError(f'the route has {len(lat)} turning points; expected two or more')
        self.legs = tuple(Leg(*a, *b) for a, b in zip(
            zip(lat[:-1], lon[:-1]), zip(lat[1:], lon[1:])))
        starts = [0.0]
        for leg in self.legs:
            starts.append(starts[-1] + leg.length)
        *self.starts, self.length = starts
        self._ahead = [_bisector(a, b) for a, b in zip(self.legs[:-1], self.legs[1:])]

    @classmethod
    def of_points(cls, points):
        """Return the GreatCircleRoute of settings.TurningPoints."""
        try:
            return cls([math.radians(x) for x in points.latitude_deg],
                       [math.radians(x) for x in points.longitude_deg])
        except ValueError as error:
            raise ValueError(f'motion.route.points: {error}') from None

    def leg_at(self, lat, lon, leg=0):
        """Return the index of the leg at lat, lon (rad, floats); leg: index of an earlier leg."""
        u = unit_vector(lat, lon)
        while leg < len(self._ahead) and dot(u, self._ahead[leg]) > 0.0:
            leg += 1
        return leg

    def legs_at(self, lat, lon):
        """Return the indices (n,) of the legs along a history lat, lon (n,), rad, in order."""
        u, index = unit_vector(lat, lon), np.zeros(len(lat), dtype=np.int64)
        first = 0
        for ahead in self._ahead:
            behind = dot(u, ahead)[first:] > 0.0
            if not behind.any():
                break
            first += int(np.argmax(behind))
            index[first:] += 1
        return index

    def to_xz(self, lat, lon, leg):
        """Return X, Z (m) on the legs with index leg; X from the first point of each leg."""
        if not isinstance(lat, np.ndarray):
            return self.legs[leg].to_xz(lat, lon)
        x, z = np.empty_like(lat), np.empty_like(lat)
        for k in np.unique(leg):
            on = leg == k
            x[on], z[on] = self.legs[k].to_xz(lat[on], lon[on])
        return x, z


def _bisector(before, after):
    """Return the direction at a turning point half-way between the directions of its legs."""
    corner = after.u1
    return tuple(a + b for a, b in zip(quaternion.cross(before.n, corner),
                                       quaternion.cross(after.n, corner)))
