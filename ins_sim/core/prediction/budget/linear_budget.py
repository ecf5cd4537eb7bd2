"""The error budget of a simulation: the contribution of every source, from settings and motion."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.motion.motion import check_length
from ins_sim.core.numerics.garbage_collection import paused_in_blocks
from .propagation import navigation_span_s, Propagation

# Number of equal intervals between the instants of a budget; further instants may be added.
INTERVALS = 360
# Times that differ by less than this are considered the same, s.
SAME_S = 1e-6


@dataclass(frozen=True, eq=False)
class LinearBudget:
    """
    Covariances and means of the nine errors by source.

    They are the errors of position, velocity and attitude, each east, north, up. The attitude
    error is the inertial one, as in NavErrors.

    Attributes
    ----------
    t_s : (n,) time since the start of the navigation, s
    lat : (n,) true latitude, rad
    random : ErrorSources that differ from run to run
    covariance : (random, n, 9, 9) m, m/s, rad
    by_axis : (random, n, 3, 9) variances caused by each axis of the source; for a source without
        axes everything is in the first
    fixed : ErrorSources that are the same in every run
    mean : (fixed, n, 9) errors, m, m/s, rad
    beyond : (2,) for accelerometers and gyros, fraction of the time in which an input exceeds the
        range of the instrument; the budget ignores the saturation

    """

    t_s: np.ndarray
    lat: np.ndarray
    random: tuple
    covariance: np.ndarray
    by_axis: np.ndarray
    fixed: tuple
    mean: np.ndarray
    beyond: np.ndarray

    def total_covariance(self):
        """Return the covariance (n, 9, 9) of all random sources."""
        return np.add.reduce(np.concatenate([np.zeros((1, len(self.t_s), 9, 9)),
                                             self.covariance]))

    def total_mean(self):
        """Return the error (n, 9) of all fixed sources."""
        return np.add.reduce(np.concatenate([np.zeros((1, len(self.t_s), 9)), self.mean]))

    def at(self, t_s):
        """Return the index of the instant t_s, s; ValueError if the budget does not have it."""
        k = int(np.argmin(np.abs(self.t_s - t_s)))
        if abs(self.t_s[k] - t_s) > SAME_S:
            raise ValueError(f'the time is {t_s:g} s; expected one of the instants of the budget; '
                             f'the nearest is {self.t_s[k]:g} s')
        return k


@paused_in_blocks
def _propagated(run):
    """Propagate with the garbage collector disabled; yield as the propagation does."""
    yield from run.blocks()


def error_budget(settings, motion, instants_s=()):
    """
    Compute the error budget of a simulation.

    Parameters
    ----------
    settings : SimulationSettings
    motion : Motion of settings.motion_generator
    instants_s : times since the start of the navigation, s, in addition to the evenly spaced ones

    Raises
    ------
    ValueError : if the run has no finite length, an instant is outside it, or the linear budget
        does not cover the errors

    """
    check_length(settings.motion_generator, motion)
    model = settings.imu_sensor.gyro.model
    if model != 'ideal':
        raise ValueError(f'gyro.model is {model} in a budget; expected ideal: the errors of tuned '
                         'gyros come from their rotors (see ins_sim dtg-report)')
    run = Propagation(settings, motion, instants_of(settings, instants_s))
    for _ in _propagated(run):
        pass
    return LinearBudget(run.t_s, np.array(run.lat), tuple(run.random),
                        np.stack(run.covariances, axis=1), np.stack(run.by_axis, axis=1),
                        tuple(run.fixed), np.stack(run.means, axis=1), run.beyond)


def instants_of(settings, wanted_s):
    """Return the times of a budget since the start of the navigation, s, from 0 on."""
    span_s = navigation_span_s(settings)
    wanted = np.asarray(wanted_s, dtype=float)
    for t_s in wanted.tolist():
        if not 0.0 <= t_s <= span_s:
            raise ValueError(f'the time is {t_s:g} s; expected a time of the navigation, 0 to '
                             f'{span_s:g} s')
    even = span_s * np.arange(INTERVALS + 1) / INTERVALS
    # Leave out an instant that differs from an evenly spaced one only by rounding.
    others = [t_s for t_s in wanted.tolist() if np.abs(even - t_s).min() > SAME_S]
    return np.unique(np.concatenate([even, others]))
