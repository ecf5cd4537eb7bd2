"""
Exponential and logarithm of many rotations at once.

Components are arrays of one shape; the results are those of ``quaternion.exponential`` and
``quaternion.logarithm``, which take floats, to the last bit.
"""

import math

import numpy as np


def exponentials(phi):
    """Return the quaternions of rotation vectors, three arrays, rad."""
    x, y, z = phi
    a2 = x * x + y * y + z * z
    small = a2 < 1e-8
    a = np.sqrt(a2)
    s = np.where(small, 0.5 - a2 / 48.0, np.sin(0.5 * a) / np.where(small, 1.0, a))
    c = np.where(small, 1.0 - a2 / 8.0, np.cos(0.5 * a))
    return x * s, y * s, z * s, c


def logarithms(q):
    """Return the rotation vectors, at most pi long, of quaternions, four arrays, rad."""
    x, y, z, w = q
    sign = np.where(w < 0.0, -1.0, 1.0)
    x, y, z, w = x * sign, y * sign, z * sign, w * sign
    n2 = x * x + y * y + z * z
    none = n2 < 1e-300
    n = np.sqrt(n2)
    # NumPy's arctan2 has other last bits than that of math.
    angle = np.array(list(map(math.atan2, n.tolist(), w.tolist())))
    s = np.where(none, 2.0, 2.0 * angle / np.where(none, 1.0, n))
    return x * s, y * s, z * s
