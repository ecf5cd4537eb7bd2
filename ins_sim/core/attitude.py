"""
Quaternions and rotation vectors, scalar last (x, y, z, w).

Products and rotations are written with operators only: components may be floats (kernels),
arrays (records) or Taylor series (motions).  Source: Savage, "Strapdown Analytics", ch. 3;
Bortz 1971.
"""

import math

from . import taylor

IDENTITY = (0.0, 0.0, 0.0, 1.0)


def multiply(p, q):
    """Return p q: q_ac = multiply(q_ab, q_bc)."""
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
    """Return C v for the quaternion q of C: v + 2 w (u x v) + 2 u x (u x v)."""
    x, y, z, w = q
    a, b, c = v
    tx = 2.0 * (y * c - z * b)
    ty = 2.0 * (z * a - x * c)
    tz = 2.0 * (x * b - y * a)
    return (a + w * tx + y * tz - z * ty,
            b + w * ty + z * tx - x * tz,
            c + w * tz + x * ty - y * tx)


def rotate_back(q, v):
    """Return C^T v for the quaternion q of C."""
    x, y, z, w = q
    return rotate((-x, -y, -z, w), v)


def exponential(phi):
    """Return the quaternion of a rotation vector, floats, rad."""
    x, y, z = phi
    a2 = x * x + y * y + z * z
    if a2 < 1e-8:
        s, c = 0.5 - a2 / 48.0, 1.0 - a2 / 8.0
    else:
        a = math.sqrt(a2)
        s, c = math.sin(0.5 * a) / a, math.cos(0.5 * a)
    return x * s, y * s, z * s, c


def logarithm(q):
    """
    Return the rotation vector (at most pi long) of a quaternion of any norm, floats, rad.

    The atan2 form: the acos(trace) form loses half the digits (spec: 1.35 m in an hour at 1 kHz).
    """
    x, y, z, w = q
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    n2 = x * x + y * y + z * z
    if n2 < 1e-300:
        s = 2.0
    else:
        n = math.sqrt(n2)
        s = 2.0 * math.atan2(n, w) / n
    return x * s, y * s, z * s


def normalise(q):
    """Return q with its norm, one to within 1e-8, corrected to one by a Newton step."""
    x, y, z, w = q
    s = 1.5 - 0.5 * (x * x + y * y + z * z + w * w)
    return x * s, y * s, z * s, w * s


def local_level(sin_half_lat, cos_half_lat, sin_half_lon, cos_half_lon):
    """
    Return q_en (ENU to ECEF) from sines and cosines of lat / 2 and lon / 2.

    C_en = Rz(lon + 90 deg) Rx(90 deg - lat).
    """
    r = math.sqrt(0.5)
    sx, cx = (cos_half_lat - sin_half_lat) * r, (cos_half_lat + sin_half_lat) * r
    sz, cz = (sin_half_lon + cos_half_lon) * r, (cos_half_lon - sin_half_lon) * r
    return cz * sx, sz * sx, sz * cx, cz * cx


def about_axis(axis, angle):
    """Return the quaternion Series of a rotation by the angle Series about axis 0, 1 or 2."""
    s, c = taylor.sincos(angle * 0.5)
    zero = s * 0.0
    return tuple(s if k == axis else zero for k in range(3)) + (c,)


def from_angles(psi, theta, gamma):
    """
    Return q_nb (FLU to ENU) of Series psi (counter-clockwise), theta, gamma.

    The paper's C = Rz(psi) Rx(theta) Ry(gamma) acts on (right, forward, up); on (forward, left,
    up) it is Rz(psi + 90 deg) Ry(-theta) Rx(gamma).
    """
    sz, cz = taylor.sincos((psi + 0.5 * math.pi) * 0.5)
    sy, cy = taylor.sincos(theta * -0.5)
    sx, cx = taylor.sincos(gamma * 0.5)
    cyx, syx, cysx, sycx = cy * cx, sy * sx, cy * sx, sy * cx
    return (cz * cysx - sz * sycx, cz * sycx + sz * cysx, sz * cyx - cz * syx,
            cz * cyx + sz * syx)
