"""Small matrices: sums in the order of the index, and the solution of symmetric systems."""

from ins_sim.core.numerics import matrices
import numpy as np
import pytest


@pytest.mark.parametrize('n, m, q', [(2, 1, 1), (2, 20, 2), (11, 9, 15), (11, 15, 20), (20, 2, 2),
                                     (20, 20, 20), (1, 300, 2), (6, 20, 6), (2, 40, 1)])
def test_products_are_sums_in_the_order_of_the_index(n, m, q):
    """Bit for bit those of a loop in Python, whatever the sizes and the layout."""
    draw = np.random.default_rng(n + m + q)
    a, b = draw.normal(size=(n, m)), draw.normal(size=(q, m)).T
    expected = np.zeros((n, q))
    for i in range(n):
        for j in range(q):
            for x, y in zip(a[i].tolist(), b[:, j].tolist()):
                expected[i, j] += x * y
    np.testing.assert_array_equal(matrices.product(a, b), expected)
    if n > 1:
        np.testing.assert_array_equal(matrices.applied(a, b[:, 0]), expected[:, 0])
    assert matrices.dot(a[0], b[:, 0]) == expected[0, 0]


@pytest.mark.parametrize('size', range(1, 7))
def test_solutions_are_those_of_lapack(size):
    """Within rounding: a hundred times the condition number at most."""
    draw = np.random.default_rng(size)
    a = draw.normal(size=(size, size))
    s, b = a @ a.T + 0.1 * np.eye(size), draw.normal(size=(size, 3))
    expected = np.linalg.solve(s, b)
    bound = 100.0 * np.linalg.cond(s) * 2.0 ** -53 * np.abs(expected).max()
    np.testing.assert_allclose(matrices.solved(s, b), expected, rtol=0.0, atol=bound)


def test_a_singular_matrix_is_refused():
    """A pivot of zero raises LinAlgError, as LAPACK does."""
    with pytest.raises(np.linalg.LinAlgError, match='singular'):
        matrices.solved(np.ones((2, 2)), np.ones((2, 1)))


def test_positive_definite_matrices_are_told_from_others():
    """Correlations beyond one, zeros and NaN are not; nearly singular ones are."""
    draw = np.random.default_rng(3)
    for size in (1, 2, 8, 20):
        a = draw.normal(size=(size, size))
        assert matrices.is_positive_definite(a @ a.T + 1e-9 * np.eye(size))
    assert matrices.is_positive_definite(np.array(((1.0, 1.0 - 1e-12), (1.0 - 1e-12, 1.0))))
    for bad in (((1.0, 1.1), (1.1, 1.0)), ((1.0, 1.0), (1.0, 1.0)), ((1.0, np.nan), (np.nan, 1.0)),
                ((-1.0, 0.0), (0.0, 1.0))):
        assert not matrices.is_positive_definite(np.array(bad))
