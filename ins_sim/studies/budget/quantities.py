"""The quantities of a LinearBudget, and the range in which linear theory applies."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.earth.ellipsoid import MEAN_RADIUS

LENGTH, SPEED, ANGLE = 'm', 'm/s', 'rad'
# Errors of second order are neglected; above this value of ``second_order`` they are visible.
LINEAR_UP_TO = 0.1


@dataclass(frozen=True)
class Quantity:
    """
    One quantity of a budget.

    Attributes
    ----------
    name : name of the quantity in a requirement
    words : name of the quantity in a title
    axes : indices of its components among the nine errors of a LinearBudget
    unit : LENGTH, SPEED or ANGLE
    """

    name: str
    words: str
    axes: tuple
    unit: str


QUANTITIES = {q.name: q for q in (
    Quantity('horizontal', 'horizontal position error', (0, 1), LENGTH),
    Quantity('east', 'position error east', (0,), LENGTH),
    Quantity('north', 'position error north', (1,), LENGTH),
    Quantity('up', 'height error', (2,), LENGTH),
    Quantity('velocity', 'horizontal velocity error', (3, 4), SPEED),
    Quantity('tilt', 'tilt error', (6, 7), ANGLE),
    Quantity('azimuth', 'azimuth error', (8,), ANGLE))}


@dataclass(frozen=True, eq=False)
class Shares:
    """
    The square of one quantity, and the contributions of the sources.

    Attributes
    ----------
    random : (sources, n) variances of the random sources
    mean : (sources, n, axes) errors of the fixed sources
    fixed : (sources, n) contribution of each fixed source to the square of their sum; it may be
        negative
    rms : (n,) square root of the total
    """

    random: np.ndarray
    mean: np.ndarray
    fixed: np.ndarray
    rms: np.ndarray

    def by_source(self):
        """Return the contributions to the square (sources, n), random ones first."""
        return np.concatenate([self.random, self.fixed])

    def contributions(self):
        """Return the error of each source alone (sources, n): sigma, or size of the mean error."""
        return np.sqrt(np.concatenate([self.random, np.square(self.mean).sum(axis=2)]))


def shares(budget, quantity):
    """Return the Shares of a Quantity in a LinearBudget."""
    axes = list(quantity.axes)
    variances = np.diagonal(budget.covariance, axis1=2, axis2=3)[..., axes]
    # Rounding may leave a small negative number.
    random = np.maximum(variances.sum(axis=2), 0.0)
    mean = budget.mean[..., axes]
    fixed = (mean * mean.sum(axis=0)).sum(axis=2)
    return Shares(random, mean, fixed,
                  np.sqrt(np.maximum(random.sum(axis=0) + fixed.sum(axis=0), 0.0)))


def second_order(budget):
    """
    Return the size of second-order errors relative to those of first order, (n,).

    It is the larger one of the azimuth error, rad, and of the horizontal error times tan(latitude)
    divided by the radius of the Earth: the rotation of the computed axes. Linear theory is
    accurate to about this fraction of the error.
    """
    azimuth = shares(budget, QUANTITIES['azimuth']).rms
    far = shares(budget, QUANTITIES['horizontal']).rms
    return np.maximum(azimuth, far * np.abs(np.tan(budget.lat)) / MEAN_RADIUS)


def linear_until(budget):
    """Return the time, s, from which on ``second_order`` exceeds LINEAR_UP_TO, or None."""
    over = second_order(budget) > LINEAR_UP_TO
    return float(budget.t_s[np.argmax(over)]) if over.any() else None
