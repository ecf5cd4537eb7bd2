"""Change of an error with the parameters of the settings."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.prediction.budget.sources import ErrorSource
from .quantities import shares


@dataclass(frozen=True)
class Sensitivity:
    """
    The change of an error with one parameter, of all axes or of one.

    Attributes
    ----------
    source : ErrorSource of the parameter
    axis : 'x', 'y', 'z', or '' for all
    value : value of the parameter, in its unit
    alone : error due to the source alone for a unit of the parameter (for a lag, at its
        bandwidth), in the SI unit of the quantity divided by the unit of the parameter
    slope : d rms / d parameter, in the same unit as alone
    """

    source: ErrorSource
    axis: str
    value: float
    alone: float
    slope: float


def sensitivities(budget, quantity, k):
    """
    Return the Sensitivities of a Quantity in a LinearBudget at the instant with index k.

    A parameter with equal axes is changed on all of them. Otherwise a random source is changed
    axis by axis, and a fixed one in proportion, per unit of its largest axis.
    """
    found, axes = [], list(quantity.axes)
    made = shares(budget, quantity)
    rms = float(made.rms[k])
    squares, contributions = made.by_source()[:, k], made.contributions()[:, k]
    for i, source in enumerate((*budget.random, *budget.fixed)):
        if len(set(source.values)) > 1 and not source.fixed:
            found += [_one(source, axis, value, float(np.sqrt(square)), float(square), rms)
                      for axis, value, square in zip(
                          'xyz', source.values,
                          budget.by_axis[i, k][:, axes].sum(axis=1)) if value]
        else:
            value = max(source.values, key=abs)
            found.append(_one(source, '', value, float(contributions[i]), float(squares[i]), rms))
    return found


def _one(source, axis, value, contribution, square, rms):
    size = abs(value)
    slope = square / (rms * value) if rms else 0.0
    return Sensitivity(source, axis, value, contribution / size,
                       -slope if source.inverse else slope)
