"""Ensembles of the complete aided chain: statistics of errors, NEES and NIS over many runs."""

from dataclasses import dataclass
from typing import Callable, NamedTuple

import numpy as np

from ins_sim.core.aiding.consistency import BLOCKS
from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, METER
from ins_sim.core.ensemble.aided_runs import simulate_aided_runs
from ins_sim.core.ensemble.consistency import (ChiSquareSums, fix_sums, FixSums, merged_fixes,
                                               merged_sums, sums_of)
from ins_sim.core.ensemble.group import ERRORS
from ins_sim.core.ensemble.many_runs import check_steerable_length
from ins_sim.core.ensemble.result import EnsembleResult, ErrorTally, joined, of_arrays
from ins_sim.core.navigation.whole_run import SOLVED
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.simulation.aided import make_instruments
from ins_sim.core.simulation.guided_flight import fly
from ins_sim.core.simulation.inertial import check_start, reading_count, withheld_readings
from ins_sim.jobs.blocks import run_blocks
from ins_sim.jobs.fingerprint import fingerprint
from .ensembles import ENOUGH_BLOCKS, EnsemblePlan, motion_of

# Number of runs in a block; they share the truth and the ideal readings.
MOST_RUNS = 8
SOURCES = (METER, GNSS)


class Consistency(NamedTuple):
    """
    NEES and NIS over runs.

    nees: ChiSquareSums (m, core.aiding.consistency.BLOCKS) at the instants of the statistics;
    fixes: {source: FixSums} of the aiding instruments.
    """

    nees: ChiSquareSums
    fixes: dict

    def arrays(self):
        """
        Return {name: array}: NEES (nees_*), and for each source its fixes and their NIS (*_nis_*).
        """
        found = {f'nees_{name}': a for name, a in self.nees._asdict().items()}
        for source, one in self.fixes.items():
            found.update({f'{source}_t_ns': one.t_ns, f'{source}_taken': one.taken,
                          f'{source}_refused': one.refused})
            found.update({f'{source}_nis_{name}': a for name, a in one.sums._asdict().items()})
        return found


@dataclass(frozen=True, eq=False)
class AidedEnsembleResult:
    """
    Statistics of many runs of the aided chain.

    Attributes
    ----------
    errors : EnsembleResult of the aided solution; the attitude error is that of q_nb, where
        solution and truth each refer to their own n
    consistency : Consistency of the runs
    refused : pairs (excluded run, reason)
    """

    errors: EnsembleResult
    consistency: Consistency
    refused: tuple

    def arrays(self):
        """Return {name: array} of the complete result."""
        return {**self.errors.arrays(), **self.consistency.arrays(),
                'refused': np.array([why for _, why in self.refused], dtype=str)}


def of_aided_arrays(arrays):
    """Return the AidedEnsembleResult of ``AidedEnsembleResult.arrays``."""
    def sums(name):
        return ChiSquareSums(*(arrays[f'{name}_{field}'] for field in ChiSquareSums._fields))

    errors = of_arrays(arrays)
    fixes = {s: FixSums(arrays[f'{s}_t_ns'], sums(f'{s}_nis'), arrays[f'{s}_taken'],
                        arrays[f'{s}_refused']) for s in SOURCES if f'{s}_t_ns' in arrays}
    return AidedEnsembleResult(errors, Consistency(sums('nees'), fixes),
                               tuple(zip(errors.diverged, arrays['refused'].tolist())))


def joined_aided(results):
    """Merge AidedEnsembleResults of different runs, as ``core.ensemble.result.joined`` does."""
    consistency, refused = None, ()

    def errors():
        nonlocal consistency, refused
        for part in results:
            consistency = (part.consistency if consistency is None
                           else _merged(consistency, part.consistency))
            refused += part.refused
            yield part.errors

    whole = joined(errors())
    return AidedEnsembleResult(whole, consistency, refused)


def _merged(a, b):
    """Return the Consistency of the runs of both."""
    return Consistency(merged_sums(a.nees, b.nees),
                       {s: merged_fixes(a.fixes[s], b.fixes[s]) for s in a.fixes})


@dataclass(frozen=True)
class AidedPlan(EnsemblePlan):
    """An EnsemblePlan of AidedSimulationSettings; its instants start with the aided solution."""

    @property
    def wanted_ns(self):
        """Return the motion times of the statistics (instants,), ns."""
        simulation = self.settings.simulation
        generator, navigator = simulation.motion_generator, self.settings.aided_navigator
        dt_ns, first_ns = period_ns(navigator.rate_hz), round(1e9 * generator.start_s)
        readings = reading_count(generator, dt_ns) - withheld_readings(simulation)
        last_ns = first_ns + dt_ns * (readings - 1)
        first_ns += round(1e9 * navigator.initial.after_s)
        if first_ns > last_ns:
            raise ValueError(f'aided_navigator: initial.after_s is {navigator.initial.after_s:g} '
                             f's; expected at most duration_s, {generator.duration_s:g} s')
        parts = np.arange(self.instants) / (self.instants - 1.0)
        return np.unique(first_ns + np.rint((last_ns - first_ns) * parts).astype(np.int64))

    def blocks(self):
        """Return the blocks, ranges of runs; they do not depend on the executor."""
        return self.cut_into(min(MOST_RUNS, -(-self.runs // ENOUGH_BLOCKS)))

    def identity(self):
        """Return the data that determine the numbers, for ``jobs.store.BlockStore``."""
        return fingerprint(self.settings.by_node(), study='monte-carlo --aided', runs=self.runs,
                           instants=self.instants)


@dataclass(frozen=True)
class AidedWork:
    """
    The work of a block of an AidedPlan: ``work(range of runs)`` returns arrays.

    read_motion: function MotionGeneratorSettings -> Motion that can be pickled.
    """

    plan: AidedPlan
    read_motion: Callable

    def __call__(self, runs):
        """Return ``AidedEnsembleResult.arrays`` of some runs."""
        settings, wanted_ns = self.plan.settings, self.plan.wanted_ns
        generator = settings.simulation.motion_generator
        motion = motion_of(self.read_motion, generator)
        if generator.motion.kind != 'guided':
            flights = simulate_aided_runs(settings, motion, runs, wanted_ns)
        else:
            flights = [flight for run in runs for flight in _steered(settings, motion, run,
                                                                     wanted_ns)]
        return result_of(settings, runs, wanted_ns, flights).arrays()


def _steered(settings, motion, run, wanted_ns):
    """Return a list with the AidedFlight of a run that steers the motion."""
    chosen = settings.with_run(run)
    fly(chosen.simulation, motion, chosen)
    return simulate_aided_runs(settings, motion, [run], wanted_ns)


def result_of(settings, runs, wanted_ns, flights):
    """Return the AidedEnsembleResult of the AidedFlights of a range of runs."""
    count = len(wanted_ns)
    errors = np.full((count, len(runs), ERRORS), np.nan)
    nees = np.full((count, len(runs), len(BLOCKS)), np.nan)
    freedom = np.zeros(nees.shape, dtype=np.int64)
    final, refused, restarted, judged = np.full((len(runs), SOLVED), np.nan), [], [], []
    for k, flight in enumerate(flights):
        why = why_not(flight)
        if why:
            refused.append((flight.run, why))
            continue
        result, rows = flight.result, flight.numbers
        errors[rows, k] = np.hstack([result.errors.attitude, result.errors.velocity,
                                     result.errors.position])
        nees[rows, k], freedom[rows, k] = flight.nees()
        lat, lon, height, v_n, q_nb = result.states.one(-1)
        final[k] = lat, lon, height, *v_n, *q_nb
        judged.append(result.judged)
        if result.faults:
            restarted.append((flight.run, len(result.faults)))
    tally = ErrorTally(count)
    tally.add(0, errors)
    sources = AidedNavigator(settings.aided_navigator).sources
    return AidedEnsembleResult(
        tally.result(runs, wanted_ns, [final], [errors[-1]], [run for run, _ in refused],
                     restarted),
        Consistency(sums_of(nees, freedom), {s: fix_sums(judged, s) for s in sources}),
        tuple(refused))


def why_not(flight):
    """Return the reason for which an AidedFlight is excluded, or ''."""
    if flight.refused:
        return flight.refused
    if flight.result.diverged:
        return flight.result.faults[-1]
    errors = flight.result.errors
    if not all(np.isfinite(a).all() for a in (errors.attitude, errors.velocity, errors.position)):
        return 'its errors are no numbers'
    return ''


def fly_aided_ensemble(plan, read_motion, executor, store=None, progress=None):
    """
    Run the ensemble of an AidedPlan and return the AidedEnsembleResult.

    The bits of the result do not depend on the executor. For the arguments see ``fly_ensemble``.
    Raises ValueError as the stages do.
    """
    work = AidedWork(plan, read_motion)
    return joined_aided(of_aided_arrays(arrays) for _, arrays in run_blocks(
        work, plan.blocks(), executor, store, progress))


def check_aided_flight(plan, motion):
    """Raise ValueError, before any worker starts, if the settings do not define a run."""
    check_steerable_length(plan.settings.simulation.motion_generator, motion)
    check_start(plan.settings.simulation)
    make_instruments(plan.settings)
    plan.wanted_ns
