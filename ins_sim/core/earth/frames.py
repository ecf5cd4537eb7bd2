"""
Frames on the Earth: the map frame m of the datum, and the local level frame n at a position.

The map frame is Cartesian, its axes are East, North, Up in the plane tangent to the ellipsoid at
the
datum.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from . import ellipsoid


class MapFrame:
    """
    Change between geodetic coordinates with n-frame attitude and velocity, and m.

    datum: settings.Datum; rotation: whether the Earth rotates.  omega_ie_m: rate of the Earth in
    m, rad/s, a tuple of floats.
    """

    def __init__(self, datum, rotation):
        lat, lon = math.radians(datum.latitude_deg), math.radians(datum.longitude_deg)
        sl, cl = math.sin(lat), math.cos(lat)
        self._q_em = local_level(math.sin(lat / 2), math.cos(lat / 2),
                                 math.sin(lon / 2), math.cos(lon / 2))
        self._origin = ellipsoid.ecef(sl, cl, math.sin(lon), math.cos(lon), datum.height_m)
        spin = ellipsoid.rotation_rate(rotation)
        self.omega_ie_m = (0.0, spin * cl, spin * sl)

    def pose(self, lat, lon, height, v_n, q_nb):
        """Return r_m (n, 3) m, q_mb (n, 4) and v_b (n, 3) m/s of arrays; v_b is C_bn v_n."""
        components = self._pose(np, lat, lon, height, np.moveaxis(v_n, -1, 0),
                                np.moveaxis(q_nb, -1, 0))
        return tuple(np.stack(c, axis=-1) for c in components)

    def pose_one(self, lat, lon, height, v_n, q_nb):
        """Return r_m, q_mb, v_b of one sample as tuples of floats."""
        return self._pose(math, lat, lon, height, v_n, q_nb)

    def _pose(self, lib, lat, lon, height, v_n, q_nb):
        x = ellipsoid.ecef(lib.sin(lat), lib.cos(lat), lib.sin(lon), lib.cos(lon), height)
        o = self._origin
        r_m = quaternion.rotate_back(self._q_em, (x[0] - o[0], x[1] - o[1], x[2] - o[2]))
        return r_m, quaternion.multiply(self._q_mn(lib, lat, lon), q_nb), \
            quaternion.rotate_back(q_nb, v_n)

    def _q_mn(self, lib, lat, lon):
        q_en = local_level(lib.sin(lat * 0.5), lib.cos(lat * 0.5),
                           lib.sin(lon * 0.5), lib.cos(lon * 0.5))
        return quaternion.multiply(quaternion.conjugate(self._q_em), q_en)

    def attitude(self, truth):
        """Return q_mb (n, 4) of a Truth record."""
        q = quaternion.multiply(self._q_mn(np, truth.lat, truth.lon),
                                np.moveaxis(truth.q_nb, -1, 0))
        return np.stack(q, axis=-1)

    def geodetic_one(self, r_m, q_mb, v_b):
        """Return lat, lon, height, v_n, q_nb of one sample; the inverse of pose_one."""
        o = self._origin
        r = quaternion.rotate(self._q_em, r_m)
        lat, lon, height = ellipsoid.geodetic(r[0] + o[0], r[1] + o[1], r[2] + o[2])
        q_nb = quaternion.multiply(quaternion.conjugate(self._q_mn(math, lat, lon)), q_mb)
        return lat, lon, height, quaternion.rotate(q_nb, v_b), q_nb


def inertial_attitude(lat, inertial_lon, q_nb):
    """Return q_ib of an attitude in the local level frame at the inertial longitude, floats."""
    return quaternion.multiply(level_frame(lat, inertial_lon), q_nb)


def level_frame(lat, inertial_lon):
    """Return q_in at a latitude and inertial longitude, floats."""
    return local_level(math.sin(0.5 * lat), math.cos(0.5 * lat),
                       math.sin(0.5 * inertial_lon), math.cos(0.5 * inertial_lon))


def local_level(sin_half_lat, cos_half_lat, sin_half_lon, cos_half_lon):
    """
    Return q_en (ENU to ECEF) from sines and cosines of lat / 2 and lon / 2.

    C_en = Rz(lon + 90 deg) Rx(90 deg - lat).
    """
    r = math.sqrt(0.5)
    sx, cx = (cos_half_lat - sin_half_lat) * r, (cos_half_lat + sin_half_lat) * r
    sz, cz = (sin_half_lon + cos_half_lon) * r, (cos_half_lon - sin_half_lon) * r
    return cz * sx, sz * sx, sz * cx, cz * cx
