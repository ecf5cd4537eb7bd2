"""Random numbers are functions of (seed, run, name) and index, with the right distribution."""

import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest
from scipy.stats import chi2, kstest

from ins_sim.core.numerics.compilation import plain_only
from ins_sim.core.numerics.noise import BLOCK, indexed_noise
from ins_sim.core.numerics.processes import LEVELS, Processes

QUANTILE = 1e-6


def within_chi2(sum_of_squares, freedom):
    """Return whether a sum of squares of standard normals is between the outer quantiles."""
    return chi2.ppf(QUANTILE, freedom) < sum_of_squares < chi2.isf(QUANTILE, freedom)


@settings(max_examples=40, deadline=None)
@given(indices=st.lists(st.integers(0, 2 ** 50), min_size=1, max_size=30))
def test_a_number_depends_on_its_index_alone(indices):
    """A number depends on its index only: in any order, single or in ranges, same bits."""
    one = indexed_noise(3, 1, 'a')
    got = [(one.normal(k), one.uniform(k)) for k in indices]
    for k, (normal, uniform) in zip(indices, got):
        fresh = indexed_noise(3, 1, 'a')
        assert fresh.uniform(k) == uniform and fresh.normal(k) == normal
        assert fresh.normals(k, 300)[0] == normal and fresh.uniforms(k, 2)[0] == uniform
        assert 0.0 <= uniform < 1.0


def test_streams_are_normal_and_independent():
    """Streams pass Kolmogorov-Smirnov at 1e-6; 20 of them correlate by less than 4/sqrt(n)."""
    n = 20000
    names = [(0, 0, 'gyro.white'), (1, 0, 'gyro.white'), (0, 1, 'gyro.white'),
             (0, 0, 'accelerometer.white')] + [(5, run, 'x') for run in range(16)]
    draws = np.array([indexed_noise(*name).normals(0, n) for name in names])
    assert min(kstest(x, 'norm').pvalue for x in draws) > QUANTILE
    between = np.abs(np.corrcoef(draws)[np.triu_indices(len(names), 1)]).max()
    lags = max(abs(np.mean(x[k:] * x[:-k])) for x in draws for k in (1, 2, 3, BLOCK))
    kinds = abs(np.corrcoef(draws[0], indexed_noise(*names[0]).uniforms(0, n))[0, 1])
    print(f'largest correlation between streams {between:.4f}, in one {lags:.4f}, normals with '
          f'uniforms {kinds:.4f}; bound {4 / math.sqrt(n):.4f}')
    assert max(between, lags, kinds) < 4.0 / math.sqrt(n)


def test_a_negative_index_is_refused():
    """A negative index is refused with a message that names it."""
    with pytest.raises(ValueError, match='expected an index >= 0'):
        indexed_noise(0, 0, 'a').normal(-1)


@settings(max_examples=25, deadline=None)
@given(first=st.integers(0, 10 ** 9), count=st.integers(1, 700), cut=st.integers(1, 699))
def test_processes_do_not_depend_on_what_was_asked(first, count, cut):
    """A distant range of a process has the same bits in one part, in two, or from a new object."""
    made = [Processes(1, 0, 'p', (1.0, 2.0), (50.0, math.inf), 0.01) for _ in range(2)]
    whole = made[0].values(first, count)
    cut = min(cut, count)
    parts = [made[1].values(first, cut)]
    if cut < count:
        parts.insert(0, made[1].values(first + cut, count - cut))
        parts = parts[::-1]
    assert np.array_equal(np.concatenate(parts), whole)


@pytest.mark.parametrize('first', [0, 70000, 2 ** (LEVELS - 1) - 100])
def test_gauss_markov_is_stationary_and_exact(first):
    """
    A Gauss-Markov process has variance sigma^2 at every index; x_{k+d} - rho x_k is white.

    The variance of x_{k+d} - rho x_k is sigma^2 (1 - rho^2).
    """
    dt, time, sigma, columns = 0.1, 30.0, 2.0, 400
    process = Processes(9, 0, 'gm', (sigma,) * columns, (time,) * columns, dt)
    x = process.values(first, 1200) / sigma
    for k in (0, 1, 255, 256, 257, 1199):
        assert within_chi2((x[k] ** 2).sum(), columns)
    for d in (1, 7, 256, 300):
        rho = math.exp(-d * dt / time)
        rest = (x[d:] - rho * x[:-d])[::d] / math.sqrt(1.0 - rho * rho)
        assert within_chi2((rest ** 2).sum(), rest.size)
        for other in (rest[1:] * rest[:-1], rest * x[:-d][::d]):
            assert abs(other.mean()) < 5.0 / math.sqrt(other.size)


def test_infinite_correlation_time_is_a_random_walk_from_zero():
    """Increments of a random walk over d samples are independent, with variance sigma^2 d dt."""
    dt, columns = 0.1, 300
    walk = Processes(9, 0, 'walk', (3.0,) * columns, (math.inf,) * columns, dt)
    x = walk.values(0, 2000) / 3.0
    assert not x[0].any()
    assert within_chi2((x[1700] ** 2).sum() / (1700 * dt), columns)
    for d in (1, 10, 256):
        step = np.diff(x[::d], axis=0) / math.sqrt(d * dt)
        assert within_chi2((step ** 2).sum(), step.size)
        assert abs((step[1:] * step[:-1]).mean()) < 5.0 / math.sqrt(step[1:].size)


@pytest.mark.parametrize('first, count', [(0, 20000), (5 * BLOCK - 3, 9001), (10 ** 9, 12345)])
def test_processes_in_plain_python_and_compiled(first, count):
    """Array operations and compiled loops bisect processes to the same bits."""
    def values():
        return Processes(7, 3, 'x', [1.0, 2.0, 0.5], [10.0, math.inf, 300.0], 0.01).values(
            first, count)

    with plain_only():
        plain = values()
    np.testing.assert_array_equal(values(), plain)
