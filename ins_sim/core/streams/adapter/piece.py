"""The motion between two knots: a polynomial for position and a curve for attitude."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.interpolation import hermite_coefficients
from ins_sim.core.numerics import elementary

# Below this squared angle, rad^2, the series of the right Jacobian is exact to rounding.
SMALL2 = 0.01


class Piece:
    """
    The motion from start_ns to end_ns.

    Parameters
    ----------
    start_ns, end_ns : motion times, ns
    path : for each axis of the world, the coefficients c0...c5 of position (m) in powers of the
        time since start_ns (s)
    q : attitude at the start
    turned : rotation vector from the start to the end, rad
    w_start, w_end : rates relative to the world at both ends, in body axes, rad/s
    """

    __slots__ = 'start_ns', 'end_ns', '_path', '_q', '_curve', '_per_s'

    def __init__(self, start_ns, end_ns, path, q, turned, w_start, w_end):
        self.start_ns, self.end_ns, self._path, self._q = start_ns, end_ns, path, q
        h = (end_ns - start_ns) * 1e-9
        self._curve, self._per_s = hermite_coefficients(h, turned, w_start, w_end), 1.0 / h

    def at(self, t_ns):
        """Return position, velocity, acceleration, attitude, and rate in body axes at t_ns."""
        t = (t_ns - self.start_ns) * 1e-9
        r, v, a = zip(*[derivatives(c, t) for c in self._path])
        s, n = t * self._per_s, self._per_s
        c1, c2, c3 = self._curve
        phi = tuple(s * (x + s * (y + s * z)) for x, y, z in zip(c1, c2, c3))
        phi_rate = tuple(n * (x + s * (2.0 * y + s * 3.0 * z)) for x, y, z in zip(c1, c2, c3))
        q = quaternion.multiply(self._q, quaternion.exponential(phi))
        return r, v, a, q, rate_of(phi, phi_rate)


def derivatives(c, t):
    """Return the value of c0 + c1 t + ... + c5 t^5 and its first two derivatives."""
    c0, c1, c2, c3, c4, c5 = c
    return (c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5)))),
            c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * (4.0 * c4 + t * (5.0 * c5)))),
            2.0 * c2 + t * (6.0 * c3 + t * (12.0 * c4 + t * (20.0 * c5))))


def rate_of(phi, phi_rate):
    """
    Return the body rate, rad/s, for a rotation vector phi (rad) and its derivative (rad/s).

    By the right Jacobian of SO(3) (docs/theory/external_truth.md), with a the length of phi::

        w = phi' - (1 - cos a) / a^2 phi x phi' + (a - sin a) / a^3 phi x (phi x phi')
    """
    a2 = phi[0] * phi[0] + phi[1] * phi[1] + phi[2] * phi[2]
    if a2 < SMALL2:
        first = 0.5 - a2 * (1.0 / 24.0 - a2 * (1.0 / 720.0 - a2 / 40320.0))
        second = 1.0 / 6.0 - a2 * (1.0 / 120.0 - a2 * (1.0 / 5040.0 - a2 / 362880.0))
    else:
        a = math.sqrt(a2)
        sin, cos = elementary.sincos(a)
        first, second = (1.0 - cos) / a2, (a - sin) / (a2 * a)
    b = quaternion.cross(phi, phi_rate)
    c = quaternion.cross(phi, b)
    return tuple(x - first * y + second * z for x, y, z in zip(phi_rate, b, c))
