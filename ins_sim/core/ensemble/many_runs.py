"""Many runs of one simulation: the same truth, different random numbers and initial errors."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from functools import partial

import numpy as np

from ins_sim.core.motion.motion import check_length
from ins_sim.core.navigation.sample_clock import SampleClock
from ins_sim.core.numerics.garbage_collection import paused_in_blocks
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.sampling import Sampler
from ins_sim.core.simulation.inertial import check_start, ideal_blocks
from .group import Group
from .lanes import LANES
from .one_by_one import simulate_each
from .result import ErrorTally

NO_OUTPUT = ('the runs have no navigation output; expected duration_s longer than '
             'initial.after_s')


def simulate_runs(settings, motion, runs, instants_s, threads=1, initial=None):
    """
    Return the EnsembleResult of many runs.

    Run k has the same bits as ``simulate`` gives for ``settings.with_run(k)``. Settings for which
    runs cannot be processed together are simulated run by run.

    Parameters
    ----------
    settings : SimulationSettings
    motion : the motion of settings.motion_generator
    runs : range of numbers of runs
    instants_s : motion times of the statistics, s; the first sample from then on that has a
        solution is used
    threads : number of threads, which does not change the bits
    initial : function (number of a run) -> its Initial errors, or None for those of the settings

    Raises
    ------
    ValueError
        As ``simulate`` does.
    """
    check_runs(settings, motion)
    wanted = np.unique(np.round(1e9 * np.asarray(instants_s, dtype=float)).astype(np.int64))
    if not in_lanes(settings):
        return simulate_each(settings, motion, runs, wanted, initial)
    groups = [Group(settings, runs[first:first + LANES], initial)
              for first in range(0, len(runs), LANES)]
    tally, taken, truth = ErrorTally(len(wanted)), [], None
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
                tally.add(len(taken), errors)
            taken.extend(t_ns[picked].tolist())
    if not truth:
        raise ValueError(NO_OUTPUT)
    found = [group.final(truth[-1:]) for group in groups]
    return tally.result(runs, taken, [solved for solved, _ in found],
                        [errors for _, errors in found],
                        [run for group in groups for run in group.diverged])


@paused_in_blocks
def _navigated(settings, motion):
    """
    Yield blocks of ideal readings with what the strapdown needs.

    Each comes with the index of its first sample at which the strapdown runs, and with the
    instants and the Truth of the samples from there on.
    """
    clock = SampleClock(settings.strapdown, period_ns(settings.strapdown.rate_hz))
    start_ns = None
    for imu in ideal_blocks(settings, motion):
        t_ns = clock.instant(imu.t_ns)
        if start_ns is None:
            start_ns = int(t_ns[0]) + round(settings.strapdown.initial.after_s * 1e9)
        first = int(np.searchsorted(t_ns, start_ns))
        yield imu, first, t_ns[first:], motion.at(t_ns[first:])


def check_steerable_length(generator, motion):
    """Raise ValueError if runs of MotionGeneratorSettings on a motion have no finite length."""
    if generator.motion.kind == 'guided':
        # A guided motion only gets its length while it is steered.
        motion.length_s(generator.start_s, generator.duration_s)
    else:
        check_length(generator, motion)


def check_runs(settings, motion):
    """Raise ValueError if SimulationSettings do not define runs of finite length on a motion."""
    generator, after_s = settings.motion_generator, settings.strapdown.initial.after_s
    check_steerable_length(generator, motion)
    check_start(settings)
    if after_s > generator.duration_s > 0.0:
        raise ValueError(NO_OUTPUT)


def in_lanes(settings):
    """
    Return whether runs of SimulationSettings can be processed together.

    They cannot with tuned gyros, whose rotors are stepped in each run; with samples whose instants
    differ between runs; with other orientation methods than quaternion; and with guided motions.
    """
    sensor, strapdown = settings.imu_sensor, settings.strapdown
    sampler = Sampler(sensor.sampling, sensor.seed, 0, 'sampling', period_ns(sensor.rate_hz))
    return (sensor.gyro.model == 'ideal' and strapdown.orientation == 'quaternion'
            and sampler.perfect and settings.motion_generator.motion.kind != 'guided')
