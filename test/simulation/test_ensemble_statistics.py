"""Running moments and percentiles equal those of all samples together."""

from ins_sim.core.ensemble.statistics import ErrorStatistics
import numpy as np
import pytest


def streamed(samples, cuts):
    """Return the ErrorStatistics of samples (m, runs, n) in groups."""
    found = ErrorStatistics(samples.shape[0], samples.shape[2])
    for first, end in zip([0, *cuts], [*cuts, samples.shape[1]]):
        found.add(0, samples[:, first:end])
    return found


@pytest.mark.parametrize('cuts', [[], [1], [16, 32, 33, 90], [0, 99]])
def test_moments_and_percentiles(cuts):
    """
    Means and covariances agree to rounding, percentiles to the width of a bin.

    This holds for any groups of samples.
    """
    rng = np.random.default_rng(7)
    samples = 1e3 + rng.normal(size=(2, 100, 3)) * [1.0, 50.0, 2000.0]
    found = streamed(samples, cuts)
    assert found.count.tolist() == [100, 100]
    np.testing.assert_allclose(found.mean, samples.mean(axis=1), rtol=1e-13)
    for k in range(2):
        np.testing.assert_allclose(found.covariance[k], np.cov(samples[k].T), rtol=1e-11)
    for percent in (5.0, 50.0, 95.0):
        exact = np.percentile(samples, percent, axis=1, method='inverted_cdf')
        # Bins divide a power of two into 32 parts.
        np.testing.assert_allclose(found.percentile(percent), exact, rtol=1.0 / 32.0)


def test_what_is_not_finite_is_left_out():
    """A run with NaN or infinity is excluded, without a warning."""
    samples = np.random.default_rng(8).normal(size=(2, 9, 3))
    broken = np.concatenate([samples, samples[:, :2]], axis=1)
    broken[:, 9, 1], broken[:, 10, 0] = np.nan, np.inf
    kept, all_of = streamed(broken, [5]), streamed(samples, [5])
    for one, other in zip(kept.moments, all_of.moments):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(kept.histogram, all_of.histogram)


def test_too_few_runs():
    """Without runs there are no percentiles, and with a single run no covariance."""
    found = ErrorStatistics(1, 2)
    assert np.isnan(found.percentile(50.0)).all()
    found.add(0, np.ones((1, 1, 2)))
    assert np.isnan(found.covariance).all() and found.mean.tolist() == [[1.0, 1.0]]
    assert abs(found.percentile(50.0) - 1.0).max() <= 1.0 / 32.0
