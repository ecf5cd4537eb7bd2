"""
Allan deviation of a record and the noise coefficients fitted to it.

The estimate is the overlapping Allan deviation, the model that of IEEE Std 952:

    variance(tau) = 3 Q^2/tau^2 + N^2/tau + (2 ln 2/pi) B^2 + K^2 tau/3

Q quantisation, N angle (velocity) random walk, B bias instability, K rate random walk; for a
record of U (rad/s, m/s^2 or any other) they are in U s, U sqrt(s), U and U/sqrt(s).
"""

from dataclasses import dataclass
import math

import numpy as np
from scipy.optimize import least_squares, nnls

from ins_sim.core.numerics.allan_deviation import overlapping_deviation

PER_DECADE = 8
# The longest tau leaves this many intervals in the record.
FEWEST = 4
LEAST = 10 * FEWEST
# A coefficient is observable if, at some tau, its part of the Allan variance is at least SEEN, and
# at least SIGMAS standard deviations of the estimated variance.
SEEN, SIGMAS = 0.05, 2.0


@dataclass(frozen=True)
class Allan:
    """Allan deviations: tau_s (m,), s; deviation (m, channels); length_s of the record."""

    tau_s: np.ndarray
    deviation: np.ndarray
    length_s: float

    def relative_sigma(self):
        """
        Return the relative standard deviation of the variance of one channel at each tau (m,).

        sqrt(tau/T) of a record of length T (IEEE Std 952, C.1.2, to a factor of the overlap).
        """
        return np.sqrt(self.tau_s / self.length_s)

    def channels(self, which):
        """Return the Allan of some channels, by number."""
        return Allan(self.tau_s, self.deviation[:, which], self.length_s)


@dataclass(frozen=True)
class Coefficients:
    """Noise coefficients of one channel, or of several alike channels together."""

    quantisation: float
    random_walk: float
    instability: float
    rate_random_walk: float

    def deviation(self, tau_s):
        """Return the Allan deviation of the model at tau_s, s."""
        return np.sqrt(np.sum(self.parts(tau_s) ** 2, axis=-1))

    def parts(self, tau_s):
        """Return the Allan deviation of each coefficient alone, (..., 4) in the order above."""
        return np.sqrt(_terms(np.asarray(tau_s, dtype=float))) * (
            self.quantisation, self.random_walk, self.instability, self.rate_random_walk)

    def seen(self, allan):
        """
        Return which coefficients (in the order above) are observable in the fitted data.

        The mean variance of several channels has the relative standard deviation of one over the
        root of their number.
        """
        squares = self.parts(allan.tau_s) ** 2
        doubt = allan.relative_sigma() / math.sqrt(allan.deviation.shape[-1])
        least = np.maximum(SEEN, SIGMAS * doubt)[:, None] * squares.sum(axis=-1, keepdims=True)
        return ((squares >= least) & (squares > 0.0)).any(axis=0)


def _terms(tau):
    return np.stack([3.0 / tau ** 2, 1.0 / tau, np.full_like(tau, 2.0 * math.log(2.0) / math.pi),
                     tau / 3.0], axis=-1)


def estimate_deviation(samples, rate_hz):
    """
    Return the Allan deviation of samples (n,) or (n, channels) at ``rate_hz``.

    Raises ValueError if the record is too short or not finite.
    """
    samples = np.asarray(samples, dtype=float)
    samples = samples.reshape(len(samples), -1)
    if len(samples) < LEAST:
        raise ValueError(f'the record has {len(samples)} samples; expected at least '
                         f'{LEAST}')
    if not np.isfinite(samples).all():
        raise ValueError('the record holds NaN or infinity; expected finite samples')
    most = len(samples) // FEWEST
    factors = np.unique(np.round(
        np.geomspace(1, most, round(PER_DECADE * math.log10(most)) + 1)).astype(int))
    deviations = [overlapping_deviation(channel, factors) for channel in samples.T]
    return Allan(factors / rate_hz, np.stack(deviations, axis=-1), len(samples) / rate_hz)


def fit_coefficients(allan, known=0.0):
    """
    Return the Coefficients that fit the mean Allan variance of all channels best.

    The logarithm of the variance is fitted by least squares, weighted by the number of intervals
    of length tau in the record; no coefficient is negative. ``known`` (m,) is the Allan variance
    of other known contributions at each tau, such as ``gauss_markov_variance``.
    """
    tau, variance = allan.tau_s, np.mean(allan.deviation ** 2, axis=-1)
    if not variance.all():
        raise ValueError('the record is constant over an interval; expected noise to fit')
    terms = _terms(tau)
    weight = np.sqrt(allan.length_s / tau)
    start, _ = nnls(terms * (weight / variance)[:, None],
                    np.maximum(1.0 - known / variance, 0.0) * weight)
    # The fit uses logarithms of the coefficients, so start from at least a hundredth of the curve.
    unit = np.maximum(start, 0.01 * np.min(variance[:, None] / terms, axis=0))

    def residuals(x):
        return weight * np.log((terms @ (unit * x) + known) / variance)

    best = least_squares(residuals, np.maximum(start / unit, 0.1), bounds=(0.0, np.inf)).x
    return Coefficients(*np.sqrt(unit * best).tolist())


def gauss_markov_variance(tau_s, sigma, time_s):
    """Return the Allan variance of a Gauss-Markov process at tau_s (IEEE Std 952, C.1.1.4)."""
    tau_s = np.asarray(tau_s, dtype=float)
    if sigma == 0.0 or math.isinf(time_s):
        return np.zeros_like(tau_s)
    r = tau_s / time_s
    # For small r the bracket 3 - 4 exp(-r) + exp(-2 r) loses digits, so use its expansion.
    bracket = np.where(r < 1e-3, r * r * (1.0 / 3.0 - r / 4.0),
                       1.0 - (4.0 * -np.expm1(-r) + np.expm1(-2.0 * r)) / (2.0 * r))
    return 2.0 * sigma ** 2 / r * bracket
