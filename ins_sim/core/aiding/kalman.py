"""The measurement update of a Kalman filter, and statistics to test its consistency."""

import numpy as np

from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import dot, is_positive_definite, product, solve


def innovation(p, h, r):
    """
    Return S = H P H' + R and the gain P H' S^-1.

    Parameters
    ----------
    p : (n, n) covariance
    h : (m, n) measurement matrix
    r : (m, m) measurement covariance

    Returns
    -------
    S : (m, m)
    gain : (n, m)

    Raises
    ------
    numpy.linalg.LinAlgError : if S is singular
    """
    ph = product(p, h.T)
    s = product(h, ph) + r
    return s, solve(s, ph.T).T


def joseph(p, h, r, gain):
    """
    Return the covariance after an update; symmetric and positive definite for any gain.

    (I - K H) P (I - K H)' + K R K' (Bucy and Joseph 1968; Groves 3.58).
    """
    a = np.eye(len(p)) - product(gain, h)
    p = product(product(a, p), a.T) + product(product(gain, r), gain.T)
    return 0.5 * (p + p.T)


def normalised_square(z, s):
    """Return z' S^-1 z: the NIS if z is an innovation, the NEES if z is a state error."""
    return dot(z, solve(s, z))


def chi_square_tail(square, freedom):
    """
    Return the probability that a chi-square variable exceeds ``square``; freedom must be even.

    exp(-x/2) sum (x/2)^k / k!, k below freedom / 2 (Abramowitz and Stegun 26.4.5).
    """
    half, term, total = 0.5 * square, 1.0, 1.0
    for k in range(1, freedom // 2):
        term *= half / k
        total += term
    return elementary.exp(-half) * total if half < 700.0 else 0.0


def is_covariance(p):
    """Return whether p is finite, symmetric and positive definite."""
    scale = np.sqrt(np.abs(np.diagonal(p)))
    if not np.isfinite(p).all() or not (np.diagonal(p) > 0.0).all():
        return False
    # Test the correlations, so that metres and radians have comparable magnitudes.
    return is_positive_definite(p / np.multiply.outer(scale, scale))
