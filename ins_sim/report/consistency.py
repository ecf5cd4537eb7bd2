"""Chi-square intervals in which NEES and NIS of a consistent filter lie."""

import math

import numpy as np
from scipy.stats import chi2

# Probability that a Gaussian variable lies within three standard deviations.
THREE_SIGMA = math.erf(3.0 / math.sqrt(2.0))


def mean_interval(count, freedom, probability=0.95):
    """Return the interval of the mean of ``count`` chi-square variables with ``freedom``."""
    tail = 0.5 * (1.0 - probability)
    return tuple(float(chi2.ppf(p, freedom * count) / count) for p in (tail, 1.0 - tail))


def sum_intervals(sums, probability=0.95):
    """
    Return bounds (low, high) of the means of ChiSquareSums, arrays; NaN at instants without runs.

    At each single instant, a consistent filter is inside with the given probability.
    """
    tail, none = 0.5 * (1.0 - probability), sums.count == 0
    freedom, count = np.where(none, np.nan, sums.freedom), np.where(none, np.nan, sums.count)
    return chi2.ppf(tail, freedom) / count, chi2.ppf(1.0 - tail, freedom) / count


def chi_square_limit(freedom, probability):
    """Return the value that a chi-square variable exceeds with the given probability."""
    return float(chi2.isf(probability, freedom))
