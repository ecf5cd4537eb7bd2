"""Ensembles over many processes: their blocks, the work of one, and the result of all."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Callable
import warnings

import numpy as np

from ins_sim.core.ensemble.lanes import LANES
from ins_sim.core.ensemble.many_runs import in_lanes, simulate_runs
from ins_sim.core.ensemble.result import joined, of_arrays
from ins_sim.jobs.blocks import run_blocks
from ins_sim.jobs.fingerprint import fingerprint

MOST_RUNS, MOST_INSTANTS, INSTANTS = 10 ** 7, 10 ** 4, 61
# Upper limit of the parameter run.
LAST_RUN = 2 ** 31 - 1
# Number of runs in a block. Runs side by side share truth and ideal readings; a study should have
# enough blocks to be distributed evenly and to lose little with a worker.
MOST_GROUPS, ENOUGH_BLOCKS = 16, 16


@dataclass(frozen=True)
class EnsemblePlan:
    """
    Definition of an ensemble: runs of SimulationSettings, and the instants of the statistics.

    Attributes
    ----------
    settings : SimulationSettings; their run is the first one
    runs : number of runs
    instants : number of instants, evenly spaced from the start of the strapdown to the end, both
        included

    Raises
    ------
    ValueError
        For invalid numbers.
    """

    settings: Any
    runs: int
    instants: int = INSTANTS

    def __post_init__(self):
        """Check the numbers."""
        for name, value, least, most in (('runs', self.runs, 1, MOST_RUNS),
                                         ('instants', self.instants, 2, MOST_INSTANTS)):
            if isinstance(value, bool) or not isinstance(value, int) or not (
                    least <= value <= most):
                raise ValueError(f'{name} is {value!r}; expected a whole number from {least} to '
                                 f'{most}')
        if self.settings.run + self.runs - 1 > LAST_RUN:
            raise ValueError(f'run is {self.settings.run} with {self.runs} runs; expected a last '
                             f'one of at most {LAST_RUN}')

    @property
    def instants_s(self):
        """Return the motion times of the statistics (instants,), s."""
        generator = self.settings.motion_generator
        first = generator.start_s + self.settings.strapdown.initial.after_s
        last = generator.start_s + generator.duration_s
        return first + (last - first) * (np.arange(self.instants) / (self.instants - 1.0))

    def blocks(self):
        """
        Return the blocks, ranges of runs.

        They do not depend on the executor, because the last bits of the statistics depend on them.
        """
        unit = LANES if in_lanes(self.settings) else 1
        size = unit * min(MOST_GROUPS, -(-self.runs // (unit * ENOUGH_BLOCKS)))
        return self.cut_into(size)

    def cut_into(self, size):
        """Return the runs as ranges of at most ``size`` runs."""
        first = self.settings.run
        return [range(first + k, first + min(k + size, self.runs))
                for k in range(0, self.runs, size)]

    def identity(self):
        """Return the data that determine the numbers, for ``jobs.store.BlockStore``."""
        settings = self.settings
        return fingerprint({'motion_generator': settings.motion_generator,
                            'imu_sensor': settings.imu_sensor, 'strapdown': settings.strapdown},
                           study='monte-carlo', runs=self.runs, instants=self.instants)


@dataclass(frozen=True)
class EnsembleWork:
    """
    The work of a block of an EnsemblePlan: ``work(range of runs)`` returns arrays.

    read_motion: function MotionGeneratorSettings -> Motion that can be pickled.
    """

    plan: EnsemblePlan
    read_motion: Callable

    def __call__(self, runs):
        """Return ``EnsembleResult.arrays`` of some runs."""
        generator = self.plan.settings.motion_generator
        motion = motion_of(self.read_motion, generator)
        return simulate_runs(self.plan.settings, motion, runs, self.plan.instants_s).arrays()


@lru_cache(1)
def motion_of(read, generator):
    """Return the motion of settings; warnings about a recording are suppressed (already shown)."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore')
        return read(generator)


def fly_ensemble(plan, read_motion, executor, store=None, progress=None):
    """
    Run the ensemble of an EnsemblePlan and return the EnsembleResult.

    The bits of the result do not depend on the executor.

    Parameters
    ----------
    plan : EnsemblePlan
    read_motion : callable
        See EnsembleWork.
    executor, store, progress
        See ``run_blocks``.

    Raises
    ------
    ValueError
        As the stages do.
    """
    work = EnsembleWork(plan, read_motion)
    return joined(of_arrays(arrays) for _, arrays in run_blocks(
        work, plan.blocks(), executor, store, progress))
