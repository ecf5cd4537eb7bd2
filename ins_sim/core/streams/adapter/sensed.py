"""Angular rate and specific force that a vehicle on the Earth senses for a motion in the map."""

from typing import NamedTuple

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid


class AdaptedTruth(NamedTuple):
    """
    The truth at an instant.

    Attributes
    ----------
    t_ns : motion time, ns
    r_m, q_mb : pose in the map frame; position in m
    v_b, omega_mb_b : velocity (m/s) and rate (rad/s) relative to the map frame, in body axes
    lat, lon, height, q_nb : the same pose on the ellipsoid; rad, rad, m
    omega_ib_b, f_ib_b : angular rate (rad/s) and specific force (m/s^2), as an ideal IMU senses
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

    The map frame is Cartesian and turns with the Earth, so f = a + 2 Omega x v - g. Gravity is
    that of the ellipsoid at the position; far from the datum it is not parallel to the Up axis.

    Parameters
    ----------
    frame : MapFrame
    terms : entry of ``ellipsoid.GRAVITY_TERMS``, or None
    t_ns : motion time, ns
    motion : position (m), velocity (m/s) and acceleration (m/s^2) in the map frame, q_mb, and
        angular rate relative to the map frame in body axes (rad/s)
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
