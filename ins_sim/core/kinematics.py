"""Truth from a pose: velocity, rate and specific force by differentiating one pose."""

import math

import numpy as np

from . import attitude, earth, taylor
from .records import Truth


def truth_from_pose(t_ns, lat, lon, height, q_nb, earth_rotation):
    """
    Return the Truth of a pose given as Taylor series.

    t_ns (n,) int64; lat, lon, height: Series of order >= 2 (rad, rad, m); q_nb: tuple of four
    Series of order >= 1.  Velocity V_E = (R_E + h) cos(lat) lon', V_N = (R_N + h) lat', V_U = h';
    specific force f = V' + (2 Omega + rho) x V - g (spec/delays section 3, equation 25; Groves
    5.53); rate omega_ib_b = C_bn omega_in_n + 2 q* q'.
    """
    s, c = taylor.sincos(lat)
    meridian, transverse = earth.radii(s)
    lat_rate, lon_rate = lat.derivative(), lon.derivative()
    v = ((transverse + height) * c * lon_rate, (meridian + height) * lat_rate,
         height.derivative())
    v_value = tuple(x.value for x in v)
    v_rate = tuple(x.derivative().value for x in v)

    spin = earth.ROTATION_RATE if earth_rotation else 0.0
    sin_lat, cos_lat = s.value, c.value
    spin_rate = spin + lon_rate.value
    omega_in_n = (-lat_rate.value, spin_rate * cos_lat, spin_rate * sin_lat)
    coriolis = attitude.cross((omega_in_n[0], omega_in_n[1] + spin * cos_lat,
                               omega_in_n[2] + spin * sin_lat), v_value)
    f_n = (v_rate[0] + coriolis[0], v_rate[1] + coriolis[1],
           v_rate[2] + coriolis[2] + earth.gravity(sin_lat, height.value))

    q = tuple(x.value for x in q_nb)
    q_rate = tuple(x.derivative().value for x in q_nb)
    half_rate = attitude.multiply(attitude.conjugate(q), q_rate)
    omega_nb_b = tuple(2.0 * x for x in half_rate[:3])
    omega_in_b = attitude.rotate_back(q, omega_in_n)
    omega_ib_b = tuple(a + b for a, b in zip(omega_in_b, omega_nb_b))

    def stack(components):
        return np.stack(components, axis=-1)

    return Truth(t_ns=t_ns, lat=lat.value, lon=lon.value, height=height.value,
                 v_n=stack(v_value), q_nb=stack(q), omega_ib_b=stack(omega_ib_b),
                 f_ib_b=stack(attitude.rotate_back(q, f_n)))


def rate_of_n(lat, height, v_n, earth_rotation):
    """
    Return omega_in_n (n, 3), rad/s, of lat (n,) rad, height (n,) m, v_n (n, 3) m/s.

    Groves 5.44, in ENU; without rotation of the Earth it is omega_en_n.
    """
    s, c = np.sin(lat), np.cos(lat)
    r_n, r_e = earth.radii(s)
    spin = earth.ROTATION_RATE if earth_rotation else 0.0
    lon_rate = v_n[:, 0] / ((r_e + height) * c)
    return np.stack((-v_n[:, 1] / (r_n + height), (spin + lon_rate) * c, (spin + lon_rate) * s),
                    axis=-1)


def rate_on_earth(lat, q_nb, omega_ib_b, spin):
    """Return the rate of b relative to an Earth of that spin, resolved in b, floats, rad/s."""
    turn = attitude.rotate_back(q_nb, (0.0, spin * math.cos(lat), spin * math.sin(lat)))
    return omega_ib_b[0] - turn[0], omega_ib_b[1] - turn[1], omega_ib_b[2] - turn[2]
