"""A requirement on an error, and the improvements that would meet it."""

from dataclasses import dataclass
import math
import re

import numpy as np

from ins_sim.core.prediction.budget.sources import ErrorSource
from ins_sim.settings import shown
from ..error_circle import error_circle
from .quantities import ANGLE, LENGTH, QUANTITIES, SPEED

# Unit: (its quantity, SI value).
UNITS = {'m': (LENGTH, 1.0), 'km': (LENGTH, 1000.0), 'nmi': (LENGTH, 1852.0),
         'm/s': (SPEED, 1.0), 'deg': (ANGLE, math.radians(1.0)),
         'arcmin': (ANGLE, math.radians(1.0) / 60.0),
         'arcsec': (ANGLE, math.radians(1.0) / 3600.0), 'mrad': (ANGLE, 1e-3)}
TIMES = {'s': 1.0, 'min': 60.0, 'h': 3600.0}
# Statistic: the fraction of errors within it, or None for the root mean square.
STATISTICS = {'rms': None, 'cep50': 0.5, 'cep95': 0.95}
GRAMMAR = ("QUANTITY STATISTIC NUMBER UNIT at NUMBER TIME, such as 'horizontal rms 1852 m at "
           f"3600 s', with QUANTITY one of {', '.join(QUANTITIES)}, STATISTIC one of "
           f"{', '.join(STATISTICS)} (cep50 and cep95 only with horizontal), UNIT one of "
           f"{', '.join(UNITS)}, and TIME one of {', '.join(TIMES)}")
_TEXT = re.compile(r'\s*(\S+)\s+(\S+)\s+([-+.\deE]+)\s*(\S+)\s+at\s+([-+.\deE]+)\s*(\S+)\s*',
                   re.IGNORECASE)
# Number of factors that are tried, and of refinements of the interval between two of them.
TRIED, ROUNDS = np.arange(33) / 32.0, 8


@dataclass(frozen=True)
class Requirement:
    """
    A requirement on an error: a statistic of a quantity is at most a limit at a time.

    Attributes
    ----------
    text : the requirement as given
    quantity : name of one of QUANTITIES
    statistic : name of one of STATISTICS
    limit : largest allowed value of the statistic, in SI units
    t_s : time since the start of the navigation, s
    """

    text: str
    quantity: str
    statistic: str
    limit: float
    t_s: float


@dataclass(frozen=True)
class Improvement:
    """
    The required improvement of one source.

    Attributes
    ----------
    source : ErrorSource
    factor : factor for its error, or None if the other sources alone exceed the requirement
    values : values of the parameter with this factor, by axis, in its unit; None
        without a factor, or if the parameter would have to be infinite
    without : value of the requirement without this source, in SI units
    """

    source: ErrorSource
    factor: float | None
    values: tuple | None
    without: float


@dataclass(frozen=True)
class RequirementAnswer:
    """
    The improvements that would meet a Requirement.

    Attributes
    ----------
    requirement : Requirement
    found : present value, in SI units
    met : whether the present value meets the requirement
    alone : Improvements of single sources, sufficient ones first, then in the order of the value
        without the source
    random : factor by which all random errors must shrink, or None if the fixed errors alone
        exceed the requirement or if it is met
    everything : factor by which all errors must shrink, or None if the requirement is met
    """

    requirement: Requirement
    found: float
    met: bool
    alone: tuple
    random: float | None
    everything: float | None


def parse_requirement(text):
    """Parse the text of a Requirement; raise ValueError with the grammar if it is invalid."""
    if not isinstance(text, str):
        raise ValueError(f'the requirement is {text!r}; expected a text: {GRAMMAR}')
    match = _TEXT.fullmatch(text)
    words = [word.lower() for word in match.groups()] if match else []
    try:
        name, statistic, limit, unit, time, time_unit = words
        limit, time = float(limit), float(time)
    except ValueError:
        name, statistic, limit, unit, time, time_unit = '', '', 0.0, '', 0.0, ''
    quantity = QUANTITIES.get(name)
    if (quantity is None or statistic not in STATISTICS or unit not in UNITS
            or time_unit not in TIMES or not 0.0 < limit < math.inf or not 0.0 < time < math.inf
            or UNITS[unit][0] != quantity.unit
            or STATISTICS[statistic] is not None and name != 'horizontal'):
        raise ValueError(f'the requirement is {shown.cut(repr(text))}; expected {GRAMMAR}')
    return Requirement(text, name, statistic, limit * UNITS[unit][1], time * TIMES[time_unit])


def times_of(requirements, end_s):
    """Return the times of Requirements, s; raise ValueError if one is after end_s."""
    for requirement in requirements:
        if requirement.t_s > end_s:
            raise ValueError(f'the requirement is {requirement.text!r}; expected a time before '
                             f'the end of the navigation, at most {end_s:g} s')
    return [requirement.t_s for requirement in requirements]


class _Scaled:
    """The value of a requirement at its time if errors are scaled by factors."""

    def __init__(self, budget, requirement):
        axes = list(QUANTITIES[requirement.quantity].axes)
        k = budget.at(requirement.t_s)
        self._part = STATISTICS[requirement.statistic]
        self.covariance = budget.covariance[:, k][:, axes][:, :, axes]
        self.mean = budget.mean[:, k][:, axes]

    def value(self, covariance, mean):
        """Return the values (n,) for covariances (n, a, a) and means (n, a)."""
        if self._part is not None:
            return error_circle(mean, covariance, self._part)
        return np.sqrt(np.trace(covariance, axis1=1, axis2=2) + np.square(mean).sum(axis=1))

    def by_factor(self, of_random, of_fixed):
        """
        Return a function that maps factors (n,) to values of the requirement.

        of_random, of_fixed: whether the factor applies, for each source.
        """
        on, off = self._sums(of_random, of_fixed), self._sums(~of_random, ~of_fixed)
        return lambda x: self.value(off[0] + np.multiply.outer(x * x, on[0]),
                                    off[1] + np.multiply.outer(x, on[1]))

    def _sums(self, of_random, of_fixed):
        return self.covariance[of_random].sum(axis=0), self.mean[of_fixed].sum(axis=0)


def answer(budget, requirement):
    """
    Return the RequirementAnswer of a LinearBudget.

    Raises ValueError if the budget does not contain the time of the Requirement.
    """
    scaled = _Scaled(budget, requirement)
    count_random, count_fixed = len(budget.random), len(budget.fixed)
    every = np.ones(count_random, dtype=bool), np.ones(count_fixed, dtype=bool)
    no_fixed = np.zeros(count_fixed, dtype=bool)
    found = float(scaled.by_factor(*every)(np.ones(1))[0])
    if found <= requirement.limit:
        return RequirementAnswer(requirement, found, True, (), None, None)
    alone = []
    for k, source in enumerate((*budget.random, *budget.fixed)):
        one = np.arange(count_random + count_fixed) == k
        by = scaled.by_factor(one[:count_random], one[count_random:])
        without = float(by(np.zeros(1))[0])
        # If two fixed errors cancel each other, reducing one need not improve the result.
        factor = (_largest_factor(by, requirement.limit)
                  if source.fixed or without <= requirement.limit else None)
        alone.append(Improvement(source, factor, _values(source, factor), without))
    alone.sort(key=lambda i: (i.factor is None, i.without))
    return RequirementAnswer(
        requirement, found, False, tuple(alone),
        _largest_factor(scaled.by_factor(every[0], no_fixed), requirement.limit),
        _largest_factor(scaled.by_factor(*every), requirement.limit))


def _largest_factor(by, limit):
    """Return the largest factor below 1 with a value of at most the limit, or None."""
    enough = np.flatnonzero(by(TRIED) <= limit)
    if not len(enough):
        return None
    low, high = float(TRIED[enough[-1]]), float(TRIED[min(enough[-1] + 1, len(TRIED) - 1)])
    for _ in range(ROUNDS):
        between = low + (high - low) * TRIED
        k = int(np.flatnonzero(by(between) <= limit)[-1])
        low, high = float(between[k]), float(between[min(k + 1, len(between) - 1)])
    return low


def _values(source, factor):
    """Return the values of a parameter that reduce an error by a factor, or None."""
    if factor is None or source.inverse and factor == 0.0:
        return None
    return tuple(v / factor if source.inverse else v * factor for v in source.values)
