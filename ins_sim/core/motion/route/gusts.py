"""
Gusts of first-order (Dryden, longitudinal) spectrum as sums of sinusoids.

Density of each component sigma^2 (2 tau/pi)/(1 + (w tau)^2) over w > 0, tau = length/airspeed
(MIL-F-8785C).  It is cut at w tau = 0.05 and 20, 3 % of the variance at either end, so that what
the gusts carry away stays bounded and the acceleration finite.  Every sinusoid has the same part
of the variance, and the frequency of each is drawn within the part of the spectrum it stands for.
"""

import math

import numpy as np

from ins_sim.core.numerics import noise, taylor

LINES = 20
LOWEST, HIGHEST = 0.05, 20.0


class Gusts:
    """
    Gust velocity East, North, Up of standard deviation sigma each, m/s.

    length: of the turbulence, m; airspeed: m/s; seed: names the gusts.  rates (3, LINES), rad/s;
    amplitude, m/s: of each sinusoid.
    """

    def __init__(self, sigma, length, airspeed, seed):
        draws = noise.indexed_noise(seed, 0, 'gusts', 6).uniforms(0, LINES).T
        low, high = math.atan(LOWEST), math.atan(HIGHEST)
        part = (np.arange(LINES) + draws[:3]) / LINES
        self.rates = np.tan(low + part * (high - low)) * (airspeed / length)
        self.amplitude = sigma * math.sqrt(2.0 / LINES)
        self._phases = 2.0 * math.pi * draws[3:]

    def displacement(self, t):
        """Return three Series of order 2: where the gusts have carried to at t (n,), s; in m."""
        return tuple(self._component(t, *lines) for lines in zip(self.rates.tolist(),
                                                                 self._phases.tolist()))

    def _component(self, t, rates, phases):
        c = np.zeros((3, len(t)))
        for w, phase in zip(rates, phases):
            # with vector units NumPy's tangent takes a tenth of its sine and cosine
            half = np.tan(t * (0.5 * w) + 0.5 * phase)
            share = 2.0 / (1.0 + half * half)
            sin = half * share
            c[0] += sin * (self.amplitude / w)
            c[1] += (share - 1.0) * self.amplitude
            c[2] -= sin * (0.5 * self.amplitude * w)
        return taylor.Series(c)
