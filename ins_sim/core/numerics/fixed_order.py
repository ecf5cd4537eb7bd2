"""
Small matrices, and lengths of vectors, with a fixed order of operations.

BLAS and LAPACK choose their loops by the processor, so that sums round differently. Here sums are
taken in the order of the indices, and complex numbers are multiplied in real arithmetic; the bits
are therefore the same on every machine.
"""

import math

import numpy as np

from . import elementary

# Highest power in the Taylor series. For row sums of at most 1/2 the remainder is below 1e-18.
TERMS = 15


def product(a, b):
    """Return the product of two matrices, real or complex."""
    if not (np.iscomplexobj(a) or np.iscomplexobj(b)):
        return _real_product(a, b)
    found = np.empty((a.shape[0], b.shape[1]), dtype=complex)
    found.real = _real_product(a.real, b.real) - _real_product(a.imag, b.imag)
    found.imag = _real_product(a.real, b.imag) + _real_product(a.imag, b.real)
    return found


def _real_product(a, b):
    if len(a) == b.shape[1] == 1:
        # NumPy would split a single sum into partial sums.
        return np.array(((dot(a[0], b[:, 0]),),))
    # In this memory layout a sum over the first axis adds whole matrices one after the other.
    return np.add.reduce(np.multiply(a.T[:, :, np.newaxis], b[:, np.newaxis, :], order='C'))


def lane_product(a, b):
    """Return the products (i, k, n) of n pairs of matrices, a (i, j, n) and b (j, k, n)."""
    found = a[:, 0, np.newaxis] * b[0]
    term = np.empty_like(found)
    for j in range(1, len(b)):
        np.multiply(a[:, j, np.newaxis], b[j], out=term)
        found += term
    return found


def applied(a, x):
    """Return the product of a real matrix (n, m) and a vector (m,)."""
    return _real_product(a, np.asarray(x)[:, np.newaxis])[:, 0]


def dot(a, b):
    """Return the scalar product of two real vectors (m,), a float."""
    total = 0.0
    for x, y in zip(a.tolist(), b.tolist()):
        total += x * y
    return total


def length(vectors):
    """Return the length of a real vector (m,), or of each row of (n, m)."""
    return elementary.sqrt(total(np.moveaxis(vectors * vectors, -1, 0)))


def magnitude(z):
    """Return the absolute value of a complex number, or of each in an array."""
    return elementary.sqrt(z.real * z.real + z.imag * z.imag)


def real_form(a):
    """Return the real matrix equivalent to a complex one, acting on (real, imaginary, ...)."""
    found = np.empty((2 * a.shape[0], 2 * a.shape[1]))
    found[::2, ::2] = found[1::2, 1::2] = a.real
    found[1::2, ::2], found[::2, 1::2] = a.imag, -a.imag
    return found


def complex_form(a):
    """Return the complex matrix whose ``real_form`` is a."""
    return a[::2, ::2] + 1j * a[1::2, ::2]


def solve(a, b):
    """
    Return x with a x = b by Gaussian elimination with pivoting.

    b is a vector or matrix; both may be real or complex. Raises numpy.linalg.LinAlgError if a is
    singular.
    """
    if np.iscomplexobj(a) or np.iscomplexobj(b):
        b = np.asarray(b, dtype=complex)
        return complex_form(solve(real_form(a), real_form(b.reshape(len(a), -1)))).reshape(b.shape)
    count = len(a)
    rows = np.column_stack((a, b)).astype(float)
    for k in range(count):
        pivot = k + int(np.abs(rows[k:, k]).argmax())
        if rows[pivot, k] == 0.0:
            raise np.linalg.LinAlgError('singular matrix')
        rows[[k, pivot]] = rows[[pivot, k]]
        rows[k] = rows[k] / rows[k, k]
        for i in range(count):
            if i != k:
                rows[i] = rows[i] - rows[i, k] * rows[k]
    return rows[:, count:].reshape(np.shape(b))


def is_positive_definite(a):
    """Return whether all pivots of a symmetric matrix (m, m) are positive."""
    a = a.copy()
    for k in range(len(a)):
        if not a[k, k] > 0.0:
            return False
        a[k + 1:, k + 1:] -= np.multiply.outer(a[k + 1:, k], a[k, k + 1:] / a[k, k])
    return True


def balance(a):
    """
    Return powers of two s such that a[i, j] s[j] / s[i] has rows and columns of similar size.

    Osborne's iteration (Parlett and Reinsch 1969). Rounding errors of the matrix exponential grow
    with the largest elements, which balancing reduces.
    """
    sizes = np.abs(a.real) + np.abs(a.imag)
    np.fill_diagonal(sizes, 0.0)
    scale, moved = np.ones(len(a)), True
    while moved:
        moved = False
        for i in range(len(a)):
            row = total(sizes[i] * scale) / scale[i]
            column = total(sizes[:, i] / scale) * scale[i]
            if row == 0.0 or column == 0.0:
                continue
            factor = math.ldexp(1.0, math.frexp(row / column)[1] // 2)
            if row / factor + column * factor < 0.95 * (row + column):
                scale[i], moved = scale[i] * factor, True
    return scale


def exponential(a):
    """
    Return e^a of a real or complex matrix, by scaling and squaring of its Taylor series.

    Errors are relative to 1 or to the largest element, whichever is larger.
    """
    if np.iscomplexobj(a):
        return complex_form(exponential(real_form(a)))
    scale = balance(a)
    a = a * scale / scale[:, None]
    largest = total(np.abs(a.T)).max()
    halvings = max(0, math.frexp(largest)[1] + 1)
    a = a * math.ldexp(1.0, -halvings)
    # Compute e^a - 1, which keeps the digits of elements that are small compared with 1.
    less_one = a / TERMS
    for k in range(TERMS - 1, 0, -1):
        less_one = (a + product(a, less_one)) / k
    for _ in range(halvings):
        less_one = 2.0 * less_one + product(less_one, less_one)
    return (np.eye(len(a)) + less_one) / scale * scale[:, None]


def total(rows):
    """Return the sum over the first axis of an array or list, added in order."""
    total = rows[0]
    for row in rows[1:]:
        total = total + row
    return total
