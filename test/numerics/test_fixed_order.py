"""Small matrices in a fixed order against SciPy, mpmath and their definitions."""

import mpmath
import numpy as np
import pytest
import scipy.linalg

from ins_sim.core.numerics.fixed_order import balance, exponential, magnitude, product, solve


def draws(count, size=1.0):
    """Yield pairs of random square matrices of 1 to 7 rows, real and complex in turn."""
    rng = np.random.default_rng(4)
    for k in range(count):
        n = int(rng.integers(1, 8))
        parts = rng.normal(size=(4, n, n)) * size
        yield (parts[0], parts[1]) if k % 2 else (parts[0] + 1j * parts[2],
                                                  parts[1] + 1j * parts[3])


def test_products():
    """To rounding; one of both may be real, and they need not be square."""
    for a, b in draws(40):
        for left, right in ((a, b), (a.real, b), (a, b[:, :1].real), (a[:1], b)):
            np.testing.assert_allclose(product(left, right), left @ right, rtol=0, atol=1e-14)


def test_sums_are_taken_in_the_order_of_the_indices():
    """Bit for bit those of a loop over floats."""
    for a, b in draws(20):
        expected = [[complex(*_one(row, column)) for column in b.T.tolist()]
                    for row in a.tolist()]
        assert np.array_equal(product(a, b), expected)


def _one(row, column):
    """Return the sums of the four products of real parts."""
    sums = [0.0] * 4
    for k, (p, q) in enumerate(zip(row, column)):
        p, q = complex(p), complex(q)
        four = p.real * q.real, p.imag * q.imag, p.real * q.imag, p.imag * q.real
        sums = [s + f for s, f in zip(sums, four)] if k else list(four)
    return sums[0] - sums[1], sums[2] + sums[3]


def test_solutions():
    """Of vectors and matrices; a zero on the diagonal is not taken as pivot."""
    for a, b in draws(40):
        for right in (b, b[:, 0]):
            residual = np.abs(a @ solve(a, right) - right).max()
            assert residual <= 1e-13 * np.abs(a).max() * np.abs(solve(a, right)).max() + 1e-13
    assert solve(np.array(((0.0, 2.0), (4.0, 0.0))), np.array((2.0, 4.0))).tolist() == [1.0, 1.0]


@pytest.mark.parametrize('size', [1e-3, 0.1, 1.0, 5.0, 20.0])
def test_exponentials_against_mpmath(size):
    """
    Within 2e-15 times the norm of the matrix: each halving doubles the rounding errors.

    Relative to the largest element, or to 1 where all are smaller.
    """
    worst = scipy_worst = 0.0
    with mpmath.workdps(60):
        for a, _ in draws(12, size):
            expected = np.array(mpmath.expm(mpmath.matrix(a.tolist()), 'taylor').tolist(),
                                dtype=complex)
            unit = 1.0 + magnitude(a).sum(axis=1).max()
            unit *= max(1.0, magnitude(expected).max())
            worst = max(worst, magnitude(exponential(a) - expected).max() / unit)
            scipy_worst = max(scipy_worst,
                              magnitude(scipy.linalg.expm(a) - expected).max() / unit)
    print(f'\nsize {size}: off by {worst:.1e}, SciPy by {scipy_worst:.1e}')
    assert worst <= 2e-15


def test_balance():
    """Powers of two, after which no row differs much from its column."""
    a = np.array(((1.0, 1e6, 0.0), (1e-7, 2.0, 1e-3), (0.0, 1e4, 3.0)))
    scale = balance(a)
    assert np.array_equal(np.frexp(scale)[0], [0.5] * 3)
    off = np.abs(a * scale / scale[:, None])
    np.fill_diagonal(off, 0.0)
    ratio = off.sum(axis=0) / off.sum(axis=1)
    assert (ratio > 0.2).all() and (ratio < 5.0).all()
    assert balance(np.zeros((2, 2))).tolist() == [1.0, 1.0]


def test_magnitudes():
    """Of numbers and arrays."""
    assert magnitude(3.0 - 4.0j) == 5.0
    assert magnitude(np.array([3.0 - 4.0j, 1.0j])).tolist() == [5.0, 1.0]
