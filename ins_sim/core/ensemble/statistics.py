"""
Running statistics of errors: count, mean, co-moments, and histograms for percentiles.

Runs come in groups. The moments of each group are merged in the order of the groups (Chan, Golub
and LeVeque, "Updating Formulae and a Pairwise Algorithm for Computing Sample Variances", 1979), so
the last bits do not depend on which group is finished first. Within a group, sums are accumulated
in the order of the runs.
"""

from typing import NamedTuple

import numpy as np

# Bins of a histogram: one for magnitudes below 2^LEAST; for either sign, PARTS for each power of
# two from 2^LEAST to 2^GREATEST, and one above.
LEAST, GREATEST, PARTS = -60, 40, 32
EDGES = np.concatenate([np.ldexp(1.0 + np.arange(PARTS) / PARTS, e)
                        for e in range(LEAST, GREATEST + 1)])
SIGNED_EDGES = np.concatenate([-EDGES[::-1], EDGES])


class Moments(NamedTuple):
    """
    Moments of n quantities at m instants.

    Attributes
    ----------
    count : (m,) number of samples
    mean : (m, n)
    comoment : (m, n, n) sums of products of deviations from the mean
    """

    count: np.ndarray
    mean: np.ndarray
    comoment: np.ndarray


def moments_of(samples):
    """Return the Moments of samples (m, runs, n); samples with NaN or infinity are left out."""
    instants, runs, width = samples.shape
    valid = np.isfinite(samples).all(axis=2)
    count, total = np.zeros(instants, dtype=np.int64), np.zeros((instants, width))
    for k in range(runs):
        count += valid[:, k]
        total += np.where(valid[:, k, None], samples[:, k], 0.0)
    mean = total / np.maximum(count, 1)[:, None]
    comoment = np.zeros((instants, width, width))
    for k in range(runs):
        off = np.where(valid[:, k, None], samples[:, k] - mean, 0.0)
        comoment += off[:, :, None] * off[:, None, :]
    return Moments(count, mean, comoment)


def merged(a, b):
    """Return the Moments of the union of two sets of samples, given the Moments of each."""
    count = a.count + b.count
    per = 1.0 / np.maximum(count, 1)
    off = b.mean - a.mean
    mean = a.mean + off * (b.count * per)[:, None]
    weight = a.count * (b.count * per)
    between = off[:, :, None] * off[:, None, :] * weight[:, None, None]
    comoment = (a.comoment + b.comoment) + between
    return Moments(count, mean, comoment)


def bins_of(samples):
    """Return the indices of the bins of finite samples; the index for NaN is meaningless."""
    return np.searchsorted(SIGNED_EDGES, samples, side='right')


class ErrorStatistics:
    """
    Statistics of n quantities at m instants over runs.

    Attributes
    ----------
    moments : Moments over all runs
    histogram : (m, n, bins) numbers of runs; bin k counts the values x with
        SIGNED_EDGES[k - 1] <= x < SIGNED_EDGES[k]

    """

    def __init__(self, instants, width):
        self.moments = Moments(np.zeros(instants, dtype=np.int64), np.zeros((instants, width)),
                               np.zeros((instants, width, width)))
        self.histogram = np.zeros((instants, width, len(SIGNED_EDGES) + 1), dtype=np.int32)

    def add(self, first, samples):
        """Add samples (m, runs, n) at m instants beginning with index ``first``."""
        part = slice(first, first + len(samples))
        found = merged(Moments(*(a[part] for a in self.moments)), moments_of(samples))
        for whole, new in zip(self.moments, found):
            whole[part] = new
        valid = np.isfinite(samples).all(axis=2)
        instant, run = np.nonzero(valid)
        bins = bins_of(samples[instant, run])
        np.add.at(self.histogram, ((first + instant)[:, None], np.arange(samples.shape[2]), bins),
                  1)

    def first(self, instants):
        """Return the statistics of the first ``instants`` instants."""
        part = ErrorStatistics(0, self.mean.shape[1])
        part.moments = Moments(*(a[:instants] for a in self.moments))
        part.histogram = self.histogram[:instants]
        return part

    def joined(self, other):
        """Return the statistics of the runs of both; the runs of other come after these."""
        both = ErrorStatistics(0, self.mean.shape[1])
        both.moments = merged(self.moments, other.moments)
        both.histogram = self.histogram + other.histogram
        return both

    def arrays(self, name):
        """Return a dictionary {name_...: array}, with only the non-empty bins of the histogram."""
        filled = np.flatnonzero(self.histogram)
        return {f'{name}_count': self.moments.count, f'{name}_mean': self.moments.mean,
                f'{name}_comoment': self.moments.comoment, f'{name}_bins': filled,
                f'{name}_in_bins': self.histogram.ravel()[filled]}

    @classmethod
    def of_arrays(cls, arrays, name):
        """Return the statistics from a dictionary that the method ``arrays`` has made."""
        made = cls(*arrays[f'{name}_mean'].shape)
        made.moments = Moments(*(arrays[f'{name}_{part}'] for part in Moments._fields))
        made.histogram.ravel()[arrays[f'{name}_bins']] = arrays[f'{name}_in_bins']
        return made

    @property
    def count(self):
        """Return the number of runs at each instant, (m,)."""
        return self.moments.count

    @property
    def mean(self):
        """Return the means (m, n)."""
        return self.moments.mean

    @property
    def covariance(self):
        """Return the covariances (m, n, n), divisor count - 1; NaN for fewer than two runs."""
        less = np.where(self.count > 1, self.count - 1.0, np.nan)
        return self.moments.comoment / less[:, None, None]

    @property
    def rms(self):
        """Return the root mean squares (m, n); NaN if there are no runs."""
        diagonal = np.diagonal(self.moments.comoment, axis1=1, axis2=2)
        with np.errstate(invalid='ignore', divide='ignore'):
            return np.sqrt(diagonal / self.count[:, None] + self.mean * self.mean)

    @property
    def sigma(self):
        """Return standard deviations (m, n), divisor count - 1; NaN for fewer than two runs."""
        return np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2))

    def percentile(self, percent):
        """
        Return the values (m, n) below which the given percentage of the runs lies.

        The value is interpolated within a bin, so its error is at most the width of a bin, 1/32 of
        the value. The bin around zero gives zero.
        """
        below = np.cumsum(self.histogram, axis=2)
        wanted = 0.01 * percent * self.count[:, None]
        found = np.full(self.mean.shape, np.nan)
        for i, j in np.ndindex(*found.shape):
            if self.count[i]:
                k = int(np.searchsorted(below[i, j], wanted[i, 0]))
                inside = self.histogram[i, j, k]
                low, high = SIGNED_EDGES[[max(k - 1, 0), min(k, len(SIGNED_EDGES) - 1)]]
                part = (wanted[i, 0] - (below[i, j, k] - inside)) / max(inside, 1)
                found[i, j] = low + part * (high - low) if low != -high else 0.0
        return found
