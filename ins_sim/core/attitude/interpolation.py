"""
Interpolation of sampled motion: Hermite and Newton polynomials, and quaternions between samples.

``hermite_coefficients`` and ``newton_differences`` reconstruct a continuous motion from streamed
truth without looking ahead (docs/theory/streamed_truth.md).
"""

import numpy as np

from . import quaternion


def hermite_coefficients(h, d, w_start, w_end):
    """
    Return the coefficients of the cubic rotation vector between two samples.

    The attitude is q(s) = q_start exp(r(s)) with r(s) = c1 s + c2 s^2 + c3 s^3, s in s since the
    start. The end rate is mapped by the inverse right Jacobian of the rotation vector, to second
    order. Components may be floats or arrays.

    Parameters
    ----------
    h : length of the interval, s
    d : rotation vector from q_start to q_end, rad
    w_start, w_end : rate of b relative to the frame of q, resolved in b, rad/s

    Returns
    -------
    c1, c2, c3

    """
    dw = quaternion.cross(d, w_end)
    ddw = quaternion.cross(d, dw)
    a = (h * w_start[0], h * w_start[1], h * w_start[2])
    b = (h * (w_end[0] + dw[0] / 2.0 + ddw[0] / 12.0),
         h * (w_end[1] + dw[1] / 2.0 + ddw[1] / 12.0),
         h * (w_end[2] + dw[2] / 2.0 + ddw[2] / 12.0))
    c2 = (3.0 * d[0] - 2.0 * a[0] - b[0], 3.0 * d[1] - 2.0 * a[1] - b[1],
          3.0 * d[2] - 2.0 * a[2] - b[2])
    c3 = (a[0] + b[0] - 2.0 * d[0], a[1] + b[1] - 2.0 * d[1], a[2] + b[2] - 2.0 * d[2])
    return a, c2, c3


def newton_differences(last, value, r1, r2, r3):
    """
    Return the divided differences d0..d3 at a new sample, newest first.

    Parameters
    ----------
    last : the differences at the sample before
    value : the new vector, three components
    r1, r2, r3 : reciprocals of the times since the last three samples, 1/s, zero for a sample that
        does not exist; the order is then lower

    """
    x, y, z = value
    d = [value]
    for (a, b, c), r in zip(last, (r1, r2, r3)):
        x, y, z = (x - a) * r, (y - b) * r, (z - c) * r
        d.append((x, y, z))
    return d


def newton_value(differences, s0, s1, s2):
    """Return the cubic of ``newton_differences``; s0, s1, s2: s since the last three samples."""
    (a0, b0, c0), (a1, b1, c1), (a2, b2, c2), (a3, b3, c3) = differences
    return (a0 + s0 * (a1 + s1 * (a2 + s2 * a3)), b0 + s0 * (b1 + s1 * (b2 + s2 * b3)),
            c0 + s0 * (c1 + s1 * (c2 + s2 * c3)))


def continuous_quaternions(q):
    """Return (n, 4) quaternions with signs chosen so that neighbours differ least."""
    x, y, z, w = (q[1:] * q[:-1]).T
    back = x + y + z + w < 0.0
    return q * np.concatenate([[1.0], np.cumprod(np.where(back, -1.0, 1.0))])[:, None]


def middle_attitude(q_start, q_end):
    """Return the attitude half-way between two nearby attitudes."""
    return quaternion.normalise((0.5 * (q_start[0] + q_end[0]), 0.5 * (q_start[1] + q_end[1]),
                                 0.5 * (q_start[2] + q_end[2]), 0.5 * (q_start[3] + q_end[3])))
