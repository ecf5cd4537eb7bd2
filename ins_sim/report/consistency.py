"""What a consistent filter would show: intervals of chi-square."""

import math

import numpy as np
from scipy.stats import chi2

# probability that a Gaussian lies within three standard deviations
THREE_SIGMA = math.erf(3.0 / math.sqrt(2.0))


def mean_interval(count, freedom, probability=0.95):
    """Return the interval of the mean of count chi-squares of so many degrees of freedom."""
    tail = 0.5 * (1.0 - probability)
    return tuple(float(chi2.ppf(p, freedom * count) / count) for p in (tail, 1.0 - tail))


def sum_intervals(sums, probability=0.95):
    """
    Return the bounds (low, high) of the means of ChiSquareSums, arrays; NaN where there is no run.

    A consistent filter lies inside with that probability, at each instant by itself.
    """
    tail, none = 0.5 * (1.0 - probability), sums.count == 0
    freedom, count = np.where(none, np.nan, sums.freedom), np.where(none, np.nan, sums.count)
    return chi2.ppf(tail, freedom) / count, chi2.ppf(1.0 - tail, freedom) / count


def chi_square_limit(freedom, probability):
    """Return what a chi-square of so many degrees of freedom exceeds with a probability."""
    return float(chi2.isf(probability, freedom))
