"""Sums over the current window of the velocity meter, as the filters need them."""

from collections import namedtuple
import copy

import numpy as np

from ins_sim.core.attitude.matrix import dcm_of


class _Sums:
    """Sums over a window: values are replaced, never changed, so a shallow copy is a snapshot."""

    def __init__(self):
        self.clear()

    def copy(self):
        """Return a snapshot."""
        return copy.copy(self)


class BodyMean(_Sums):
    """Mean velocity in b over the window so far, by the trapezoid of its cycles."""

    def clear(self):
        """Begin a window."""
        self.time_s = 0.0
        self._sum = (0.0, 0.0)

    def add(self, before, after, dt):
        """Take a cycle: the velocities in b at its ends, m/s, and its length, s."""
        half = 0.5 * dt
        self._sum = (self._sum[0] + half * (before[0] + after[0]),
                     self._sum[1] + half * (before[1] + after[1]))
        self.time_s += dt

    def shift(self, forward, left):
        """Take an estimated error off the integral, m."""
        self._sum = self._sum[0] - forward, self._sum[1] - left

    @property
    def value(self):
        """Return the mean forward and left velocity, m/s."""
        return self._sum[0] / self.time_s, self._sum[1] / self.time_s


class Integrals(_Sums):
    """
    The matrices of the window, of the level axes (East, North) and the body's (forward, left).

    a1 = sum C T_c, a2 = sum A1 T_c, b1 = sum C^T T_c / T, b2 = sum C^T A1 T_c / T (docs/theory.md,
    "Aided navigation"). They map a constant error of the acceleration in b (a1, a2, b2) or of the
    velocity in n (b1) to the errors at the end of the window: a1 to velocity, a2 to position, b1
    and b2 to the mean velocity in b. Each is (2, 2).
    """

    def clear(self):
        """Begin a window."""
        self.time_s = 0.0
        self._a1 = self._a2 = self._b1 = self._b2 = (0.0,) * 4

    def add(self, q_nb, dt):
        """Take a cycle: the attitude at its middle, and its length, s."""
        m = dcm_of(q_nb)
        c = (m[0], m[1], m[3], m[4])
        last, half = self._a1, 0.5 * dt
        self._a1 = now = tuple(a + b * dt for a, b in zip(last, c))
        mid = tuple(0.5 * (a + b) for a, b in zip(last, now))
        self._a2 = tuple(a + half * (x + y) for a, x, y in zip(self._a2, last, now))
        t = (c[0], c[2], c[1], c[3])
        self._b1 = tuple(a + x * dt for a, x in zip(self._b1, t))
        product = (t[0] * mid[0] + t[1] * mid[2], t[0] * mid[1] + t[1] * mid[3],
                   t[2] * mid[0] + t[3] * mid[2], t[2] * mid[1] + t[3] * mid[3])
        self._b2 = tuple(a + x * dt for a, x in zip(self._b2, product))
        self.time_s += dt

    @property
    def matrices(self):
        """Return a1, a2, b1, b2."""
        sums = self._a1, self._a2, self._b1, self._b2
        a1, a2, b1, b2 = (np.array(x).reshape(2, 2) for x in sums)
        return a1, a2, b1 / self.time_s, b2 / self.time_s


class DoubleIntegral(namedtuple('DoubleIntegral', 'once twice', defaults=2 * ((0.0, 0.0),))):
    """An acceleration (forward, left) integrated once, m/s, and twice, m, over the window."""

    def after(self, increment, dt):
        """Return the integrals a cycle later: increment, m/s, in dt, s."""
        a, b, half = self.once, self.twice, 0.5 * dt
        return DoubleIntegral((a[0] + increment[0], a[1] + increment[1]),
                              (b[0] + dt * a[0] + half * increment[0],
                               b[1] + dt * a[1] + half * increment[1]))
