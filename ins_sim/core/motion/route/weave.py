"""
A weave of the heading at constant airspeed, d = A cos(w t), and the displacement it causes.

The air velocity oscillates by d about its mean direction. Its components along and to the right of
that direction are

    V cos d = V [J0(A) + 2 sum (-1)^k J_2k(A) cos(2k w t)],
    V sin d = V 2 sum (-1)^k J_2k+1(A) cos((2k + 1) w t)          (Abramowitz and Stegun 9.1.44-47)

The mean velocity is therefore J0(A) V, and the displacements about it are periodic sums.
"""

import math

from ins_sim.core.numerics import taylor

# Bessel functions below this value are left out.
_LEAST = 1e-15


def bessel(k, x):
    """
    Return the Bessel function J_k(x) by its power series (Abramowitz and Stegun 9.1.10).

    For |x| <= 1 the terms decrease from the first on, so that there is no cancellation.
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
    A weave: amplitude (rad) and period (s) of the heading, at an airspeed (m/s).

    made_good: the fraction of the airspeed that contributes to the mean velocity, J0(amplitude).
    """

    def __init__(self, amplitude, period_s, airspeed):
        self._amplitude, self._rate = amplitude, 2.0 * math.pi / period_s
        self.made_good = bessel(0, amplitude)
        self._terms = []
        k = 1
        while abs(bessel(k, amplitude)) > _LEAST:
            # Signs for k = 1, 2, 3, 4, ...: right +, along -, right -, along +.
            sign = 1.0 if k % 4 in (0, 1) else -1.0
            reach = sign * 2.0 * airspeed * bessel(k, amplitude) / (k * self._rate)
            self._terms.append((k, reach))
            k += 1

    def angle(self, t):
        """Return the Series of the heading change, rad, clockwise positive; t: Series of time."""
        return taylor.sincos(t * self._rate)[1] * self._amplitude

    def displacement(self, t):
        """Return the Series of the displacements along and to the right, m; zero at t = 0."""
        moved = [t.constant(0.0), t.constant(0.0)]
        for k, reach in self._terms:
            moved[k % 2] = moved[k % 2] + taylor.sin(t * (k * self._rate)) * reach
        return tuple(moved)
