"""Compare an ensemble with the budget: ratios of standard deviations and their intervals."""

from dataclasses import dataclass, replace
import os

import numpy as np
from scipy.stats import chi2, norm

from ins_sim.core.prediction.budget.linear_budget import INTERVALS, SAME_S
from ins_sim.core.prediction.budget.propagation import navigation_start_s
from ins_sim.core.ensemble.many_runs import simulate_runs
from .quantities import LINEAR_UP_TO, QUANTITIES, second_order, shares

# Number of instants at which an ensemble is compared with a budget.
INSTANTS = 60
# Fraction of ensembles that lie within the interval if the budget is right.
WITHIN = 0.999
COMPARED = ('horizontal', 'east', 'north', 'velocity', 'tilt', 'azimuth')
# Order of the errors of a budget in an ensemble, which has attitude, velocity, position.
IN_ENSEMBLE = [6, 7, 8, 3, 4, 5, 0, 1, 2]


@dataclass(frozen=True, eq=False)
class BesideRuns:
    """
    Errors of an ensemble that is compared with a budget, at m instants.

    Attributes
    ----------
    runs : number of runs
    diverged : numbers of the excluded runs
    t_s : (m,) time since the start of the navigation, s
    count : (m,) number of runs at each instant
    mean : (m, 9) mean of attitude, velocity and position error, East, North, Up, rad, m/s, m
    covariance : (m, 9, 9) covariance of these errors
    """

    runs: int
    diverged: tuple
    t_s: np.ndarray
    count: np.ndarray
    mean: np.ndarray
    covariance: np.ndarray


@dataclass(frozen=True, eq=False)
class ComparedQuantity:
    """
    One quantity of an ensemble compared with the budget, at n instants.

    Attributes
    ----------
    name : one of COMPARED
    t_s : (n,) time since the start of the navigation, s
    numbers : (n,) indices of the instants in the budget
    budget, ensemble : (n,) rms, or standard deviation for a single axis, in m, m/s or rad
    low, high : (n,) interval that contains the ratio of ensemble to budget for 99.9 % of ensembles
    linear : (n,) whether linear theory applies
    """

    name: str
    t_s: np.ndarray
    numbers: np.ndarray
    budget: np.ndarray
    ensemble: np.ndarray
    low: np.ndarray
    high: np.ndarray
    linear: np.ndarray

    @property
    def ratio(self):
        """Return ensemble divided by budget, (n,)."""
        return self.ensemble / self.budget

    @property
    def differs(self):
        """Return whether the ratio is outside its interval, (n,)."""
        return (self.ratio < self.low) | (self.ratio > self.high)


def fly_beside(settings, motion, budget, runs):
    """
    Simulate runs of SimulationSettings for the comparison with a LinearBudget.

    Return the BesideRuns. Raises ValueError for a single run, and as ``simulate_runs`` does.
    """
    if not isinstance(runs, int) or isinstance(runs, bool) or runs < 2:
        raise ValueError(f'the number of runs is {runs!r}; expected at least 2, whose scatter '
                         'is compared with the budget, or 0 for no comparison')
    every = max(1, -(-(len(budget.t_s) - 1) // INSTANTS))
    found = simulate_runs(settings, motion, range(runs),
                          navigation_start_s(settings) + budget.t_s[every::every],
                          os.cpu_count() or 1)
    return of_ensemble(settings, found)


def of_ensemble(settings, ensemble):
    """Return the BesideRuns of an EnsembleResult of SimulationSettings."""
    found = ensemble.statistics
    return BesideRuns(len(ensemble.runs), ensemble.diverged,
                      1e-9 * ensemble.t_ns - navigation_start_s(settings), found.count,
                      found.mean, found.covariance)


def without_start(budget):
    """Return a LinearBudget without the initial standard deviations, which no run draws."""
    drawn = [k for k, source in enumerate(budget.random) if source.triad is not None]
    return replace(budget, random=tuple(budget.random[k] for k in drawn),
                   covariance=budget.covariance[drawn], by_axis=budget.by_axis[drawn])


def sigma_interval(count, within=WITHIN):
    """Return the interval of the ratio of a sample's standard deviation to the true one."""
    free = np.maximum(np.asarray(count) - 1, 1)
    tail = 0.5 * (1.0 - within)
    return np.sqrt(chi2.ppf(tail, free) / free), np.sqrt(chi2.isf(tail, free) / free)


def rms_scatter(covariance, mean, count):
    """
    Return the relative standard deviation of the rms of a vector over some runs, (n,).

    The square of the length has the variance 2 tr(P P) + 4 m' P m (Mathai and Provost, "Quadratic
    Forms in Random Variables", 1992).

    Parameters
    ----------
    covariance : (n, a, a) covariance P of the vector
    mean : (n, a) mean m of the vector
    count : number of runs
    """
    square = np.trace(covariance, axis1=1, axis2=2) + np.square(mean).sum(axis=1)
    variance = (2.0 * np.square(covariance).sum(axis=(1, 2))
                + 4.0 * np.einsum('ni,nij,nj->n', mean, covariance, mean))
    return 0.5 * np.sqrt(variance / count) / square


def not_compared(budget, beside):
    """
    Return the number of instants of BesideRuns, without the start, that ``compared`` leaves out.
    """
    later = beside.t_s > SAME_S
    return int(np.count_nonzero(later & ~_common(_apart(budget, beside), beside)))


def _apart(budget, beside):
    """Return the distances between the instants of a budget and of runs, (n, m), s."""
    return np.abs(budget.t_s[:, np.newaxis] - beside.t_s)


def _common(apart, beside):
    """Return which instants of runs the budget contains, if any error scatters there, (m,)."""
    return (apart.min(axis=0) <= SAME_S) & (beside.t_s > SAME_S) & (beside.count > 1)


def compared(budget, beside):
    """
    Return the ComparedQuantities of BesideRuns and a LinearBudget at their common instants.

    The budget is that of ``without_start``. Quantities without random errors, such as the height
    if the vertical channel follows the truth, are left out, and so is the start. Raises ValueError
    if there is no common instant.
    """
    if beside.count.max() < 2:
        raise ValueError(f'the ensemble has {beside.count.max()} run that has not diverged; '
                         'expected at least 2, because their scatter is compared with the budget')
    off = _apart(budget, beside)
    common = _common(off, beside)
    if not common.any():
        raise ValueError(f'the ensemble has {len(beside.t_s)} instants from {beside.t_s[0]:g} to '
                         f'{beside.t_s[-1]:g} s, but none of them can be compared; expected '
                         'instants of the budget, which divides the run into '
                         f'{INTERVALS} intervals, with at least 2 runs')
    numbers, count = off.argmin(axis=0)[common], beside.count[common]
    t_s, mean, covariance = budget.t_s[numbers], beside.mean[common], beside.covariance[common]
    budget = without_start(budget)
    linear = second_order(budget)[numbers] <= LINEAR_UP_TO
    p, m = budget.total_covariance()[numbers], budget.total_mean()[numbers]
    found = []
    for name in COMPARED:
        axes = list(QUANTITIES[name].axes)
        theirs = [IN_ENSEMBLE[k] for k in axes]
        rms = shares(budget, QUANTITIES[name]).rms[numbers]
        if not np.diagonal(p, axis1=1, axis2=2)[:, axes].all():
            continue
        if len(axes) == 1:
            sigma = np.sqrt(p[:, axes[0], axes[0]])
            sample = np.sqrt(covariance[:, theirs[0], theirs[0]])
            low, high = sigma_interval(count)
        else:
            sigma = rms
            squares = np.square(mean[:, theirs]).sum(axis=1) + np.trace(
                covariance[:, theirs][:, :, theirs], axis1=1, axis2=2) * (count - 1.0) / count
            sample = np.sqrt(squares)
            wide = norm.isf(0.5 * (1.0 - WITHIN)) * rms_scatter(
                p[:, axes][:, :, axes], m[:, axes], count)
            low, high = 1.0 - wide, 1.0 + wide
        found.append(ComparedQuantity(name, t_s, numbers, sigma, sample, low, high, linear))
    return found
