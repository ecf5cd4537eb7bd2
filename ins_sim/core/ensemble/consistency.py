"""
Sums of NEES and NIS over runs, at each instant.

At one instant the runs are independent, so the sum over them has a chi-square distribution whose
degrees of freedom are the sum of theirs. Errors of one run at different times are correlated and
are not summed. Sums are taken run by run and merged in the order of the groups of runs.
"""

from typing import NamedTuple

from ins_sim.core.aiding.filters.base import INVALID_FIX
import numpy as np


class ChiSquareSums(NamedTuple):
    """
    Sums over runs of a quantity that is chi-square distributed if the filter is consistent.

    Attributes
    ----------
    count : number of runs
    total : sum of the squares
    freedom : sum of the degrees of freedom; all three are arrays of one shape
    """

    count: np.ndarray
    total: np.ndarray
    freedom: np.ndarray

    @property
    def mean(self):
        """Return the mean over the runs, NaN without a run."""
        return self.total / np.where(self.count > 0, self.count, np.nan)

    @property
    def expected(self):
        """Return the mean that a consistent filter would have, NaN without a run."""
        return self.freedom / np.where(self.count > 0, self.count, np.nan)


def sums_of(squares, freedoms):
    """
    Return the ChiSquareSums over runs.

    Values that are not finite, or without a degree of freedom, are left out.

    Parameters
    ----------
    squares, freedoms : (m, runs, n) values and their degrees of freedom
    """
    valid = np.isfinite(squares) & (freedoms > 0)
    instants, runs, width = squares.shape
    count, freedom = np.zeros((2, instants, width), dtype=np.int64)
    total = np.zeros((instants, width))
    for k in range(runs):
        count += valid[:, k]
        freedom += np.where(valid[:, k], freedoms[:, k], 0)
        total += np.where(valid[:, k], squares[:, k], 0.0)
    return ChiSquareSums(count, total, freedom)


def merged_sums(a, b):
    """Return the ChiSquareSums of two sets of runs together."""
    return ChiSquareSums(*(one + other for one, other in zip(a, b)))


class FixSums(NamedTuple):
    """
    The use that the filters made of the fixes of one instrument, at the k instants of the fixes.

    Attributes
    ----------
    t_ns : (k,) instants in ascending order, ns
    sums : ChiSquareSums (k,) of the NIS of the fixes that were tested, used or not
    taken : (k,) number of runs that used the fix
    refused : (k,) number of runs that did not use the fix although it was valid
    """

    t_ns: np.ndarray
    sums: ChiSquareSums
    taken: np.ndarray
    refused: np.ndarray


def fix_sums(runs, source):
    """Return the FixSums of a source; runs: a list of JudgedFix for each run."""
    none = np.empty(0, dtype=np.int64)
    found = FixSums(none, ChiSquareSums(none, np.empty(0), none), none, none)
    for judged in runs:
        own = {fix.t_ns: fix.outcome for fix in judged if fix.source == source}
        stamps = np.array(sorted(own), dtype=np.int64)
        outcomes = [own[t] for t in stamps.tolist()]
        nis = np.array([np.nan if o.nis is None else o.nis for o in outcomes], dtype=float)
        freedom = np.array([o.freedom for o in outcomes], dtype=np.int64)
        sums = sums_of(nis[:, None, None], freedom[:, None, None])
        taken, refused = (np.array([of(o) for o in outcomes], dtype=np.int64) for of in (
            lambda o: o.taken, lambda o: not o.taken and not o.reason.startswith(INVALID_FIX)))
        one = FixSums(stamps, ChiSquareSums(*(a[:, 0] for a in sums)), taken, refused)
        found = merged_fixes(found, one)
    return found


def merged_fixes(a, b):
    """Return the FixSums of two sets of runs together."""
    t_ns = np.union1d(a.t_ns, b.t_ns)

    def both(one, other):
        total = np.zeros(len(t_ns), dtype=one.dtype)
        total[np.searchsorted(t_ns, a.t_ns)] += one
        total[np.searchsorted(t_ns, b.t_ns)] += other
        return total

    return FixSums(t_ns, ChiSquareSums(*map(both, a.sums, b.sums)), both(a.taken, b.taken),
                   both(a.refused, b.refused))
