"""
Knots, which are the input of the interpolation, from samples.

A knot is a sample itself, or the value of a parabola fitted to the samples around it.
"""

from collections import deque

from ins_sim.core.attitude import quaternion
from .knots import Sample, turn_between

# Tolerance of the half length of a window, in periods, because stamps jitter.
SLACK = 0.25


class KnotFit:
    """
    Makes knots from samples.

    Parameters
    ----------
    every : number of samples per knot
    half_ns : a knot is the value, at its instant, of the parabola fitted to the samples that are
        at most half_ns away, ns; 0 to use the sample itself
    period_ns : period of the samples, ns
    """

    def __init__(self, every, half_ns, period_ns):
        self._every, self._half_ns = every, half_ns
        self._least_ns = 0.5 * every * period_ns
        self._slack_ns = SLACK * period_ns
        self._samples, self._centres = deque(), deque()
        self._last_ns, self._count = None, 0

    def push(self, sample):
        """Process a Sample; return the knots that it completes, a list of Samples."""
        self._count += 1
        t_ns = sample.t_ns
        if self._last_ns is None or (self._count >= self._every
                                     and t_ns - self._last_ns >= self._least_ns):
            self._last_ns, self._count = t_ns, 0
            if not self._half_ns:
                return [sample]
            self._centres.append(sample)
        self._samples.append(sample)
        knots = []
        while self._centres and (
                t_ns + self._slack_ns >= self._centres[0].t_ns + self._half_ns):
            knots.append(self._fitted(self._centres.popleft()))
        return knots

    def _fitted(self, centre):
        """Return the fitted Sample at a centre; samples before its window are dropped."""
        t_ns, reach_ns = centre.t_ns, self._half_ns + self._slack_ns
        while self._samples[0].t_ns < t_ns - reach_ns:
            self._samples.popleft()
        near = [s for s in self._samples if s.t_ns <= t_ns + reach_ns]
        factors = parabola_weights([(s.t_ns - t_ns) * 1e-9 for s in near])
        turned = _mean(factors, [turn_between(centre.q, s.q) for s in near])
        r = centre.r
        moved = _mean(factors, [[a - b for a, b in zip(s.r, r)] for s in near])
        return Sample(t_ns, tuple(a + b for a, b in zip(r, moved)),
                      quaternion.multiply(centre.q, quaternion.exponential(turned)),
                      _mean(factors, [s.v for s in near]), _mean(factors, [s.w for s in near]))


def _mean(factors, vectors):
    x = y = z = 0.0
    for factor, (a, b, c) in zip(factors, vectors):
        x, y, z = x + factor * a, y + factor * b, z + factor * c
    return x, y, z


def parabola_weights(x):
    """
    Return the weights with which values at x add up to their least-squares parabola at 0.

    With fewer than three abscissas, or with all on one side, only the value at 0 counts.
    """
    count = len(x)
    if count < 3 or not min(x) < 0.0 < max(x):
        return [1.0 if s == 0.0 else 0.0 for s in x]
    s1 = s2 = s3 = s4 = 0.0
    for s in x:
        square = s * s
        s1, s2, s3, s4 = s1 + s, s2 + square, s3 + square * s, s4 + square * square
    # The first row of the inverse of the normal equations, by cofactors.
    a, b, c = s2 * s4 - s3 * s3, s2 * s3 - s1 * s4, s1 * s3 - s2 * s2
    d = count * a + s1 * b + s2 * c
    return [(a + s * (b + s * c)) / d for s in x]
