"""
Allan deviation of a record, the noise coefficients fitted to it, and the figure.

The estimate is that of allantools (overlapping Allan deviation), the model that of IEEE Std 952:

    variance(tau) = 3 Q^2/tau^2 + N^2/tau + (2 ln 2/pi) B^2 + K^2 tau/3

Q quantisation, N angle (velocity) random walk, B bias instability, K rate random walk; for a
record of U (rad/s, m/s^2 or any other) they are in U s, U sqrt(s), U and U/sqrt(s).
"""

from dataclasses import dataclass
import math

import numpy as np
from scipy.optimize import least_squares, nnls

PER_DECADE = 8
# The longest tau leaves this many intervals in the record.
FEWEST = 4


@dataclass(frozen=True)
class Allan:
    """Allan deviations: tau_s (m,), s; deviation (m, channels); length_s of the record."""

    tau_s: np.ndarray
    deviation: np.ndarray
    length_s: float


@dataclass(frozen=True)
class Coefficients:
    """Noise coefficients of one channel, or of several alike channels together."""

    quantisation: float
    random_walk: float
    instability: float
    rate_random_walk: float

    def deviation(self, tau_s):
        """Return the Allan deviation of the model at tau_s, s."""
        squares = np.square([self.quantisation, self.random_walk, self.instability,
                             self.rate_random_walk])
        return np.sqrt(_terms(np.asarray(tau_s, dtype=float)) @ squares)


def _terms(tau):
    return np.stack([3.0 / tau ** 2, 1.0 / tau, np.full_like(tau, 2.0 * math.log(2.0) / math.pi),
                     tau / 3.0], axis=-1)


def estimate(samples, rate_hz):
    """
    Return the Allan deviation of samples (n,) or (n, channels), taken at rate_hz.

    Raises ValueError where the record is too short or not finite, and ImportError, naming the
    package to install, where allantools is missing.
    """
    try:
        import allantools
    except ImportError as error:
        raise ImportError('the Allan deviation needs the package allantools; expected '
                          '"pip install allantools"') from error
    samples = np.asarray(samples, dtype=float)
    samples = samples.reshape(len(samples), -1)
    if len(samples) < 10 * FEWEST:
        raise ValueError(f'the record has {len(samples)} samples; expected at least '
                         f'{10 * FEWEST}')
    if not np.isfinite(samples).all():
        raise ValueError('the record holds NaN or infinity; expected finite samples')
    most = len(samples) // FEWEST
    wanted = np.unique(np.round(np.geomspace(1, most, round(PER_DECADE * math.log10(most)) + 1)))
    deviations = []
    for channel in samples.T:
        tau_s, deviation, _, _ = allantools.oadev(channel - channel.mean(), rate=rate_hz,
                                                  data_type='freq', taus=wanted / rate_hz)
        deviations.append(deviation)
    return Allan(tau_s, np.stack(deviations, axis=-1), len(samples) / rate_hz)


def fit(allan, gauss_markov=(0.0, math.inf)):
    """
    Return the Coefficients that fit the mean Allan variance of all channels best.

    Least squares of the logarithm of the variance, weighted by the number of intervals of length
    tau in the record, all coefficients not negative.  gauss_markov: standard deviation and
    correlation time, s, of a Gauss-Markov process known to be there besides.
    """
    tau, variance = allan.tau_s, np.mean(allan.deviation ** 2, axis=-1)
    if not variance.all():
        raise ValueError('the record is constant over an interval; expected noise to fit')
    known = gauss_markov_variance(tau, *gauss_markov)
    terms = _terms(tau)
    weight = np.sqrt(allan.length_s / tau)
    start, _ = nnls(terms * (weight / variance)[:, None],
                    np.maximum(1.0 - known / variance, 0.0) * weight)
    # a coefficient at zero has no logarithm to start from: begin with a hundredth of the curve
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
    # 3 - 4 exp(-r) + exp(-2 r) loses its digits where r is small: 2 r - 2 r^3/3 + r^4/2 there
    bracket = np.where(r < 1e-3, r * r * (1.0 / 3.0 - r / 4.0),
                       1.0 - (4.0 * -np.expm1(-r) + np.expm1(-2.0 * r)) / (2.0 * r))
    return 2.0 * sigma ** 2 / r * bracket


def save_figure(path, title, allan, unit, labels=(), coefficients=None):
    """Save the Allan deviations as PNG; unit: text of the unit; coefficients: their fit."""
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 6), layout='constrained')
    axes = figure.subplots()
    for k, channel in enumerate(allan.deviation.T):
        axes.loglog(allan.tau_s, channel, '.-', ms=4, lw=0.8,
                    label=labels[k] if k < len(labels) else f'channel {k}')
    if coefficients is not None:
        c = coefficients
        axes.loglog(allan.tau_s, c.deviation(allan.tau_s), 'k--', lw=1.2,
                    label=f'N {c.random_walk:.3g}, B {c.instability:.3g}, '
                          f'K {c.rate_random_walk:.3g}')
    axes.set_xlabel('tau [s]')
    axes.set_ylabel(f'Allan deviation [{unit}]')
    axes.grid(which='both', alpha=0.3)
    axes.legend(fontsize='small')
    axes.set_title(title)
    figure.savefig(path, dpi=110)
