"""What is kept of many runs, and how the results of blocks of them become one."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.navigation.whole_run import SOLVED
from .group import ERRORS
from .statistics import ErrorStatistics

# Of these columns the horizontal size is taken: attitude, velocity, position, East and North.
HORIZONTAL = ((0, 1), (3, 4), (6, 7))


@dataclass(frozen=True, eq=False)
class EnsembleResult:
    """
    What is kept of many runs.

    runs: their numbers; t_ns (m,): the instants of the statistics; statistics: of the errors of
    attitude (rad), velocity (m/s) and position (m), nine columns; horizontal: of the sizes of
    their horizontal parts, three columns; final (runs, 10): the solutions at the end, latitude,
    longitude, height, v_n, q_nb; final_errors (runs, 9); diverged: the numbers of the runs that
    did not stay finite, which count no further; restarted: pairs of a run and how often its
    strapdown started anew from the truth, after gaps.
    """

    runs: range
    t_ns: np.ndarray
    statistics: ErrorStatistics
    horizontal: ErrorStatistics
    final: np.ndarray
    final_errors: np.ndarray
    diverged: tuple
    restarted: tuple = ()

    def arrays(self):
        """Return {name: array} of the whole result: what travels, and what is kept on disk."""
        return {'runs': np.array([self.runs.start, self.runs.stop]), 't_ns': self.t_ns,
                **self.statistics.arrays('errors'), **self.horizontal.arrays('horizontal'),
                'final': self.final, 'final_errors': self.final_errors,
                'diverged': np.array(self.diverged, dtype=np.int64),
                'restarted': np.array(self.restarted, dtype=np.int64).reshape(-1, 2)}


def of_arrays(arrays):
    """Return the EnsembleResult of ``EnsembleResult.arrays``."""
    return EnsembleResult(
        range(*arrays['runs'].tolist()), arrays['t_ns'],
        ErrorStatistics.of_arrays(arrays, 'errors'),
        ErrorStatistics.of_arrays(arrays, 'horizontal'), arrays['final'], arrays['final_errors'],
        tuple(arrays['diverged'].tolist()), tuple(map(tuple, arrays['restarted'].tolist())))


def joined(first, second):
    """
    Return the EnsembleResult of the runs of two, the second going on where the first ends.

    Raises ValueError where they are of different instants.
    """
    if not np.array_equal(first.t_ns, second.t_ns) or first.runs.stop != second.runs.start:
        raise ValueError(f'runs {first.runs} and {second.runs} do not go together; expected '
                         'consecutive runs with the same instants')
    return EnsembleResult(
        range(first.runs.start, second.runs.stop), first.t_ns,
        first.statistics.joined(second.statistics), first.horizontal.joined(second.horizontal),
        np.concatenate([first.final, second.final]),
        np.concatenate([first.final_errors, second.final_errors]),
        first.diverged + second.diverged, first.restarted + second.restarted)


class ErrorTally:
    """The statistics of errors at m instants in the making."""

    def __init__(self, instants):
        self._errors = ErrorStatistics(instants, ERRORS)
        self._horizontal = ErrorStatistics(instants, len(HORIZONTAL))

    def add(self, first, errors):
        """Add the errors (m, runs, ERRORS) of a group of runs from instant number first on."""
        self._errors.add(first, errors)
        self._horizontal.add(first, horizontal_of(errors))

    def result(self, runs, t_ns, final, final_errors, diverged, restarted=()):
        """
        Return the EnsembleResult.

        t_ns: the instants that were reached; final, final_errors: arrays of the groups of runs, in
        their order.
        """
        return EnsembleResult(
            runs, np.array(t_ns, dtype=np.int64), self._errors.first(len(t_ns)),
            self._horizontal.first(len(t_ns)), np.concatenate([np.empty((0, SOLVED)), *final]),
            np.concatenate([np.empty((0, ERRORS)), *final_errors]), tuple(diverged),
            tuple(restarted))


def horizontal_of(errors):
    """Return the horizontal sizes (..., 3) of errors (..., ERRORS): attitude, velocity, place."""
    return np.stack([np.sqrt(errors[..., east] * errors[..., east]
                             + errors[..., north] * errors[..., north])
                     for east, north in HORIZONTAL], axis=-1)
