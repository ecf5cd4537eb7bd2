"""Angular rates of the local level frame and of the body on the Earth; velocity in the body."""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.elementary import sincos
from . import ellipsoid


def rate_of_n(lat, height, v_n, earth_rotation):
    """
    Return omega_in_n (n, 3), rad/s, given lat (n,) rad, height (n,) m, v_n (n, 3) m/s.

    Groves 5.44, in ENU; if the Earth does not rotate the result is omega_en_n.
    """
    s, c = sincos(lat)
    lat_rate, lon_rate = ellipsoid.level_angles(v_n[:, 0], v_n[:, 1], s, c, height)
    spin = ellipsoid.rotation_rate(earth_rotation)
    return np.stack((-lat_rate, (spin + lon_rate) * c, (spin + lon_rate) * s), axis=-1)


def rate_on_earth(lat, q_nb, omega_ib_b, spin):
    """Return the rate of b relative to the Earth (its rate: spin), in b, floats, rad/s."""
    sin, cos = sincos(lat)
    turn = quaternion.rotate_back(q_nb, (0.0, spin * cos, spin * sin))
    return omega_ib_b[0] - turn[0], omega_ib_b[1] - turn[1], omega_ib_b[2] - turn[2]


def body_velocity(record):
    """Return the velocity C_bn v_n (n, 3), m/s, of a record with q_nb and v_n."""
    return np.stack(quaternion.rotate_back(np.moveaxis(record.q_nb, -1, 0),
                                           np.moveaxis(record.v_n, -1, 0)), axis=-1)
