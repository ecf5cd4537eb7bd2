"""Truth from a pose: velocity, rate and specific force, by differentiation."""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import taylor
from ins_sim.core.timeseries.histories import Truth


def truth_from_pose(t_ns, lat, lon, height, q_nb, earth_rotation, gravity='free_air'):
    """
    Return the Truth of a pose given as Taylor series.

    The rate is omega_ib_b = C_bn omega_in_n + 2 q* q'.

    Parameters
    ----------
    t_ns : (n,) int64
    lat, lon, height : Series of order >= 2 (rad, rad, m)
    q_nb : tuple of four Series of order >= 1
    earth_rotation : whether the Earth rotates
    gravity : see settings.place.Earth.gravity

    """
    moved = translation(lat, lon, height, earth_rotation, gravity)
    return truth_of(t_ns, (lat.value, lon.value, height.value), *moved, q_nb)


def truth_of(t_ns, place, v_n, omega_in_n, f_n, q_nb):
    """
    Return the Truth from the results of ``translation`` and an attitude given as Taylor series.

    place: lat, lon, height.  Components are arrays (n,), or floats if the position is fixed; q_nb:
    tuple of four Series of order >= 1.
    """
    q, omega_ib_b, f_ib_b = in_body(omega_in_n, f_n, q_nb)

    def table(components):
        found = np.empty((len(q[0]), len(components)))
        for k, column in enumerate(components):
            found[:, k] = column
        return found

    lat, lon, height = (np.full(len(q[0]), x) for x in place)
    return Truth(t_ns=t_ns, lat=lat, lon=lon, height=height, v_n=table(v_n), q_nb=table(q),
                 omega_ib_b=table(omega_ib_b), f_ib_b=table(f_ib_b))


def in_body(omega_in_n, f_n, q_nb):
    """
    Return q_nb, omega_ib_b and f_ib_b, from the results of ``translation`` and an attitude.

    q_nb: tuple of four Series of order >= 1; the results are arrays like their values, or floats
    for an InstantSeries.
    """
    q = tuple(x.value for x in q_nb)
    q_rate = tuple(x.derivative().value for x in q_nb)
    half_rate = quaternion.multiply(quaternion.conjugate(q), q_rate)
    omega_nb_b = tuple(2.0 * x for x in half_rate[:3])
    omega_in_b = quaternion.rotate_back(q, omega_in_n)
    return (q, tuple(a + b for a, b in zip(omega_in_b, omega_nb_b)),
            quaternion.rotate_back(q, f_n))


def translation(lat, lon, height, earth_rotation, gravity='free_air'):
    """
    Return velocity, rate omega_in_n and specific force in n along a path, three arrays each.

    Velocity V_E = (R_E + h) cos(lat) lon', V_N = (R_N + h) lat', V_U = h'; specific force
    f = V' + (2 Omega + rho) x V - g (Bogdanov and Fomichev 2018, equation 25; Groves 5.53;
    docs/theory/truth.md).

    lat, lon, height: Series of order >= 2 (rad, rad, m); gravity: see settings.place.Earth.
    """
    lat_rate, lon_rate = lat.derivative(), lon.derivative()
    # The rates already contain the second derivatives, so order 1 suffices for the rest.
    lat, near_height = lat.to_order(1), height.to_order(1)
    s, c = taylor.sincos(lat)
    meridian, transverse = ellipsoid.radii(s)
    v = ((transverse + near_height) * c * lon_rate, (meridian + near_height) * lat_rate,
         height.derivative())
    v_value = tuple(x.value for x in v)
    v_rate = tuple(x.derivative().value for x in v)

    spin = ellipsoid.rotation_rate(earth_rotation)
    sin_lat, cos_lat = s.value, c.value
    spin_rate = spin + lon_rate.value
    omega_in_n = (-lat_rate.value, spin_rate * cos_lat, spin_rate * sin_lat)
    coriolis = quaternion.cross((omega_in_n[0], omega_in_n[1] + spin * cos_lat,
                                 omega_in_n[2] + spin * sin_lat), v_value)
    return v_value, omega_in_n, (
        v_rate[0] + coriolis[0], v_rate[1] + coriolis[1],
        v_rate[2] + coriolis[2] + ellipsoid.gravity(sin_lat, height.value,
                                                    ellipsoid.GRAVITY_TERMS[gravity]))
