"""
Gusts with a first-order (Dryden, longitudinal) spectrum as sums of sinusoids.

The density of each component is sigma^2 (2 tau/pi)/(1 + (w tau)^2) over w > 0, with tau =
length/airspeed (MIL-F-8785C). It is cut at w tau = 0.05 and 20, which removes 3 % of the variance
at either end, so that the displacement by the gusts stays bounded and the acceleration finite. All
sinusoids have the same share of the variance; the frequency of each is drawn at random within the
part of the spectrum that it represents.
"""

import math

import numpy as np

from ins_sim.core.numerics import noise, taylor
from ins_sim.core.numerics.elementary import atan2, sincos

LINES = 20
LOWEST, HIGHEST = 0.05, 20.0
# Number of instants evaluated at a time: 60 sinusoids at so many instants fit into the cache.
CHUNK = 256


class Gusts:
    """
    Gust velocity east, north, up, each with the standard deviation sigma (m/s).

    Parameters
    ----------
    sigma : standard deviation of each component, m/s
    length : scale of the turbulence, m
    airspeed : m/s
    seed : selects the gusts

    Attributes
    ----------
    rates : (3, LINES) angular frequencies of the sinusoids, rad/s
    amplitude : amplitude of each sinusoid, m/s
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
        """Return the displacement by the gusts at t (n,), s: three Series of order 2, m."""
        parts = [self._displaced(t[k:k + CHUNK]) for k in range(0, max(1, len(t)), CHUNK)]
        return tuple(taylor.Series(np.concatenate(rows, axis=1)) for rows in zip(*parts))

    def _displaced(self, t):
        """Return the Taylor coefficients of the displacement for each axis, (3, n)."""
        w = self.rates[:, :, np.newaxis]
        sin, cos = sincos(t * w + self._phases[:, :, np.newaxis])
        sums = (_summed(sin * (self.amplitude / w)), _summed(cos * self.amplitude),
                _summed(sin * (-0.5 * self.amplitude * w)))
        return [np.stack(rows) for rows in zip(*sums)]


def _summed(lines):
    """Return the sum over lines (3, LINES, n), in a fixed order for any n, (3, n)."""
    if lines.shape[-1] == 1:
        return np.cumsum(lines, axis=1)[:, -1]
    return np.add.reduce(lines, axis=1)
