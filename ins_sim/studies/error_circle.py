"""Radius of the circle about the true position that contains a part of the runs: CEP50, CEP95."""

import math

import numpy as np
from scipy.special import ndtr

# Number of nodes of the quadrature, and the range in sigmas.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(96)
REACH = 9.0
# Number of bisections for a radius.
HALVINGS = 50


def error_circle(mean, covariance, part):
    """
    Return the radius of the circle about zero that contains a part of normally distributed errors.

    Parameters
    ----------
    mean : (..., 2) array
        Mean of the error, East and North, m.
    covariance : (..., 2, 2) array
        Its covariance, m^2.
    part : float
        0.5 for CEP50, 0.95 for CEP95.

    Returns
    -------
    float or (...) array
        In m; NaN if mean or covariance is not finite.

    Notes
    -----
    The covariance is rotated to its principal axes, and the probability of the circle is
    integrated across the shorter one (Groves, "Principles of GNSS, Inertial, and Multisensor
    Integrated Navigation Systems", 2nd ed., 2013, section B.2.4, covers equal sigmas). For zero
    mean and axis ratios 1, 0.5, 0.2 the radii are 1.17741, 0.87042, 0.70585 (CEP50) and 2.44775,
    2.03586, 1.97041 (CEP95) of the longer sigma.
    """
    shape = np.shape(mean)[:-1]
    mean = np.asarray(mean, dtype=float).reshape(-1, 2)
    covariance = np.asarray(covariance, dtype=float).reshape(-1, 2, 2)
    radius = np.full(len(mean), math.nan)
    known = np.isfinite(mean).all(axis=1) & np.isfinite(covariance).all(axis=(1, 2))
    radius[known] = _radii(mean[known], covariance[known], part)
    return radius.reshape(shape) if shape else float(radius[0])


def _radii(mean, covariance, part):
    sizes, axes = np.linalg.eigh(covariance)
    small, large = np.sqrt(np.maximum(sizes, 0.0)).T
    across, along = np.abs(np.einsum('nij,ni->nj', axes, mean)).T
    centre, certain = np.hypot(along, across), large == 0.0
    large = np.where(certain, 1.0, large)
    # An axis of zero width is replaced by one of very small width.
    small = np.maximum(small, 1e-12 * large)
    low, high = np.zeros(len(mean)), centre + REACH * large
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        enough = _inside(middle, along, across, large, small) >= part
        low, high = np.where(enough, low, middle), np.where(enough, middle, high)
    return np.where(certain, centre, 0.5 * (low + high))


def _inside(radius, along, across, large, small):
    """Return the probability of circles; along, across: the mean in the axes of the errors."""
    low, high = (np.clip(across + side * REACH * small, -radius, radius) for side in (-1.0, 1.0))
    # The nodes are dense at both ends, where the chord is short.
    phase = 0.5 * math.pi * _NODES
    half = 0.5 * (high - low)
    y = (0.5 * (high + low))[:, None] + half[:, None] * np.sin(phase)
    weight = (0.5 * math.pi * half)[:, None] * (_WEIGHTS * np.cos(phase))
    density = np.exp(-0.5 * np.square((y - across[:, None]) / small[:, None])) / (
        small[:, None] * math.sqrt(2.0 * math.pi))
    chord = np.sqrt(np.maximum(np.square(radius)[:, None] - y * y, 0.0))
    strip = (ndtr((chord - along[:, None]) / large[:, None])
             - ndtr((-chord - along[:, None]) / large[:, None]))
    return np.sum(weight * density * strip, axis=1)
