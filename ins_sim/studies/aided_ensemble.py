"""Many runs of the whole aided chain: statistics of their errors, NEES and NIS, by blocks."""

from typing import NamedTuple

import numpy as np

from ins_sim.core.aiding.consistency import BLOCKS
from ins_sim.core.aiding.navigator import AidedNavigator
from ins_sim.core.ensemble.aided_runs import simulate_aided_runs
from ins_sim.core.ensemble.consistency import (ChiSquareSums, fix_sums, FixSums, merged_fixes,
                                               merged_sums, sums_of)
from ins_sim.core.ensemble.group import ERRORS
from ins_sim.core.numerics.instants import period_ns

# Runs of a block, which share the truth and the ideal readings.
RUNS = 8


class Consistency(NamedTuple):
    """
    NEES and NIS over runs.

    nees: ChiSquareSums (m, BLOCKS) at the instants of the statistics; fixes: {source: FixSums}.
    """

    nees: ChiSquareSums
    fixes: dict


class AidedWork:
    """
    The work on a block of runs, for ``jobs.blocks.run_blocks``.

    Parameters
    ----------
    settings : AidedSimulationSettings
    motion_of : callable
        Returns the motion of the settings; it can be pickled.
    every : int
        Samples of the IMU from one instant of the statistics to the next.

    """

    def __init__(self, settings, motion_of, every):
        self._settings, self._motion_of, self._every = settings, motion_of, every

    def errors(self, runs):
        """
        Return errors, NEES, its degrees of freedom and what else is known of runs.

        t_ns (m,); errors (m, runs, 9): attitude, velocity, position, NaN of a run that was
        refused or has diverged; nees, freedom (m, runs, BLOCKS); fixes: {source: FixSums};
        refused: {run: why}; restarted: {run: how many times a gap made it start anew}.
        """
        settings = self._settings
        flights = simulate_aided_runs(settings, self._motion_of(settings), runs, self._every)
        refused = {f.run: why for f in flights for why in [_why_not(f)] if why}
        kept = [f for f in flights if f.run not in refused]
        restarted = {f.run: len(f.result.faults) for f in kept if f.result.faults}
        step_ns = self._every * period_ns(settings.aided_navigator.rate_hz)
        first_ns = min((int(f.result.errors.t_ns[0]) for f in kept), default=0)
        places = [np.rint((f.result.errors.t_ns - first_ns) / step_ns).astype(int) for f in kept]
        count = max((int(p[-1]) + 1 for p in places), default=0)
        errors = np.full((count, len(runs), ERRORS), np.nan)
        nees = np.full((count, len(runs), len(BLOCKS)), np.nan)
        freedom = np.zeros((count, len(runs), len(BLOCKS)), dtype=np.int64)
        for flight, place in zip(kept, places):
            k, found = runs.index(flight.run), flight.result.errors
            errors[place, k] = np.hstack([found.attitude, found.velocity, found.position])
            nees[place, k], freedom[place, k] = flight.nees()
        sources = AidedNavigator(settings.aided_navigator).sources
        fixes = {source: fix_sums([f.result.judged for f in kept], source) for source in sources}
        return (first_ns + step_ns * np.arange(count), errors, nees, freedom, fixes, refused,
                restarted)


def _why_not(flight):
    """Return why a run does not count, or ''."""
    if flight.refused:
        return flight.refused
    if flight.result.diverged:
        return next(reversed(flight.result.faults))
    errors = flight.result.errors
    if not all(np.isfinite(a).all() for a in (errors.attitude, errors.velocity, errors.position)):
        return 'its errors are no numbers'
    return ''


def consistency_arrays(nees, freedom, fixes):
    """Return the arrays of a block of runs: NEES (m, runs, BLOCKS), and FixSums by source."""
    found = {f'nees_{name}': a for name, a in sums_of(nees, freedom)._asdict().items()}
    for source, one in fixes.items():
        if one is not None:
            found.update({f'{source}_t_ns': one.t_ns, f'{source}_taken': one.taken,
                          f'{source}_refused': one.refused})
            found.update({f'{source}_nis_{name}': a for name, a in one.sums._asdict().items()})
    return found


def consistency_of(arrays, sources):
    """Return the Consistency of the arrays of a block."""
    sums = {name: ChiSquareSums(*(arrays[f'{name}_{field}'] for field in ChiSquareSums._fields))
            for name in ('nees', *(f'{s}_nis' for s in sources if f'{s}_t_ns' in arrays))}
    fixes = {s: FixSums(arrays[f'{s}_t_ns'], sums[f'{s}_nis'], arrays[f'{s}_taken'],
                        arrays[f'{s}_refused']) for s in sources if f'{s}_t_ns' in arrays}
    return Consistency(sums['nees'], fixes)


def merged_consistency(a, b):
    """Return the Consistency of the runs of both; a block without a run has no instants."""
    if not len(a.nees.count) or not len(b.nees.count):
        return a if len(a.nees.count) else b
    fixes = dict(a.fixes)
    for source, other in b.fixes.items():
        fixes[source] = merged_fixes(fixes[source], other) if source in fixes else other
    return Consistency(merged_sums(a.nees, b.nees), fixes)
