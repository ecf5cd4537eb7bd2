"""
Exponential of many rotation vectors in one call.

The result has the same bits as that of ``quaternion.exponential``, which takes floats. Components
are arrays of one shape.
"""

import numpy as np

from ins_sim.core.numerics.elementary import sincos
from . import quaternion


def exponentials(phi):
    """Return the quaternions of rotation vectors phi (three arrays, rad)."""
    x, y, z = phi
    a2 = x * x + y * y + z * z
    small = a2 <= quaternion.SMALL2
    q = quaternion.small_exponential(phi)
    if small.all():
        return q
    a = np.sqrt(a2)
    s, c = sincos(0.5 * a)
    s = s / np.where(small, 1.0, a)
    return tuple(np.where(small, near, far) for near, far in zip(q, (x * s, y * s, z * s, c)))
