"""
A weave of the heading at constant airspeed, d = A cos(w t), and the way that it goes.

The air velocity turns by d to either side of its mean direction.  Along and to the right of that,

    V cos d = V [J0(A) + 2 sum (-1)^k J_2k(A) cos(2k w t)],
    V sin d = V 2 sum (-1)^k J_2k+1(A) cos((2k + 1) w t)          (Abramowitz and Stegun 9.1.44-47)

so that it makes good J0(A) V, and its displacements about that are periodic sums.
"""

import math

from ins_sim.core.numerics import taylor

# of the Bessel functions that are left out
_LEAST = 1e-15


def bessel(k, x):
    """
    Return the Bessel function J_k(x) by its power series (Abramowitz and Stegun 9.1.10).

    The terms of |x| <= 1 fall from the first on, so that no digits cancel.
    """
    half, term = 0.5 * x, 1.0
    for j in range(1, k + 1):
        term = term * half / j
    total, square = term, half * half
    for j in range(1, 30):
        term = -term * square / (j * (j + k))
        total += term
    return total


class Weave:
    """
    amplitude (rad), period (s) of the heading; airspeed (m/s).

    made_good: the part of the airspeed that is made good, J0(amplitude).
    """

    def __init__(self, amplitude, period_s, airspeed):
        self._amplitude, self._rate = amplitude, 2.0 * math.pi / period_s
        self.made_good = bessel(0, amplitude)
        self._terms = []
        k = 1
        while abs(bessel(k, amplitude)) > _LEAST:
            # k = 1, 2, 3, 4, ...: right +, along -, right -, along +
            sign = 1.0 if k % 4 in (0, 1) else -1.0
            reach = sign * 2.0 * airspeed * bessel(k, amplitude) / (k * self._rate)
            self._terms.append((k, reach))
            k += 1

    def angle(self, t):
        """Return the Series of the angle, rad, clockwise, of the Series t of time."""
        return taylor.sincos(t * self._rate)[1] * self._amplitude

    def displacement(self, t):
        """Return the Series of the displacements along and to the right, m; zero at t = 0."""
        moved = [t.constant(0.0), t.constant(0.0)]
        for k, reach in self._terms:
            moved[k % 2] = moved[k % 2] + taylor.sin(t * (k * self._rate)) * reach
        return tuple(moved)
