"""What a vehicle on the Earth senses of a motion in the map frame: rate and specific force."""

from typing import NamedTuple

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid


class AdaptedTruth(NamedTuple):
    """
    The truth at an instant.

    t_ns: motion time; r_m, q_mb: pose in the map frame; v_b, omega_mb_b: velocity, m/s, and rate
    relative to the map frame, rad/s, in b; lat, lon (rad), height (m), q_nb: the same pose on the
    ellipsoid; omega_ib_b, rad/s, and f_ib_b, m/s^2: what an IMU senses.
    """

    t_ns: int
    r_m: tuple
    q_mb: tuple
    v_b: tuple
    omega_mb_b: tuple
    lat: float
    lon: float
    height: float
    q_nb: tuple
    omega_ib_b: tuple
    f_ib_b: tuple


def sensed(frame, terms, t_ns, motion):
    """
    Return the AdaptedTruth of a motion relative to the map frame.

    The map frame turns with the Earth and is Cartesian, so that f = a + 2 Omega x v - g, gravity
    being that of the ellipsoid at the place: far from the datum it is not along the axis Up.

    Parameters
    ----------
    frame : MapFrame
    terms : tuple or None
        Entry of ``ellipsoid.GRAVITY_TERMS``.
    t_ns : int
        Motion time.
    motion : tuple
        Position (m), velocity, acceleration in m, q_mb, and rate relative to m in b.
    """
    r, v, a, q_mb, omega = motion
    lat, lon, height, v_n, q_nb = frame.geodetic_one(r, q_mb, quaternion.rotate_back(q_mb, v))
    sin_lat = ellipsoid.sincos(lat)[0]
    g = ellipsoid.gravity(sin_lat, height, terms)
    turn = frame.omega_ie_m
    coriolis = quaternion.cross(turn, v)
    f_b = quaternion.rotate_back(q_mb, (a[0] + 2.0 * coriolis[0], a[1] + 2.0 * coriolis[1],
                                        a[2] + 2.0 * coriolis[2]))
    up_b = quaternion.rotate_back(q_nb, (0.0, 0.0, g))
    turn_b = quaternion.rotate_back(q_mb, turn)
    return AdaptedTruth(
        t_ns, r, q_mb, quaternion.rotate_back(q_mb, v), omega, lat, lon, height, q_nb,
        (omega[0] + turn_b[0], omega[1] + turn_b[1], omega[2] + turn_b[2]),
        (f_b[0] + up_b[0], f_b[1] + up_b[1], f_b[2] + up_b[2]))
