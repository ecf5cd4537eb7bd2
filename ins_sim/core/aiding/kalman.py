"""The measurement update of a Kalman filter, and what tells whether it is consistent."""

import math

import numpy as np


def innovation(p, h, r):
    """
    Return S = H P H' + R and the gain P H' S^-1.

    p (n, n) covariance; h (m, n); r (m, m).  Raises numpy.linalg.LinAlgError where S is singular.
    """
    ph = p @ h.T
    s = h @ ph + r
    return s, np.linalg.solve(s, ph.T).T


def joseph(p, h, r, gain):
    """
    Return the covariance after an update, symmetric and positive whatever the gain.

    (I - K H) P (I - K H)' + K R K' (Bucy and Joseph 1968; Groves 3.58).
    """
    a = np.eye(len(p)) - gain @ h
    p = a @ p @ a.T + gain @ r @ gain.T
    return 0.5 * (p + p.T)


def normalised_square(z, s):
    """Return z' S^-1 z: of an innovation the NIS, of an error the NEES."""
    return float(z @ np.linalg.solve(s, z))


def chi_square_tail(square, freedom):
    """
    Return the probability that chi-square of an even number of degrees of freedom is larger.

    exp(-x/2) sum (x/2)^k / k!, k below freedom / 2 (Abramowitz and Stegun 26.4.5).
    """
    half, term, total = 0.5 * square, 1.0, 1.0
    for k in range(1, freedom // 2):
        term *= half / k
        total += term
    return math.exp(-half) * total if half < 700.0 else 0.0


def is_covariance(p):
    """Return whether p is finite, symmetric and positive definite."""
    scale = np.sqrt(np.abs(np.diagonal(p)))
    if not np.isfinite(p).all() or not (np.diagonal(p) > 0.0).all():
        return False
    try:
        # of the correlations, so that metres and radians weigh alike
        np.linalg.cholesky(p / np.outer(scale, scale))
    except np.linalg.LinAlgError:
        return False
    return True
