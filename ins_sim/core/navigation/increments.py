"""
The increments of one sampling interval: rotation vector and rotated velocity increment.

Coning and sculling of plain integrals: Savage, "Strapdown Inertial Navigation Integration
Algorithm Design", JGCD 21, 1998.
"""

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.elementary import sincos, sqrt


def two_sample_increments(alpha, nu, alpha_last, nu_last):
    """
    Return the rotation vector and the rotated velocity increment from plain integrals.

    Coning: Savage part 1, equation 44 for one sample per cycle (alpha_last x alpha / 12). The
    velocity rotation is in closed form; sculling: part 2, equations 44 and 59.

    Parameters
    ----------
    alpha, nu : (3,) integrals of rate (rad) and specific force (m/s) over this interval
    alpha_last, nu_last : the same over the interval before

    """
    coning = quaternion.cross(alpha_last, alpha)
    a, b = quaternion.cross(alpha_last, nu), quaternion.cross(nu_last, alpha)
    k1, k2 = rotation_factors(alpha[0] * alpha[0] + alpha[1] * alpha[1] + alpha[2] * alpha[2])
    r1 = quaternion.cross(alpha, nu)
    r2 = quaternion.cross(alpha, r1)
    phi = (alpha[0] + coning[0] / 12.0, alpha[1] + coning[1] / 12.0, alpha[2] + coning[2] / 12.0)
    u = (nu[0] + k1 * r1[0] + k2 * r2[0] + (a[0] + b[0]) / 12.0,
         nu[1] + k1 * r1[1] + k2 * r2[1] + (a[1] + b[1]) / 12.0,
         nu[2] + k1 * r1[2] + k2 * r2[2] + (a[2] + b[2]) / 12.0)
    return phi, u


def rotation_factors(a2):
    """Return (1 - cos a) / a^2 and (1 - sin(a) / a) / a^2, given a2, the square of a, rad^2."""
    if a2 < 0.01:
        return (0.5 - a2 * (1.0 / 24.0 - a2 * (1.0 / 720.0 - a2 * (
            1.0 / 40320.0 - a2 * (1.0 / 3628800.0)))),
            1.0 / 6.0 - a2 * (1.0 / 120.0 - a2 * (1.0 / 5040.0 - a2 * (
                1.0 / 362880.0 - a2 * (1.0 / 39916800.0)))))
    angle = sqrt(a2)
    sin, cos = sincos(angle)
    return (1.0 - cos) / a2, (1.0 - sin / angle) / a2


def integrals(omega, f, dt):
    """Return the integrals of a rate and a specific force that are constant over dt, s."""
    return (omega[0] * dt, omega[1] * dt, omega[2] * dt), (f[0] * dt, f[1] * dt, f[2] * dt)


def fixed_rate_increments(integrated, now, last):
    """
    Return the rotation vector and the velocity increment of one of several equal intervals.

    Parameters
    ----------
    integrated : True if the readings are plain integrals; False if they already are these
        increments
    now, last : ``integrals`` over this interval and the one before

    """
    if integrated:
        return two_sample_increments(now[0], now[1], last[0], last[1])
    return now


def uneven_increments(kind, last, now, dt, dt_last):
    """
    Return the rotation vector and the velocity increment of an interval of any length.

    Rate and force are assumed linear in time. Instantaneous values w0, w1 at the ends of the
    interval give alpha = dt (w0 + w1) / 2 and the coning term dt^2 w0 x w1 / 12, which is
    (2 dt w0) x alpha / 12: 2 dt w0 takes the place of alpha_last in ``two_sample_increments``. For
    means w0, w1 over intervals dt_last and dt its place is taken by
    dt w0 times 2 dt / (dt + dt_last). The sculling term follows in the same way.

    Parameters
    ----------
    kind : what the readings are, one of settings.recorded_imu.INPUTS
    last, now : (omega, f) at the two stamps, rad/s and m/s^2
    dt, dt_last : length of this interval and of the one before, s

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
