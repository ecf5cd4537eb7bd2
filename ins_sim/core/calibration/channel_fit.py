"""The least-squares solution for a gyro channel from the sums of one or several records."""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.numerics.fixed_order import applied, dot, product, solve, total
from .channel_sums import BIAS, BLOCKS, COLUMNS, DELAY, SCALE

# A-priori standard deviations: of scale factor, asymmetry and misalignments, and of a delay, s;
# the latter only keeps the equations regular.
PRIOR, PRIOR_DELAY = 1e-3, 1.0
# Noise assumed for readings without noise, from rounding, rad/s.
LEAST_NOISE = 1e-13
# 99.9 % point of the standard normal distribution.
ONE_IN_A_THOUSAND = 3.0902


@dataclass(frozen=True, eq=False)
class ChannelFit:
    """
    The solution for one channel.

    Attributes
    ----------
    values : (m,) delay minus that of the linearisation (s), scale factor, misalignments towards
        the next two axes (rad), asymmetry of the scale factor, and bias in each record (rad/s)
    covariance : (m, m) covariance of the values for the assumed noise
    scattered : (m, m) the same from the scatter of the residuals over the blocks
    information : (m, m) information of the readings alone
    prior : (m,) a-priori information, 1 / sigma^2
    ratio : variance of the delay from the residuals divided by that from the noise
    blocks : number of blocks from which ``ratio`` is computed
    """

    values: np.ndarray
    covariance: np.ndarray
    scattered: np.ndarray
    information: np.ndarray
    prior: np.ndarray
    ratio: float
    blocks: int

    @property
    def delay_sigma(self):
        """Standard deviation of the delay for the assumed noise, s."""
        return math.sqrt(self.covariance[DELAY, DELAY])

    @property
    def told_by_prior(self):
        """Fraction (0 to 1) of the delay's variance due to the priors of the other errors."""
        row, others = self.covariance[DELAY], slice(SCALE, BIAS)
        known = dot(row[others] * row[others], self.prior[others])
        return float(known / row[DELAY])

    @property
    def limit(self):
        """Value that ``ratio`` exceeds once in a thousand times if the noise is as assumed."""
        # Wilson and Hilferty (1931): the cube root of a chi-square variable is nearly normal.
        part = 2.0 / (9.0 * self.blocks)
        root = 1.0 - part + ONE_IN_A_THOUSAND * math.sqrt(part)
        return root * root * root


def prior_of(records):
    """Return the a-priori information, (5 + records,)."""
    prior = np.zeros(BIAS + records)
    prior[DELAY] = 1.0 / (PRIOR_DELAY * PRIOR_DELAY)
    prior[SCALE:BIAS] = 1.0 / (PRIOR * PRIOR)
    return prior


def information_of(sums, noise):
    """
    Return the information matrix (m, m) of several records.

    Parameters
    ----------
    sums : ChannelSums of each record
    noise : standard deviation of a sample in each record, rad/s
    """
    found = np.zeros((BIAS + len(sums), BIAS + len(sums)))
    for k, (one, sigma) in enumerate(zip(sums, noise)):
        at = _places(k)
        found[np.ix_(at, at)] += np.add.reduce(one.normal, axis=0) / (sigma * sigma)
    return found


def covariance_of(information):
    """Return the inverse of a symmetric information matrix, scaled to a diagonal of ones."""
    scale = 1.0 / np.sqrt(np.diagonal(information))
    inverse = solve(information * scale * scale[:, None], np.eye(len(information)))
    return 0.5 * (inverse + inverse.T) * scale * scale[:, None]


def fit_channel(sums, noise):
    """
    Return the ChannelFit from the ChannelSums of each record.

    Parameters
    ----------
    sums : ChannelSums of each record
    noise : (records,) standard deviation of a sample in each record, rad/s
    """
    prior, information = prior_of(len(sums)), information_of(sums, noise)
    right = np.zeros(len(prior))
    for k, (one, sigma) in enumerate(zip(sums, noise)):
        right[_places(k)] += np.add.reduce(one.right, axis=0) / (sigma * sigma)
    covariance = covariance_of(information + np.diag(prior))
    values = applied(covariance, right)
    scores = np.zeros((len(sums) * BLOCKS, len(prior)))
    for k, (one, sigma) in enumerate(zip(sums, noise)):
        for block in range(BLOCKS):
            scores[k * BLOCKS + block, _places(k)] = (
                one.right[block] - applied(one.normal[block], values[_places(k)])
            ) / (sigma * sigma)
    spread = product(scores.T, scores)
    scattered = _between(covariance, spread + np.diag(prior))
    by_noise = _between(covariance, information)[DELAY, DELAY]
    ratio = _between(covariance, spread)[DELAY, DELAY] / by_noise if by_noise else 0.0
    return ChannelFit(values, covariance, scattered, information, prior, float(ratio), len(scores))


def residual_noise(sums, values):
    """Return the rms of the residuals of the ChannelSums of each record, (records,) rad/s."""
    found = []
    for k, one in enumerate(sums):
        x = values[_places(k)]
        left = (total(one.square.tolist())
                - 2.0 * dot(x, np.add.reduce(one.right, axis=0))
                + dot(x, applied(np.add.reduce(one.normal, axis=0), x)))
        count = int(one.count.sum(axis=0))
        found.append(max(LEAST_NOISE, math.sqrt(max(left, 0.0) / count)))
    return np.array(found)


def fit_by_residuals(sums):
    """Return the ChannelFit weighted by its own residuals, and that noise (records,), rad/s."""
    # The first weights treat the readings as pure noise: they are too low, which is harmless.
    noise = residual_noise(sums, np.zeros(BIAS + len(sums)))
    for _ in range(4):
        found = fit_channel(sums, noise)
        noise = residual_noise(sums, found.values)
    return fit_channel(sums, noise), noise


def _between(covariance, middle):
    return product(covariance, product(middle, covariance))


def _places(record):
    """Return the indices of the columns of a record among the values."""
    return [*range(COLUMNS - 1), BIAS + record]
