"""Many runs of one simulation: the same truth, other random numbers and initial errors."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial

import numpy as np

from ins_sim.core.motion.motion import check_length
from ins_sim.core.navigation.sample_clock import SampleClock
from ins_sim.core.navigation.whole_run import SOLVED
from ins_sim.core.numerics.garbage_collection import paused_in_blocks
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.sampling import Sampler
from ins_sim.core.simulation.inertial import check_start, ideal_blocks
from .group import ERRORS, Group
from .lanes import LANES
from .statistics import ErrorStatistics


@dataclass(frozen=True, eq=False)
class EnsembleResult:
    """
    What is kept of many runs.

    runs: their numbers; t_ns (m,): the instants of the statistics; statistics: of the errors of
    attitude (rad), velocity (m/s) and position (m), nine columns; final (runs, 10): the solutions
    at the end, latitude, longitude, height, v_n, q_ib; final_errors (runs, 9); diverged: the
    numbers of the runs that did not stay finite, which count no further.
    """

    runs: range
    t_ns: np.ndarray
    statistics: ErrorStatistics
    final: np.ndarray
    final_errors: np.ndarray
    diverged: tuple


def simulate_runs(settings, motion, runs, instants_s, threads=1, initial=None):
    """
    Return the EnsembleResult of runs of SimulationSettings; run k is ``simulate`` with run=k.

    motion: that of settings.motion_generator; runs: range of numbers; instants_s: motion times of
    the statistics, each taken at the first sample from then on that has a solution; threads: how
    many work at once, which changes no bit; initial: function of the number of a run that returns
    its Initial errors, by default those of the settings.  Raises ValueError where the settings do
    not go side by side.
    """
    check_length(settings.motion_generator, motion)
    check_start(settings)
    _check(settings)
    groups = [Group(settings, runs[first:first + LANES], initial)
              for first in range(0, len(runs), LANES)]
    wanted = np.unique(np.round(1e9 * np.asarray(instants_s, dtype=float)).astype(np.int64))
    statistics, taken, truth = ErrorStatistics(len(wanted), ERRORS), [], None
    work = ThreadPoolExecutor(threads) if threads > 1 else nullcontext()
    with work as pool:
        each = map if pool is None else pool.map
        for imu, first, t_ns, truth in _navigated(settings, motion):
            if first:
                list(each(partial(Group.wait, imu=imu[:first]), groups))
            if first == len(imu):
                continue
            ends = np.searchsorted(t_ns, wanted)
            ends, wanted = ends[ends < len(t_ns)], wanted[ends == len(t_ns)]
            picked = np.unique(ends)
            for errors in each(partial(Group.advance, imu=imu[first:], t_ns=t_ns, truth=truth,
                                       picked=picked), groups):
                statistics.add(len(taken), errors)
            taken.extend(t_ns[picked].tolist())
    if not truth:
        raise ValueError('the runs have no navigation output; expected duration_s longer than '
                         'initial.after_s')
    found = [group.final(truth[-1:]) for group in groups]
    return EnsembleResult(
        runs, np.array(taken, dtype=np.int64), statistics.first(len(taken)),
        np.concatenate([np.empty((0, SOLVED)), *(solved for solved, _ in found)]),
        np.concatenate([np.empty((0, ERRORS)), *(errors for _, errors in found)]),
        tuple(run for group in groups for run in group.diverged))


@paused_in_blocks
def _navigated(settings, motion):
    """
    Yield blocks of ideal readings.

    With each the number of its first sample at which the strapdown runs, and of the samples from
    there on the instants and the Truth.
    """
    clock = SampleClock(settings.strapdown, period_ns(settings.strapdown.rate_hz))
    start_ns = None
    for imu in ideal_blocks(settings, motion):
        t_ns = clock.instant(imu.t_ns)
        if start_ns is None:
            start_ns = int(t_ns[0]) + round(settings.strapdown.initial.after_s * 1e9)
        first = int(np.searchsorted(t_ns, start_ns))
        yield imu, first, t_ns[first:], motion.at(t_ns[first:])


def _check(settings):
    sensor, strapdown = settings.imu_sensor, settings.strapdown
    sampler = Sampler(sensor.sampling, sensor.seed, 0, 'sampling', period_ns(sensor.rate_hz))
    for name, value, expected in (
            ('gyro.model', sensor.gyro.model, 'ideal'),
            ('orientation', strapdown.orientation, 'quaternion'),
            ('sampling', 'perfect' if sampler.perfect else 'not perfect', 'perfect')):
        if value != expected:
            raise ValueError(f'{name} is {value} in an ensemble; expected {expected}: the other '
                             'kinds are simulated run by run (simulate with run)')
