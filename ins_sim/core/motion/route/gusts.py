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
from ins_sim.core.numerics.elementary import atan2, sincos

LINES = 20
LOWEST, HIGHEST = 0.05, 20.0
# Instants at a time: 60 sinusoids of so many stay in the cache.
CHUNK = 256


class Gusts:
    """
    Gust velocity East, North, Up of standard deviation sigma each, m/s.

    length: of the turbulence, m; airspeed: m/s; seed: names the gusts.  rates (3, LINES), rad/s;
    amplitude, m/s: of each sinusoid.
    """

    def __init__(self, sigma, length, airspeed, seed):
        draws = noise.indexed_noise(seed, 0, 'gusts', 6).uniforms(0, LINES).T
        low, high = atan2(LOWEST, 1.0), atan2(HIGHEST, 1.0)
        part = (np.arange(LINES) + draws[:3]) / LINES
        sin, cos = sincos(low + part * (high - low))
        self.rates = sin / cos * (airspeed / length)
        self.amplitude = sigma * math.sqrt(2.0 / LINES)
        self._phases = 2.0 * math.pi * draws[3:]

    def displacement(self, t):
        """Return three Series of order 2: where the gusts have carried to at t (n,), s; in m."""
        parts = [self._displaced(t[k:k + CHUNK]) for k in range(0, max(1, len(t)), CHUNK)]
        return tuple(taylor.Series(np.concatenate(rows, axis=1)) for rows in zip(*parts))

    def _displaced(self, t):
        """Return the Taylor coefficients of each axis, (3, n)."""
        w = self.rates[:, :, np.newaxis]
        sin, cos = sincos(t * w + self._phases[:, :, np.newaxis])
        sums = (_summed(sin * (self.amplitude / w)), _summed(cos * self.amplitude),
                _summed(sin * (-0.5 * self.amplitude * w)))
        return [np.stack(rows) for rows in zip(*sums)]


def _summed(lines):
    """Return the sum of lines (3, LINES, n) in their order, whatever n is, (3, n)."""
    if lines.shape[-1] == 1:
        return np.cumsum(lines, axis=1)[:, -1]
    return np.add.reduce(lines, axis=1)
