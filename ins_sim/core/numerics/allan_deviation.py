"""Overlapping Allan deviation of a regularly sampled record."""

import numpy as np


def overlapping_deviation(samples, factors):
    """
    Return the overlapping Allan deviation of a record at several averaging times.

    Source: W. J. Riley, Handbook of Frequency Stability Analysis, NIST Special Publication 1065
    (2008), eq. 11.

    Parameters
    ----------
    samples : array (n,), any unit
    factors : sequence of integers (m,)
        Averaging times in sampling intervals, each at least 1 and at most n // 2.

    Returns
    -------
    array (m,), in the unit of the samples
    """
    # Subtracting the mean does not change the result but keeps the sums small and accurate.
    integral = np.concatenate([[0.0], np.cumsum(samples - np.mean(samples))])
    deviation = np.empty(len(factors))
    # One buffer for all differences: allocating memory would take longer than the arithmetic.
    memory = np.empty(len(integral))
    for k, m in enumerate(factors):
        difference = memory[2 * m:]
        np.multiply(integral[m:-m], -2.0, out=difference)
        difference += integral[2 * m:]
        difference += integral[:-2 * m]
        np.square(difference, out=difference)
        deviation[k] = np.sqrt(np.mean(difference) / 2.0) / m
    return deviation
