"""Quaternions and rotation vectors, scalar last (x, y, z, w), of floats or arrays."""

import math

from ins_sim.core.numerics import elementary

IDENTITY = (0.0, 0.0, 0.0, 1.0)


def multiply(p, q):
    """Return the product p q: q_ac = multiply(q_ab, q_bc)."""
    px, py, pz, pw = p
    qx, qy, qz, qw = q
    return (pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
            pw * qw - px * qx - py * qy - pz * qz)


def conjugate(q):
    """Return the inverse of a unit quaternion."""
    return -q[0], -q[1], -q[2], q[3]


def cross(a, b):
    """Return a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def rotate(q, v):
    """Return C v, where q is the quaternion of C: v + 2 w (u x v) + 2 u x (u x v)."""
    x, y, z, w = q
    a, b, c = v
    tx = 2.0 * (y * c - z * b)
    ty = 2.0 * (z * a - x * c)
    tz = 2.0 * (x * b - y * a)
    return (a + w * tx + y * tz - z * ty,
            b + w * ty + z * tx - x * tz,
            c + w * tz + x * ty - y * tx)


def rotate_back(q, v):
    """Return C^T v, where q is the quaternion of C."""
    x, y, z, w = q
    return rotate((-x, -y, -z, w), v)


# Square of the longest rotation vector that ``small_exponential`` accepts, rad^2.
SMALL2 = 0.09


def small_exponential(phi):
    """Return the quaternion of a rotation vector of at most 0.3 rad, exact to rounding."""
    x, y, z = phi
    a2 = x * x + y * y + z * z
    a4 = a2 * a2
    s = (0.5 - a2 * (1.0 / 48.0)) + a4 * ((1.0 / 3840.0 - a2 * (1.0 / 645120.0))
                                          + a4 * (1.0 / 185794560.0))
    c = (1.0 - a2 * 0.125) + a4 * ((1.0 / 384.0 - a2 * (1.0 / 46080.0))
                                   + a4 * (1.0 / 10321920.0 - a2 * (1.0 / 3715891200.0)))
    return x * s, y * s, z * s, c


def exponential(phi):
    """Return the quaternion of a rotation vector phi, rad; floats."""
    x, y, z = phi
    a2 = x * x + y * y + z * z
    if a2 <= SMALL2:
        return small_exponential(phi)
    a = math.sqrt(a2)
    s, c = elementary.sincos(0.5 * a)
    s = s / a
    return x * s, y * s, z * s, c


def logarithm(q):
    """
    Return the rotation vector (length at most pi, rad) of a quaternion of any norm.

    The atan2 form is used, because the acos(trace) form loses half the digits (1.35 m in an hour
    at 1 kHz).
    """
    x, y, z, w = q
    n = elementary.sqrt(x * x + y * y + z * z)
    # Identity: q is so near to a rotation by zero that the squares underflow.
    tiny = elementary.as_number(n < 1e-150)
    sign = 1.0 - elementary.as_number(w < 0.0) * 2.0
    s = sign * 2.0 * (elementary.atan2(n, abs(w)) / (n + tiny) * (1.0 - tiny) + tiny)
    return x * s, y * s, z * s


def normalise(q):
    """Return q scaled to norm one by a Newton step; its norm must be one to within 1e-8."""
    x, y, z, w = q
    s = 1.5 - 0.5 * (x * x + y * y + z * z + w * w)
    return x * s, y * s, z * s, w * s


def shorter(theta):
    """Return the same rotation with a length of at most pi: theta (1 - 2 pi / d) if d > pi."""
    x, y, z = theta
    d2 = x * x + y * y + z * z
    if d2 <= math.pi * math.pi:
        return theta
    s = 1.0 - 2.0 * math.pi / math.sqrt(d2)
    return x * s, y * s, z * s
