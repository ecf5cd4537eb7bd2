"""
What the errors of the instruments add to the nine errors in one interval, for a unit of each.

All intervals of a run go side by side, in the last axis. In each, the steps are taken backwards
with the transition matrix A from the end of a step to that of the interval, so that what acts in
a step is carried to the end at once. With W the response to an error by body axis that is
constant over a step, a process of covariance R between the means over steps j and l makes

    sum over j, l of  W_j R_jl W_l'

which needs, of a stationary Gauss-Markov process, one more sum s = sum over l > j of
W_l k a^(l-j-1), a = exp(-h/T), k = (1 - a) T/h.
"""

from typing import NamedTuple

import numpy as np

from ins_sim.core.navigation.error_dynamics import change, GROWING, inertial_rows
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import lane_product
from .sources import ACCELEROMETER, GYRO, sources_of

V, PHI, UP = slice(3, 6), slice(6, 9), (2, 5)
ROWS = {ACCELEROMETER: V, GYRO: PHI}
# Up to this ratio of a step to a time constant the variance of a mean is a series, and from the
# other one on nothing is left of a process.
SHORT, GONE = 0.1, 700.0


class Responses(NamedTuple):
    """
    Responses at the ends of n intervals.

    transition (9, 9, n): to the errors at the start; constants: of each triad (9, 9, n), as of
    ``TimeLanes.by_error``; fixed (9, f, n): to what is the same in every run; noise: of each triad
    a TriadNoise.
    """

    transition: np.ndarray
    constants: tuple
    fixed: np.ndarray
    noise: tuple


class TriadNoise:
    """
    What noises of one triad have added at the ends of the intervals, for units of each.

    markov : MarkovProcesses of the triad
    h : (n,) length of a step, s
    with_walk : whether there is a random walk

    Attributes
    ----------
    white, walk : (9, 9, 3, n) covariances for a density of one, by axis
    markov : (sources, 9, 9, 3, n) covariances of the processes of each source
    start : (m, 9, 3, n) response to the values of the processes at the start of the interval
    end : (m, 9, 3, n) covariance with their values at its end, of processes of variance one
    walk_end : (9, 3, n) covariance with the value of the walk there
    kept : (m, 3, n) what is left of the processes after the interval

    """

    def __init__(self, markov, h, with_walk):
        sources = sources_of(markov)
        self._of = [sources.index(process.source) for process in markov]
        self._variances = np.reshape([process.variance for process in markov], (-1, 3, 1))
        times = np.array([process.time_s for process in markov]).reshape(-1, 3)
        x = h / times[:, :, np.newaxis]
        less = -elementary.expm1(-np.minimum(x, GONE))
        self._a, self._k, self._x = 1.0 - less, less / x, x
        self._h, self._walks = h, with_walk
        shape = (len(times), GROWING, 3, len(h))
        self.start, self.end, self.kept = np.zeros(shape), np.zeros(shape), np.ones_like(x)
        self.white = np.zeros((GROWING, GROWING, 3, len(h)))
        self.markov = np.zeros((len(sources), *self.white.shape))
        self._sum, self.walk_end = np.zeros(shape[1:]), np.zeros(shape[1:])
        self.walk = np.zeros_like(self.white)
        self._term = np.empty_like(self.white)

    def _add_outer(self, total, a, b):
        np.multiply(a[:, np.newaxis], b, out=self._term)
        total += self._term

    def add(self, w):
        """Add a step before all that were added; w (9, 3, n): the response to its mean."""
        self._add_outer(self.white, w, w)
        before = [0.0] * len(self.markov)
        for k, (source, variance) in enumerate(zip(self._of, self._variances)):
            before[source] = before[source] + (variance * self._k[k]) * self.start[k]
        for total, response in zip(self.markov, before):
            self._add_outer(total, w, response)
        if self._of:
            self.start *= self._a[:, np.newaxis]
            self.start += self._k[:, np.newaxis] * w
            self.end += (self._k * self.kept)[:, np.newaxis] * w
            self.kept *= self._a
        if self._walks:
            half = 0.5 * w
            self._sum += half
            driven = self._h * self._sum
            self._add_outer(self.walk, driven, self._sum)
            self.walk_end += driven
            self._sum += half

    def finish(self):
        """Complete the covariances once all steps are added."""
        self.markov += np.swapaxes(self.markov, 1, 2)
        for k, (source, variance) in enumerate(zip(self._of, self._variances)):
            self.markov[source] += (variance * mean_variance(self._x[k])) * self.white
        self.walk += (self._h / 12.0) * self.white
        self.white /= self._h


def mean_variance(x):
    """Return the variance of the mean over x time constants of a process of variance one."""
    low, high = np.minimum(x, SHORT), np.maximum(x, SHORT)
    series = 1.0 - low / 3.0 * (1.0 - 0.25 * low * (1.0 - 0.2 * low * (1.0 - low / 6.0)))
    return np.where(x < SHORT, series, 2.0 / high * (
        1.0 + elementary.expm1(-np.minimum(high, GONE)) / high))


def interval_responses(lanes, spin, held, damping, noises, fixed):
    """
    Return the Responses of TimeLanes.

    spin, damping: as of ``free_covariance.coefficients``; held: whether height and vertical
    velocity come from the truth; noises: a TriadNoise of each triad; fixed (steps, 6, f, n): means
    in n of the f errors of accelerometers and gyros that are the same in every run.
    """
    force, rate = lanes.columns(lanes.truth.f_ib_b), lanes.columns(lanes.truth.omega_ib_b)
    f_n = lanes.means_in_n(force)
    errors = lanes.by_error(force), lanes.by_error(rate)
    width = len(lanes.h)
    a = np.repeat(np.eye(GROWING)[:, :, np.newaxis], width, axis=2)
    if held:
        a[list(UP)] = 0.0
    constants = np.zeros((GROWING, 9, width)), np.zeros((GROWING, 9, width))
    added = np.zeros((GROWING, fixed.shape[2], width))
    half = 0.5 * lanes.h * lanes.h
    for step in range(lanes.steps - 1, -1, -1):
        f = _coefficients(lanes.middle(step), f_n[step], spin, held, damping)
        driven = lanes.h * a[:, 3:] + half * lane_product(a, f[:, 3:])
        for triad in (ACCELEROMETER, GYRO):
            rows = slice(ROWS[triad].start - 3, ROWS[triad].stop - 3)
            response = lane_product(driven[:, rows], errors[triad][step])
            constants[triad][...] += response
            noises[triad].add(response[:, :3])
        if len(added[0]):
            added += lane_product(driven, fixed[step])
        a = a + lane_product(a, change(f, lanes.h))
    for noise in noises:
        noise.finish()
    return Responses(a, constants, added, noises)


def _coefficients(middle, f_n, spin, held, damping):
    """Return F (9, 9, n) of the middle of a step."""
    lat, height, v, c = middle
    rows = inertial_rows(lat, height, v, c, f_n, spin)
    f = np.zeros((GROWING, GROWING, len(lat)))
    for i, row in enumerate(rows):
        for k, value in enumerate(row[:GROWING]):
            f[i, k] = value
    if held:
        f[list(UP)] = f[:, list(UP)] = 0.0
    f[2, 2] -= damping[0]
    f[5, 2] -= damping[1]
    return f
