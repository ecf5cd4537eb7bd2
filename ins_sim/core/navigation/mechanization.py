"""
The strapdown mechanization: increments of one interval, and the step of velocity and position.

The inertial attitude q_ib is integrated from the gyros alone (``attitude.integration``); latitude,
longitude and the rotation of the Earth place the local level frame in the inertial frame at the
middle of the interval (docs/theory.md, "Strapdown"; Savage, "Strapdown Inertial Navigation
Integration Algorithm Design", JGCD 21, 1998).
"""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid

FROM_TRUTH, FREE, DAMPED = 0, 1, 2


def two_sample_increments(alpha, nu, alpha_last, nu_last):
    """
    Return the rotation vector and the rotated velocity increment of plain integrals.

    alpha, nu: integrals of rate and specific force over this interval, ..._last over the one
    before.  Coning: Savage part 1, equation 44 for one sample a cycle (alpha_last x alpha / 12);
    velocity rotation in closed form and sculling: part 2, equations 44 and 59.
    """
    coning = quaternion.cross(alpha_last, alpha)
    a, b = quaternion.cross(alpha_last, nu), quaternion.cross(nu_last, alpha)
    a2 = alpha[0] * alpha[0] + alpha[1] * alpha[1] + alpha[2] * alpha[2]
    if a2 < 1e-6:
        k1, k2 = 0.5 - a2 / 24.0, 1.0 / 6.0 - a2 / 120.0
    else:
        angle = math.sqrt(a2)
        k1 = (1.0 - math.cos(angle)) / a2
        k2 = (1.0 - math.sin(angle) / angle) / a2
    r1 = quaternion.cross(alpha, nu)
    r2 = quaternion.cross(alpha, r1)
    phi = (alpha[0] + coning[0] / 12.0, alpha[1] + coning[1] / 12.0, alpha[2] + coning[2] / 12.0)
    u = (nu[0] + k1 * r1[0] + k2 * r2[0] + (a[0] + b[0]) / 12.0,
         nu[1] + k1 * r1[1] + k2 * r2[1] + (a[1] + b[1]) / 12.0,
         nu[2] + k1 * r1[2] + k2 * r2[2] + (a[2] + b[2]) / 12.0)
    return phi, u


def advance(q_ib, position, velocity, delta_v, dt, earth_rate, earth_angle, channel, reference):
    """
    Advance velocity and position over one sampling interval.

    The attitude is integrated separately (``attitude.integration``). Latitude, longitude and
    velocity at mid-interval are found in two passes, which makes the error second order in dt
    (docs/theory.md, "Strapdown"; Savage, JGCD 21, 1998).

    Parameters
    ----------
    q_ib : quaternion of the body relative to the inertial frame, at the start of the interval
    position : latitude (rad), longitude (rad), height (m) at the start
    velocity : east, north, up velocity relative to the Earth at the start, m/s
    delta_v : integral of specific force, rotated to the body axes at the start, m/s
    dt : length of the interval, s
    earth_rate : rotation rate of the Earth, rad/s; 0 for an Earth that does not rotate
    earth_angle : rotation of the Earth since i and e coincided, at mid-interval, rad
    channel : how height and vertical velocity are found: FROM_TRUTH, FREE or DAMPED
    reference : for FROM_TRUTH height and vertical velocity at the end of the interval; for FREE
        empty; for DAMPED the reference height, c1, c2, c3 of ``damping`` and the vertical bias

    Returns
    -------
    position, velocity : as above, at the end of the interval
    vertical_bias : bias of the vertical acceleration that the damping has estimated, m/s^2; 0 in
        the other channels

    """
    lat, lon, height = position
    v_e, v_n, v_u = velocity
    x, y, z = quaternion.rotate(q_ib, delta_v)
    half = 0.5 * dt
    # The middle of the interval is guessed from the start first, then from both ends.
    m_e, m_n, m_u, m_h = v_e, v_n, v_u, height
    mean_v_e, mean_v_n = v_e, v_n
    lat_m, lon_m = lat, lon
    cos_m = math.cos(lat)
    vertical_bias = 0.0
    for _ in range(2):
        r_n, r_e = ellipsoid.radii(math.sin(lat_m))
        lat_m = lat + half * mean_v_n / (r_n + m_h)
        lon_m = lon + half * mean_v_e / ((r_e + m_h) * cos_m)
        sin_m, cos_m = math.sin(lat_m), math.cos(lat_m)
        sin_l, cos_l = math.sin(lon_m + earth_angle), math.cos(lon_m + earth_angle)
        # Resolve the velocity increment in n at mid-interval.
        level = cos_l * x + sin_l * y
        d_e = cos_l * y - sin_l * x
        d_n = cos_m * z - sin_m * level
        d_u = cos_m * level + sin_m * z
        r_n, r_e = ellipsoid.radii(sin_m)
        r_n, r_e = r_n + m_h, r_e + m_h
        # V' = f + g - (2 Omega + rho) x V
        w_e = -m_n / r_n
        w_n = 2.0 * earth_rate * cos_m + m_e / r_e
        w_u = 2.0 * earth_rate * sin_m + m_e * sin_m / (cos_m * r_e)
        e = v_e + d_e - dt * (w_n * m_u - w_u * m_n)
        n = v_n + d_n - dt * (w_u * m_e - w_e * m_u)
        if channel == FROM_TRUTH:
            h, up = reference
        else:
            up = v_u + d_u - dt * (w_e * m_n - w_n * m_e + ellipsoid.gravity(sin_m, m_h))
            h = height + dt * 0.5 * (v_u + up)
            if channel == DAMPED:
                wanted, c1, c2, c3, held = reference
                off = m_h - wanted
                h -= dt * c1 * off
                up -= dt * (c2 * off + held)
                vertical_bias = held + dt * c3 * off
        m_e, m_n, m_u, m_h = 0.5 * (v_e + e), 0.5 * (v_n + n), 0.5 * (v_u + up), 0.5 * (height + h)
        mean_v_e, mean_v_n = 0.5 * (v_e + m_e), 0.5 * (v_n + m_n)
    position = (lat + dt * m_n / r_n, lon + dt * m_e / (r_e * cos_m), h)
    return position, (e, n, up), vertical_bias


def damping(time_constant):
    """
    Return c1, c2, c3 of the vertical channel with a triple pole at -1 / time_constant.

    The gravity gradient 2 g / R is compensated (Kayton and Fried, "Avionics Navigation Systems",
    2nd ed., section 7.5.4).
    """
    r = 1.0 / time_constant
    return 3.0 * r, 3.0 * r * r + 2.0 * ellipsoid.GRAVITY_EQUATOR / ellipsoid.SEMI_MAJOR, r * r * r


def integrals(omega, f, dt):
    """Return the integrals of a rate and a specific force that are constant over dt, s."""
    return (omega[0] * dt, omega[1] * dt, omega[2] * dt), (f[0] * dt, f[1] * dt, f[2] * dt)


def fixed_rate_increments(integrated, now, last):
    """
    Return the rotation vector and the velocity increment of an interval as long as the last.

    integrated: whether the readings are plain integrals, else they are these increments; now,
    last: ``integrals`` over this interval and the one before.
    """
    return two_sample_increments(now[0], now[1], last[0], last[1]) if integrated else now


def uneven_increments(kind, last, now, dt, dt_last):
    """
    Return the rotation vector and the velocity increment of the interval that ends now.

    kind: one of settings.navigate.INPUTS; last, now: (omega, f) at the stamps; dt, dt_last: this
    interval and the one before, s.  Rate and force are taken to be straight lines in time.  Two
    values at the ends of one interval have the cross products of twice their product with the
    trapezoid; two means over unequal intervals those of the earlier one, scaled.
    """
    (w0, f0), (w1, f1) = last, now
    if kind == 'rotation_vector':
        return _scaled(w1, dt), _scaled(f1, dt)
    if kind == 'integrated':
        scale = dt * 2.0 * dt / (dt + dt_last)
        return two_sample_increments(_scaled(w1, dt), _scaled(f1, dt),
                                     _scaled(w0, scale), _scaled(f0, scale))
    half = 0.5 * dt
    alpha = (half * (w0[0] + w1[0]), half * (w0[1] + w1[1]), half * (w0[2] + w1[2]))
    nu = (half * (f0[0] + f1[0]), half * (f0[1] + f1[1]), half * (f0[2] + f1[2]))
    return two_sample_increments(alpha, nu, _scaled(w0, 2.0 * dt),
                                 _scaled(f0, 2.0 * dt))


def _scaled(v, s):
    return s * v[0], s * v[1], s * v[2]
