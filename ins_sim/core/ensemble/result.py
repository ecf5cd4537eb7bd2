"""The result of many runs, and how results of several blocks of runs are joined."""

from dataclasses import dataclass, replace

import numpy as np

from ins_sim.core.navigation.whole_run import SOLVED
from .group import ERRORS
from .statistics import ErrorStatistics

# Columns (East, North) of attitude, velocity and position, for the horizontal size.
HORIZONTAL = ((0, 1), (3, 4), (6, 7))


@dataclass(frozen=True, eq=False)
class EnsembleResult:
    """
    The result of many runs.

    Attributes
    ----------
    runs : numbers of the runs
    t_ns : (m,) instants of the statistics, ns
    statistics : ErrorStatistics of attitude (rad), velocity (m/s) and position (m), nine columns
    horizontal : ErrorStatistics of the sizes of their horizontal parts, three columns
    final : (runs, 10) solutions at the end: latitude, longitude, height, v_n, q_nb
    final_errors : (runs, 9) errors at the end
    diverged : numbers of the runs with values that are not finite; they are left out from then on
    restarted : pairs (run, number of restarts of its strapdown from the truth after gaps)
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
        """Return {name: array} of the whole result, as passed between processes and stored."""
        return {'runs': np.array([self.runs.start, self.runs.stop]), 't_ns': self.t_ns,
                **self.statistics.arrays('errors'), **self.horizontal.arrays('horizontal'),
                'final': self.final, 'final_errors': self.final_errors,
                'diverged': np.array(self.diverged, dtype=np.int64),
                'restarted': np.array(self.restarted, dtype=np.int64).reshape(-1, 2)}


def of_arrays(arrays):
    """Return the EnsembleResult from the arrays of ``EnsembleResult.arrays``."""
    return EnsembleResult(
        range(*arrays['runs'].tolist()), arrays['t_ns'],
        ErrorStatistics.of_arrays(arrays, 'errors'),
        ErrorStatistics.of_arrays(arrays, 'horizontal'), arrays['final'], arrays['final_errors'],
        tuple(arrays['diverged'].tolist()), tuple(map(tuple, arrays['restarted'].tolist())))


def joined(results):
    """
    Return the EnsembleResult of several results for consecutive runs.

    Raises ValueError if the runs are not consecutive, or the instants differ.
    """
    whole, final, final_errors, diverged, restarted = None, [], [], (), ()
    for part in results:
        if whole is None:
            whole = part
        elif np.array_equal(whole.t_ns, part.t_ns) and whole.runs.stop == part.runs.start:
            whole = replace(whole, runs=range(whole.runs.start, part.runs.stop),
                            statistics=whole.statistics.joined(part.statistics),
                            horizontal=whole.horizontal.joined(part.horizontal))
        else:
            raise ValueError(f'runs {whole.runs} and {part.runs} cannot be joined; expected '
                             'consecutive runs with the same instants')
        final.append(part.final)
        final_errors.append(part.final_errors)
        diverged, restarted = diverged + part.diverged, restarted + part.restarted
    return replace(whole, final=np.concatenate(final), final_errors=np.concatenate(final_errors),
                   diverged=diverged, restarted=restarted)


class ErrorTally:
    """Accumulates the statistics of errors at m instants."""

    def __init__(self, instants):
        self._errors = ErrorStatistics(instants, ERRORS)
        self._horizontal = ErrorStatistics(instants, len(HORIZONTAL))

    def add(self, first, errors):
        """Add the errors (m, runs, ERRORS) of a group of runs, from instant ``first`` on."""
        self._errors.add(first, errors)
        self._horizontal.add(first, horizontal_of(errors))

    def result(self, runs, t_ns, final, final_errors, diverged, restarted=()):
        """
        Return the EnsembleResult.

        Parameters
        ----------
        runs : numbers of the runs
        t_ns : instants that were reached, ns
        final, final_errors : arrays of the groups of runs, in their order
        diverged, restarted : see EnsembleResult
        """
        return EnsembleResult(
            runs, np.array(t_ns, dtype=np.int64), self._errors.first(len(t_ns)),
            self._horizontal.first(len(t_ns)), np.concatenate([np.empty((0, SOLVED)), *final]),
            np.concatenate([np.empty((0, ERRORS)), *final_errors]), tuple(diverged),
            tuple(restarted))


def horizontal_of(errors):
    """Return the horizontal sizes (..., 3) of attitude, velocity and position errors."""
    return np.stack([np.sqrt(errors[..., east] * errors[..., east]
                             + errors[..., north] * errors[..., north])
                     for east, north in HORIZONTAL], axis=-1)
