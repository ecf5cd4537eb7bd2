"""Runs of an ensemble that cannot be processed together: each is simulated alone."""

from dataclasses import replace

import numpy as np

from ins_sim.core.navigation.whole_run import SOLVED
from ins_sim.core.simulation.guided_flight import fly
from ins_sim.core.simulation.inertial import imu_blocks, navigate_blocks
from ins_sim.core.streams.faults import StreamFault
from .group import ERRORS
from .lanes import LANES
from .result import ErrorTally


def simulate_each(settings, motion, runs, wanted_ns, initial=None):
    """
    Return the EnsembleResult of runs simulated one after the other; see ``simulate_runs``.

    A run with jitter of the stamps, or with lost samples, has its own instants: the statistics use
    its first solution at or after the wanted instant, or its last one if the run ends earlier. A
    guided motion is steered by the solution of each run.

    Parameters
    ----------
    settings, motion, runs, initial : see ``many_runs.simulate_runs``
    wanted_ns : (m,) int64 instants of the statistics, ns
    """
    generator = settings.motion_generator
    begin_ns = round(1e9 * generator.start_s) + round(1e9 * settings.strapdown.initial.after_s)
    end_ns = round(1e9 * (generator.start_s + generator.duration_s))
    # An instant before the start counts as the start.
    wanted_ns = np.unique(np.maximum(wanted_ns[wanted_ns <= end_ns], begin_ns))
    flights = [_Flight(wanted_ns) for _ in runs]
    for run, flight in zip(runs, flights):
        chosen = settings.with_run(run)
        strapdown = replace(chosen.strapdown, output_every=1)
        if initial is not None:
            strapdown = replace(strapdown, initial=initial(run))
        flight.follow(replace(chosen, strapdown=strapdown), motion)
    tally = ErrorTally(len(wanted_ns))
    for first in range(0, len(flights), LANES):
        tally.add(0, np.stack([flight.errors for flight in flights[first:first + LANES]], axis=1))
    return tally.result(
        runs, wanted_ns, [flight.final[None] for flight in flights],
        [flight.final_errors[None] for flight in flights],
        [run for run, flight in zip(runs, flights) if flight.lost],
        [(run, flight.restarts) for run, flight in zip(runs, flights) if flight.restarts])


class _Flight:
    """One run: its errors at the wanted instants (NaN if it failed) and at its end."""

    def __init__(self, wanted_ns):
        self._wanted_ns, self._taken = wanted_ns, 0
        self.errors = np.full((len(wanted_ns), ERRORS), np.nan)
        self.final, self.final_errors = np.full(SOLVED, np.nan), np.full(ERRORS, np.nan)
        self.lost, self.restarts = False, 0

    def follow(self, settings, motion):
        """Simulate the run."""
        faults = []
        try:
            fly(settings, motion)
            for _, states, errors in navigate_blocks(settings.strapdown, motion,
                                                     imu_blocks(settings, motion), faults):
                self._take(states, errors)
                if self.lost:
                    break
        except StreamFault:
            # The rotors of tuned gyros diverged, or a navigator cannot continue.
            self.lost = True
        self.lost = self.lost or not np.isfinite(self.final_errors).all()
        if self.lost:
            self.final[:], self.final_errors[:] = np.nan, np.nan
        else:
            self.errors[self._taken:] = self.final_errors
        self.restarts = len(faults)

    def _take(self, states, errors):
        """Process a block of the solution."""
        rows = np.concatenate([errors.attitude, errors.velocity, errors.position], axis=1)
        ends = np.searchsorted(errors.t_ns, self._wanted_ns[self._taken:])
        found = rows[ends[ends < len(rows)]]
        self.errors[self._taken:self._taken + len(found)] = found
        self._taken += len(found)
        self.final = np.concatenate([[states.lat[-1], states.lon[-1], states.height[-1]],
                                     states.v_n[-1], states.q_nb[-1]])
        self.final_errors = rows[-1]
        self.lost = not np.isfinite(rows).all()
