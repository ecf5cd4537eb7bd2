"""
The strapdown kernel: one step of attitude, velocity and position in East, North, Up.

The inertial attitude q_ib is integrated from the gyros alone (core.orientation); the local level
frame is placed in i by latitude, longitude and Earth rotation at the middle of the interval
(spec/delays section 3; Savage, "Strapdown Inertial Navigation Integration Algorithm Design", JGCD
21, 1998).
"""

import math

from . import attitude, earth

FROM_TRUTH, FREE, DAMPED = 0, 1, 2


def two_sample_increments(alpha, nu, alpha_last, nu_last):
    """
    Return the rotation vector and the rotated velocity increment of plain integrals.

    alpha, nu: integrals of rate and specific force over this interval, ..._last over the one
    before.  Coning: Savage part 1, equation 44 for one sample a cycle (alpha_last x alpha / 12);
    velocity rotation in closed form and sculling: part 2, equations 44 and 59.
    """
    coning = attitude.cross(alpha_last, alpha)
    a, b = attitude.cross(alpha_last, nu), attitude.cross(nu_last, alpha)
    a2 = alpha[0] * alpha[0] + alpha[1] * alpha[1] + alpha[2] * alpha[2]
    if a2 < 1e-6:
        k1, k2 = 0.5 - a2 / 24.0, 1.0 / 6.0 - a2 / 120.0
    else:
        angle = math.sqrt(a2)
        k1 = (1.0 - math.cos(angle)) / a2
        k2 = (1.0 - math.sin(angle) / angle) / a2
    r1 = attitude.cross(alpha, nu)
    r2 = attitude.cross(alpha, r1)
    phi = (alpha[0] + coning[0] / 12.0, alpha[1] + coning[1] / 12.0, alpha[2] + coning[2] / 12.0)
    u = (nu[0] + k1 * r1[0] + k2 * r2[0] + (a[0] + b[0]) / 12.0,
         nu[1] + k1 * r1[1] + k2 * r2[1] + (a[1] + b[1]) / 12.0,
         nu[2] + k1 * r1[2] + k2 * r2[2] + (a[2] + b[2]) / 12.0)
    return phi, u


def step(q_ib, lat, lon, height, v, u, dt, spin, turned, channel, reference):
    """
    Return lat, lon, height, v, wander at the end of one interval.

    q_ib, lat, lon, height, v: state at its start, v = (V_E, V_N, V_U); the attitude is advanced
    apart (core.orientation).  u: velocity increment in b of its start, m/s.  spin: rate of the
    Earth; turned: angle of the Earth at mid-interval since i and e coincided, rad.  channel and
    reference: FROM_TRUTH with (height, V_U) at the end; FREE with (); DAMPED with (reference
    height, c1, c2, c3, wander) of the third-order damping.
    """
    v_e, v_n, v_u = v
    x, y, z = attitude.rotate(q_ib, u)
    half = 0.5 * dt
    # the middle of the interval, first guessed from the start, then from both ends
    m_e, m_n, m_u, m_h = v_e, v_n, v_u, height
    quarter_e, quarter_n = v_e, v_n
    lat_m, lon_m = lat, lon
    cos_m = math.cos(lat)
    wander = 0.0
    for _ in range(2):
        r_n, r_e = earth.radii(math.sin(lat_m))
        lat_m = lat + half * quarter_n / (r_n + m_h)
        lon_m = lon + half * quarter_e / ((r_e + m_h) * cos_m)
        sin_m, cos_m = math.sin(lat_m), math.cos(lat_m)
        sin_l, cos_l = math.sin(lon_m + turned), math.cos(lon_m + turned)
        # velocity increment in n: C_ni at mid-interval
        level = cos_l * x + sin_l * y
        d_e = cos_l * y - sin_l * x
        d_n = cos_m * z - sin_m * level
        d_u = cos_m * level + sin_m * z
        r_n, r_e = earth.radii(sin_m)
        r_n, r_e = r_n + m_h, r_e + m_h
        # V' = f + g - (2 Omega + rho) x V
        w_e = -m_n / r_n
        w_n = 2.0 * spin * cos_m + m_e / r_e
        w_u = 2.0 * spin * sin_m + m_e * sin_m / (cos_m * r_e)
        e = v_e + d_e - dt * (w_n * m_u - w_u * m_n)
        n = v_n + d_n - dt * (w_u * m_e - w_e * m_u)
        if channel == FROM_TRUTH:
            h, up = reference
        else:
            up = v_u + d_u - dt * (w_e * m_n - w_n * m_e + earth.gravity(sin_m, m_h))
            h = height + dt * 0.5 * (v_u + up)
            if channel == DAMPED:
                wanted, c1, c2, c3, held = reference
                off = m_h - wanted
                h -= dt * c1 * off
                up -= dt * (c2 * off + held)
                wander = held + dt * c3 * off
        m_e, m_n, m_u, m_h = 0.5 * (v_e + e), 0.5 * (v_n + n), 0.5 * (v_u + up), 0.5 * (height + h)
        quarter_e, quarter_n = 0.5 * (v_e + m_e), 0.5 * (v_n + m_n)
    return (lat + dt * m_n / r_n, lon + dt * m_e / (r_e * cos_m), h, (e, n, up), wander)


def damping(time_constant):
    """
    Return c1, c2, c3 of the vertical channel with a triple pole at -1 / time_constant.

    The gravity gradient 2 g / R is compensated (Kayton and Fried, "Avionics Navigation Systems",
    2nd ed., section 7.5.4).
    """
    r = 1.0 / time_constant
    return 3.0 * r, 3.0 * r * r + 2.0 * earth.GRAVITY_EQUATOR / earth.SEMI_MAJOR, r * r * r


def inertial_attitude(lat, inertial_lon, q_nb):
    """Return q_ib of an attitude in the local level frame at the inertial longitude, floats."""
    return attitude.multiply(level_frame(lat, inertial_lon), q_nb)


def level_frame(lat, inertial_lon):
    """Return q_in at a latitude and inertial longitude, floats."""
    return attitude.local_level(math.sin(0.5 * lat), math.cos(0.5 * lat),
                                math.sin(0.5 * inertial_lon), math.cos(0.5 * inertial_lon))
