"""
Frames on the Earth: the map frame m of the datum, and the local level frame n at a position.

The map frame is Cartesian with axes east, north, up; its plane is tangent to the ellipsoid at the
datum.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.elementary import sincos
from . import ellipsoid

ROOT_HALF = math.sqrt(0.5)


class MapFrame:
    """
    Conversion between m and geodetic coordinates with attitude and velocity in n.

    Parameters
    ----------
    datum : settings.Datum
    rotation : whether the Earth rotates

    Attributes
    ----------
    omega_ie_m : rate of the Earth, resolved in m, rad/s, a tuple of floats
    """

    def __init__(self, datum, rotation):
        lat, lon = math.radians(datum.latitude_deg), math.radians(datum.longitude_deg)
        sl, cl = sincos(lat)
        self._q_em = level_frame(lat, lon)
        self._origin = ellipsoid.ecef(sl, cl, *sincos(lon), datum.height_m)
        spin = ellipsoid.rotation_rate(rotation)
        self.omega_ie_m = (0.0, spin * cl, spin * sl)

    def pose(self, lat, lon, height, v_n, q_nb):
        """Return r_m (n, 3) m, q_mb (n, 4), v_b = C_bn v_n (n, 3) m/s; arguments are arrays."""
        components = self.pose_one(lat, lon, height, np.moveaxis(v_n, -1, 0),
                                   np.moveaxis(q_nb, -1, 0))
        return tuple(np.stack(c, axis=-1) for c in components)

    def pose_one(self, lat, lon, height, v_n, q_nb):
        """Return r_m, q_mb, v_b of one sample as tuples of floats."""
        x = ellipsoid.ecef(*sincos(lat), *sincos(lon), height)
        o = self._origin
        r_m = quaternion.rotate_back(self._q_em, (x[0] - o[0], x[1] - o[1], x[2] - o[2]))
        return r_m, quaternion.multiply(self.q_mn(lat, lon), q_nb), \
            quaternion.rotate_back(q_nb, v_n)

    def q_mn(self, lat, lon):
        """Return the quaternion of n relative to m at positions, floats or arrays."""
        return quaternion.multiply(quaternion.conjugate(self._q_em), level_frame(lat, lon))

    def attitude(self, truth):
        """Return q_mb (n, 4) of a Truth record."""
        q = quaternion.multiply(self.q_mn(truth.lat, truth.lon),
                                np.moveaxis(truth.q_nb, -1, 0))
        return np.stack(q, axis=-1)

    def geodetic_one(self, r_m, q_mb, v_b):
        """Return lat, lon, height, v_n, q_nb of one sample; the inverse of pose_one."""
        o = self._origin
        r = quaternion.rotate(self._q_em, r_m)
        lat, lon, height = ellipsoid.geodetic(r[0] + o[0], r[1] + o[1], r[2] + o[2])
        q_nb = quaternion.multiply(quaternion.conjugate(self.q_mn(lat, lon)), q_mb)
        return lat, lon, height, quaternion.rotate(q_nb, v_b), q_nb


def inertial_attitude(lat, inertial_lon, q_nb):
    """Return q_ib, given q_nb at a latitude and an inertial longitude, rad."""
    return quaternion.multiply(level_frame(lat, inertial_lon), q_nb)


def level_frame(lat, inertial_lon):
    """
    Return the quaternion of n relative to i, or relative to e if given the longitude in e.

    C_en = Rz(lon + 90 deg) Rx(90 deg - lat), ENU to ECEF; latitude and (inertial) longitude in
    rad, floats or arrays.
    """
    return frame_of_halves(*sincos(0.5 * lat), *sincos(0.5 * inertial_lon))


def frame_of_halves(sin_lat, cos_lat, sin_lon, cos_lon):
    """Return ``level_frame``, given the sines and cosines of half the angles."""
    sx, cx = (cos_lat - sin_lat) * ROOT_HALF, (cos_lat + sin_lat) * ROOT_HALF
    sz, cz = (sin_lon + cos_lon) * ROOT_HALF, (cos_lon - sin_lon) * ROOT_HALF
    return cz * sx, sz * sx, sz * cx, cz * cx
