"""Small matrices computed in a fixed order, compared with SciPy, mpmath and definitions."""

import math

import mpmath
import numpy as np
import pytest
import scipy.linalg

from ins_sim.core.numerics.fixed_order import (applied, balance, dot, exponential,
                                               is_positive_definite, length, magnitude, product,
                                               solve)


def draws(count, size=1.0):
    """Yield pairs of random square matrices with 1 to 7 rows, alternately real and complex."""
    rng = np.random.default_rng(4)
    for k in range(count):
        n = int(rng.integers(1, 8))
        parts = rng.normal(size=(4, n, n)) * size
        yield (parts[0], parts[1]) if k % 2 else (parts[0] + 1j * parts[2],
                                                  parts[1] + 1j * parts[3])


def test_products():
    """Products of real, complex, mixed and rectangular matrices are right to rounding."""
    for a, b in draws(40):
        for left, right in ((a, b), (a.real, b), (a, b[:, :1].real), (a[:1], b)):
            np.testing.assert_allclose(product(left, right), left @ right, rtol=0, atol=1e-14)


def test_sums_are_taken_in_the_order_of_the_indices():
    """Products have the bits of a loop over floats in the order of the indices."""
    for a, b in draws(20):
        expected = [[complex(*_one(row, column)) for column in b.T.tolist()]
                    for row in a.tolist()]
        assert np.array_equal(product(a, b), expected)


def _one(row, column):
    """Return the sums of the four products of real and imaginary parts."""
    sums = [0.0] * 4
    for k, (p, q) in enumerate(zip(row, column)):
        p, q = complex(p), complex(q)
        four = p.real * q.real, p.imag * q.imag, p.real * q.imag, p.imag * q.real
        sums = [s + f for s, f in zip(sums, four)] if k else list(four)
    return sums[0] - sums[1], sums[2] + sums[3]


def test_solutions():
    """``solve`` is right for vectors and matrices, also with a zero on the diagonal."""
    for a, b in draws(40):
        for right in (b, b[:, 0]):
            residual = np.abs(a @ solve(a, right) - right).max()
            assert residual <= 1e-13 * np.abs(a).max() * np.abs(solve(a, right)).max() + 1e-13
    assert solve(np.array(((0.0, 2.0), (4.0, 0.0))), np.array((2.0, 4.0))).tolist() == [1.0, 1.0]


@pytest.mark.parametrize('size', [1e-3, 0.1, 1.0, 5.0, 20.0])
def test_exponentials_against_mpmath(size):
    """
    The matrix exponential has errors below 2e-15 times the norm of the matrix.

    Each halving doubles the rounding errors. Errors are relative to the largest element, or to 1
    if all are smaller.
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
    """``balance`` returns powers of two after which rows and columns have similar sizes."""
    a = np.array(((1.0, 1e6, 0.0), (1e-7, 2.0, 1e-3), (0.0, 1e4, 3.0)))
    scale = balance(a)
    assert np.array_equal(np.frexp(scale)[0], [0.5] * 3)
    off = np.abs(a * scale / scale[:, None])
    np.fill_diagonal(off, 0.0)
    ratio = off.sum(axis=0) / off.sum(axis=1)
    assert (ratio > 0.2).all() and (ratio < 5.0).all()
    assert balance(np.zeros((2, 2))).tolist() == [1.0, 1.0]


def test_magnitudes():
    """``magnitude`` is right for numbers and arrays."""
    assert magnitude(3.0 - 4.0j) == 5.0
    assert magnitude(np.array([3.0 - 4.0j, 1.0j])).tolist() == [5.0, 1.0]


@pytest.mark.parametrize('n, m, q', [(2, 1, 1), (1, 40, 1), (2, 20, 2), (11, 9, 15), (11, 15, 20),
                                     (20, 2, 2), (20, 20, 20), (1, 300, 2), (6, 20, 6),
                                     (2, 40, 1)])
def test_real_products_are_sums_in_the_order_of_the_index(n, m, q):
    """Real products have the bits of a Python loop for all sizes and memory layouts."""
    draw = np.random.default_rng(n + m + q)
    a, b = draw.normal(size=(n, m)), draw.normal(size=(q, m)).T
    expected = np.zeros((n, q))
    for i in range(n):
        for j in range(q):
            for x, y in zip(a[i].tolist(), b[:, j].tolist()):
                expected[i, j] += x * y
    np.testing.assert_array_equal(product(a, b), expected)
    np.testing.assert_array_equal(applied(a, b[:, 0]), expected[:, 0])
    assert dot(a[0], b[:, 0]) == expected[0, 0]


def test_lengths():
    """``length`` of a vector and of rows has the bits of a sum from left to right."""
    rows = np.random.default_rng(1).normal(size=(50, 11))
    expected = []
    for row in rows.tolist():
        total = 0.0
        for x in row:
            total += x * x
        expected.append(math.sqrt(total))
    assert length(rows).tolist() == expected
    assert [length(row) for row in rows] == expected


@pytest.mark.parametrize('size', range(1, 7))
def test_symmetric_solutions_are_those_of_lapack(size):
    """Symmetric systems are solved as by LAPACK, within 100 ulp times the condition number."""
    draw = np.random.default_rng(size)
    a = draw.normal(size=(size, size))
    s, b = a @ a.T + 0.1 * np.eye(size), draw.normal(size=(size, 3))
    expected = np.linalg.solve(s, b)
    bound = 100.0 * np.linalg.cond(s) * 2.0 ** -53 * np.abs(expected).max()
    np.testing.assert_allclose(solve(s, b), expected, rtol=0.0, atol=bound)


def test_a_singular_matrix_is_refused():
    """A singular matrix raises LinAlgError, as in LAPACK."""
    with pytest.raises(np.linalg.LinAlgError, match='singular'):
        solve(np.ones((2, 2)), np.ones((2, 1)))


def test_positive_definite_matrices_are_told_from_others():
    """Nearly singular matrices are positive definite; singular, indefinite, NaN ones are not."""
    draw = np.random.default_rng(3)
    for size in (1, 2, 8, 20):
        a = draw.normal(size=(size, size))
        assert is_positive_definite(a @ a.T + 1e-9 * np.eye(size))
    assert is_positive_definite(np.array(((1.0, 1.0 - 1e-12), (1.0 - 1e-12, 1.0))))
    for bad in (((1.0, 1.1), (1.1, 1.0)), ((1.0, 1.0), (1.0, 1.0)), ((1.0, np.nan), (np.nan, 1.0)),
                ((-1.0, 0.0), (0.0, 1.0))):
        assert not is_positive_definite(np.array(bad))
