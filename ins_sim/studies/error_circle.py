"""The circle about the true place inside which a part of the runs ends: CEP50, CEP95."""

import math

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtr

# Nodes of the quadrature, and the sigmas that count.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(200)
REACH = 9.0


def error_circle(mean, covariance, part):
    """
    Return the radius of the circle about zero inside which a part of normal errors lies.

    Parameters
    ----------
    mean : (2,) array
        Mean of the error, East and North, m.
    covariance : (2, 2) array
        Its covariance, m^2.
    part : float
        0.5 for CEP50, 0.95 for CEP95.

    Returns
    -------
    float
        In m; NaN where the covariance is not finite.

    Notes
    -----
    The covariance is turned to its axes, and the probability of the circle is integrated along
    the longer one (Groves, "Principles of GNSS, Inertial, and Multisensor Integrated Navigation
    Systems", 2nd ed., 2013, section B.2.4, has the case of equal sigmas). For zero mean and axis
    ratios 1, 0.5, 0.2 the radii are 1.17741, 0.87042, 0.70585 (CEP50) and 2.44775, 2.03586,
    1.97041 (CEP95) of the longer sigma.
    """
    mean, covariance = np.asarray(mean, dtype=float), np.asarray(covariance, dtype=float)
    if not (np.isfinite(mean).all() and np.isfinite(covariance).all()):
        return math.nan
    sizes, axes = np.linalg.eigh(covariance)
    small, large = np.sqrt(np.maximum(sizes, 0.0))
    along, across = np.abs(axes.T @ mean)[::-1]
    centre = math.hypot(along, across)
    if large == 0.0:
        return centre
    # an axis of no width at all is one of very little
    small = max(small, 1e-9 * large)
    return brentq(lambda r: _inside(r, along, across, large, small) - part, 0.0,
                  centre + REACH * large, xtol=1e-9 * large)


def _inside(radius, along, across, large, small):
    """Return the probability of a circle; along, across: the mean on the axes of the errors."""
    if radius <= 0.0:
        return 0.0
    low, high = (min(1.0, max(-1.0, (along + side * REACH * large) / radius))
                 for side in (-1.0, 1.0))
    first, last = math.asin(low), math.asin(high)
    angle = 0.5 * (first + last) + 0.5 * (last - first) * _NODES
    x, half = radius * np.sin(angle), radius * np.cos(angle)
    density = np.exp(-0.5 * ((x - along) / large) ** 2) / (large * math.sqrt(2.0 * math.pi))
    strip = ndtr((half - across) / small) - ndtr((-half - across) / small)
    return float(0.5 * (last - first) * np.dot(_WEIGHTS, density * strip * half))
