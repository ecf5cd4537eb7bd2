"""
Products and solutions of small matrices, with the same bits on every machine.

BLAS and LAPACK add in an order that depends on the processor. Here every sum is taken in the
order of its index, term by term.
"""

import numpy as np


def product(a, b):
    """Return a b of matrices (n, m) and (m, q); n q is at least 2."""
    # In this layout a sum over the first axis adds whole matrices, one after the other.
    return np.add.reduce(np.multiply(a.T[:, :, np.newaxis], b[:, np.newaxis, :], order='C'))


def applied(a, x):
    """Return a x of a matrix (n, m), n at least 2, and a vector (m,)."""
    return np.add.reduce(np.multiply(a.T, np.asarray(x)[:, np.newaxis], order='C'))


def solved(s, b):
    """
    Return x of s x = b for a symmetric positive definite s (m, m) and b (m, q).

    Gaussian elimination without pivots, of which such a matrix needs none (Golub and Van Loan,
    "Matrix Computations", 4th ed., section 4.2).  Raises numpy.linalg.LinAlgError where s is
    singular.
    """
    s, x, count = s.copy(), b.copy(), len(s)
    for k in range(count):
        if s[k, k] == 0.0:
            raise np.linalg.LinAlgError('singular matrix')
        for i in range(k + 1, count):
            factor = s[i, k] / s[k, k]
            s[i] -= factor * s[k]
            x[i] -= factor * x[k]
    for k in range(count - 1, -1, -1):
        for j in range(k + 1, count):
            x[k] -= s[k, j] * x[j]
        x[k] /= s[k, k]
    return x


def is_positive_definite(a):
    """Return whether all pivots of a symmetric matrix (m, m) are positive."""
    a = a.copy()
    for k in range(len(a)):
        if not a[k, k] > 0.0:
            return False
        a[k + 1:, k + 1:] -= np.multiply.outer(a[k + 1:, k], a[k, k + 1:] / a[k, k])
    return True


def dot(a, b):
    """Return the sum of the products of two vectors (m,), a float."""
    total = 0.0
    for x, y in zip(a.tolist(), b.tolist()):
        total += x * y
    return total
