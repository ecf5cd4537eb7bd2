"""
Responses of the nine errors to unit errors of the instruments over one interval.

All intervals of a run are processed side by side, in the last axis. Within each, the steps are
processed backwards with the transition matrix A from the end of a step to that of the interval,
so that an error that acts in a step is propagated to the end directly. W is the response to an
error by body axis that is constant over a step. A process with the covariance R between its
means over the steps j and l contributes

    sum over j, l of  W_j R_jl W_l'

For a stationary Gauss-Markov process this needs one more sum, s = sum over l > j of
W_l k a^(l-j-1), with a = exp(-h/T) and k = (1 - a) T/h.
"""

from typing import NamedTuple

import numpy as np

from ins_sim.core.navigation.error_dynamics import GROWING, inertial_rows
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import lane_product
from .sources import sources_of

# States that belong to the vertical channel: height and vertical velocity.
UP = 2, 5
# Up to the ratio SHORT of step to time constant the variance of a mean is computed by a series;
# beyond GONE a process has decayed completely.
SHORT, GONE = 0.1, 700.0


class Responses(NamedTuple):
    """
    Responses at the ends of n intervals.

    Attributes
    ----------
    transition : (9, 9, n) response to the errors at the start
    constants : for each triad (9, 9, n), see ``TimeLanes.by_error``
    fixed : (9, f, n) response to the f errors that are the same in every run
    noise : a TriadNoise for each triad

    """

    transition: np.ndarray
    constants: tuple
    fixed: np.ndarray
    noise: tuple


class TriadNoise:
    """
    Effect of the noises of one triad at the ends of the intervals, for unit values.

    Parameters
    ----------
    markov : MarkovProcesses of the triad
    h : (n,) length of a step, s
    with_walk : whether there is a random walk
    count : number of errors that are propagated

    Attributes
    ----------
    white, walk : (9, 9, 3, n) covariances for unit density, by axis
    markov : (sources, 9, 9, 3, n) covariances due to the processes of each source
    start : (m, 9, 3, n) response to the values of the processes at the start of the interval
    end : (m, 9, 3, n) covariance with their values at its end, for processes of unit variance
    walk_end : (9, 3, n) covariance with the value of the walk at the end
    kept : (m, 3, n) factor by which the processes decay over the interval

    """

    def __init__(self, markov, h, with_walk, count):
        sources = sources_of(markov)
        self._of = [sources.index(process.source) for process in markov]
        self._variances = np.reshape([process.variance for process in markov], (-1, 3, 1))
        times = np.array([process.time_s for process in markov]).reshape(-1, 3)
        x = h / times[:, :, np.newaxis]
        less = -elementary.expm1(-np.minimum(x, GONE))
        self._a, self._k, self._x = 1.0 - less, less / x, x
        self._h, self._walks = h, with_walk
        shape = (len(times), count, 3, len(h))
        self.start, self.end, self.kept = np.zeros(shape), np.zeros(shape), np.ones_like(x)
        self.white = np.zeros((count, count, 3, len(h)))
        self.markov = np.zeros((len(sources), *self.white.shape))
        self._sum, self.walk_end = np.zeros(shape[1:]), np.zeros(shape[1:])
        self.walk = np.zeros_like(self.white)
        self._term = np.empty_like(self.white)

    def _add_outer(self, total, a, b):
        np.multiply(a[:, np.newaxis], b, out=self._term)
        total += self._term

    def add(self, w):
        """Add the step before those added so far; w (9, 3, n): response to its mean."""
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

    def finish(self, alive):
        """Complete the covariances after all steps; alive: indices of the propagated errors."""
        self.markov += np.swapaxes(self.markov, 1, 2)
        for k, (source, variance) in enumerate(zip(self._of, self._variances)):
            self.markov[source] += (variance * mean_variance(self._x[k])) * self.white
        self.walk += (self._h / 12.0) * self.white
        self.white /= self._h
        for name, axes in (('white', (0, 1)), ('walk', (0, 1)), ('markov', (1, 2)),
                           ('start', (1,)), ('end', (1,)), ('walk_end', (0,))):
            for axis in axes:
                setattr(self, name, spread(getattr(self, name), alive, axis))


def mean_variance(x):
    """Return the variance of the mean of a unit-variance process over x time constants."""
    low, high = np.minimum(x, SHORT), np.maximum(x, SHORT)
    series = 1.0 - low / 3.0 * (1.0 - 0.25 * low * (1.0 - 0.2 * low * (1.0 - low / 6.0)))
    return np.where(x < SHORT, series, 2.0 / high * (
        1.0 + elementary.expm1(-np.minimum(high, GONE)) / high))


def interval_responses(lanes, spin, held, damping, processes, fixed):
    """
    Return the Responses of TimeLanes.

    Parameters
    ----------
    lanes : TimeLanes
    spin, damping : see ``free_covariance.coefficients``
    held : whether height and vertical velocity come from the truth, without errors
    processes : for accelerometers and gyros, the MarkovProcesses and walks
    fixed : (steps, 6, f, n) means in n of the f errors of accelerometers and gyros that are the
        same in every run

    """
    alive = [k for k in range(GROWING) if not (held and k in UP)]
    places = alive.index(3)
    force, rate = lanes.columns(lanes.truth.f_ib_b), lanes.columns(lanes.truth.omega_ib_b)
    f_n = lanes.means_in_n(force)
    errors = lanes.by_error(force)[:, :len(alive) - places - 3], lanes.by_error(rate)
    columns = slice(places, -3), slice(-3, None)
    fixed = fixed[:, [k - 3 for k in alive[places:]]]
    width = len(lanes.h)
    a = np.repeat(np.eye(len(alive))[:, :, np.newaxis], width, axis=2)
    constants = [np.zeros((len(alive), 9, width)) for _ in errors]
    added = np.zeros((len(alive), fixed.shape[2], width))
    half = 0.5 * lanes.h * lanes.h
    noises = [TriadNoise(markov, lanes.h, bool(walks), len(alive)) for markov, walks in processes]
    for step in range(lanes.steps - 1, -1, -1):
        f = _coefficients(lanes.middle(step), f_n[step], spin, damping)[alive][:, alive]
        # A_j exp(F h) to second order, as in ``error_dynamics.change``.
        moved = lane_product(a, f)
        driven = lanes.h * a + half * moved
        for triad, part in enumerate(columns):
            response = lane_product(driven[:, part], errors[triad][step])
            constants[triad] += response
            noises[triad].add(response[:, :3])
        if added.size:
            added += lane_product(driven[:, places:], fixed[step])
        a = a + (lanes.h * moved + half * lane_product(moved, f))
    for noise in noises:
        noise.finish(alive)
    return Responses(spread(spread(a, alive, 0), alive, 1),
                     [spread(constant, alive, 0) for constant in constants],
                     spread(added, alive, 0), noises)


def spread(values, alive, axis):
    """Expand an axis to all nine errors, with zeros for those that are not propagated."""
    shape = list(values.shape)
    shape[axis] = GROWING
    found = np.zeros(shape)
    np.moveaxis(found, axis, 0)[alive] = np.moveaxis(values, axis, 0)
    return found


def _coefficients(middle, f_n, spin, damping):
    """Return F (9, 9, n) at the middle of a step."""
    lat, height, v, c = middle
    rows = inertial_rows(lat, height, v, c, f_n, spin)
    f = np.zeros((GROWING, GROWING, len(lat)))
    for i, row in enumerate(rows):
        for k, value in enumerate(row[:GROWING]):
            f[i, k] = value
    f[2, 2] -= damping[0]
    f[5, 2] -= damping[1]
    return f
