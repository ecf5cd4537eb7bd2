"""Circular error probable: the radius that holds a part of the horizontal errors."""

import numpy as np
from scipy.special import ndtr

# Nodes of the quadrature across the smaller axis, and how many sigmas it covers.
NODES, WEIGHTS = np.polynomial.legendre.leggauss(96)
SIGMAS = 9.0
# Halvings of the interval of the radius.
HALVINGS = 60


def probability_within(radius, mean, sigma):
    """
    Return the probability that a normal error lies within a radius of zero.

    radius (n,); mean, sigma (n, 2): along the principal axes, the larger sigma, > 0, first.
    """
    narrow = np.maximum(sigma[:, 1], 1e-12 * sigma[:, 0])
    low = np.clip(mean[:, 1] - SIGMAS * narrow, -radius, radius)
    high = np.clip(mean[:, 1] + SIGMAS * narrow, -radius, radius)
    # Nodes that crowd at both ends, where the chord is short.
    phase = 0.5 * np.pi * NODES
    y = 0.5 * (high + low)[:, None] + 0.5 * (high - low)[:, None] * np.sin(phase)
    weight = 0.25 * np.pi * (high - low)[:, None] * (WEIGHTS * np.cos(phase))
    density = np.exp(-0.5 * np.square((y - mean[:, 1:]) / narrow[:, None])) / (
        narrow[:, None] * np.sqrt(2.0 * np.pi))
    chord = np.sqrt(np.maximum(np.square(radius)[:, None] - y * y, 0.0))
    inside = (ndtr((chord - mean[:, :1]) / sigma[:, :1])
              - ndtr((-chord - mean[:, :1]) / sigma[:, :1]))
    return np.sum(weight * density * inside, axis=1)


def circular_error(part, mean, covariance):
    """
    Return the radius (n,) about zero that holds a part of normal errors.

    part: such as 0.5 or 0.95; mean (n, 2); covariance (n, 2, 2).  From the eigenvalues of the
    covariance and the mean along its axes; with no scatter, the size of the mean.
    """
    values, vectors = np.linalg.eigh(covariance)
    sigma = np.sqrt(np.maximum(values[:, ::-1], 0.0))
    certain = sigma[:, 0] == 0.0
    sigma[certain] = 1.0
    along = np.einsum('nij,ni->nj', vectors, mean)[:, ::-1]
    size = np.hypot(along[:, 0], along[:, 1])
    low, high = np.zeros(len(size)), size + SIGMAS * sigma[:, 0]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        enough = probability_within(middle, along, sigma) >= part
        low, high = np.where(enough, low, middle), np.where(enough, middle, high)
    return np.where(certain, size, 0.5 * (low + high))
