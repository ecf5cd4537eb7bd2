"""Many runs of the whole aided chain; truth and ideal readings are computed once for all."""

from collections import deque

import numpy as np

from ins_sim.core.aiding.consistency import note_of
from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, METER
from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.motion.motion import check_length
from ins_sim.core.navigation.loop import WantedInstants
from ins_sim.core.numerics.garbage_collection import paused_in_blocks
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.core.sensors.velocity_meter.ins_means import WAIT_NS
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.sensors.velocity_meter.over_truth import MeterOnTruth
from ins_sim.core.simulation.aided_run import AidedChain
from ins_sim.core.simulation.inertial import (check_start, ideal_blocks, reading_count,
                                              RecentTruth, SensedRun, StrapdownRun, truth_blocks)
from ins_sim.core.simulation.normalised_errors import ErrorNormaliser
from ins_sim.core.timeseries.histories import NavStates


def simulate_aided_runs(settings, motion, runs, wanted_ns, progress=None):
    """
    Return the AidedFlights of several runs on the same motion.

    The solution of run k has the same bits as ``simulate`` and ``simulate_aided`` give for
    ``settings.with_run(k)``.

    Parameters
    ----------
    settings : AidedSimulationSettings
    motion : Motion
    runs : numbers of the runs
    wanted_ns : (m,) motion times of the outputs, ns; the next sample is used
    progress : function that is called with the fraction done, or None

    Raises
    ------
    ValueError
        If the settings are inconsistent. A failure during a run is recorded in its AidedFlight.
    """
    simulation = settings.simulation
    check_length(simulation.motion_generator, motion)
    check_start(simulation)
    recent = RecentTruth(motion)
    flights = [AidedFlight(settings, recent, run, wanted_ns) for run in runs]
    count = reading_count(simulation.motion_generator, period_ns(simulation.imu_sensor.rate_hz))
    done = 0
    for ideal, truth in _rounds(simulation, motion, recent):
        for flight in flights:
            flight.advance(ideal, truth)
        done += len(ideal)
        if progress is not None:
            progress(done / count)
    for flight in flights:
        flight.finish()
    return flights


@paused_in_blocks
def _rounds(settings, motion, recent):
    """
    Yield blocks of ideal ImuSamples, each with the Truth that the other instruments see.

    The Truth is a list of parts, at the instants of the generator from the end of the last block
    to the end of this one. After the last block the remaining Truth follows with an empty block.
    recent: RecentTruth of the motion.
    """
    generator, sensor = settings.motion_generator, settings.imu_sensor
    truths, rest, ideal = truth_blocks(generator, recent), None, None
    # An IMU with source motion needs more than the truth at its samples.
    source = motion if sensor.source == 'motion' else recent
    for ideal in ideal_blocks(settings, source):
        found, rest = _until(truths, rest, int(ideal.t_ns[-1]))
        yield ideal, found
    if ideal is not None:
        yield ideal[:0], [part for part in (rest, *truths) if part is not None and len(part)]


def _until(truths, rest, end_ns):
    """Return a list of parts of the Truth up to an instant, and what was read beyond it."""
    parts = []
    while True:
        if rest is None:
            rest = next(truths, None)
            if rest is None:
                return parts, None
        stop = int(np.searchsorted(rest.t_ns, end_ns, side='right'))
        if stop == len(rest):
            parts.append(rest)
            rest = None
            continue
        return (parts + [rest[:stop]] if stop else parts), rest[stop:]


class AidedFlight:
    """
    One run of the aided chain, block by block.

    Attributes
    ----------
    run : number of the run
    result : AidedResult with the FilterNote of each output instant, after ``finish``; None for a
        run that failed
    refused : reason of the failure, a sentence, or ''

    """

    def __init__(self, settings, motion, run, wanted_ns):
        settings = settings.with_run(run)
        simulation, navigator = settings.simulation, settings.aided_navigator
        self.run, self.result, self.refused = run, None, ''
        self._motion = motion
        self._sensed = SensedRun(simulation.imu_sensor)
        self._normaliser = ErrorNormaliser(settings, self._sensed.errors)
        sources = AidedNavigator(navigator).sources
        self._meter = self._gnss = self._strapdown = None
        if METER in sources:
            self._meter = MeterOnTruth(VelocityMeter(settings.velocity_meter))
            if settings.velocity_meter.attack_angle == 'ins':
                self._strapdown = StrapdownRun(simulation.strapdown, motion)
        if GNSS in sources:
            self._gnss = Gnss(settings.gnss)
        self._ins_ns, self._truth_ns = -1, -1
        dt_ns = period_ns(navigator.rate_hz)
        self._span_ns = navigator.window.cycles * dt_ns
        self._outputs = WantedInstants(wanted_ns, dt_ns)
        self._chain = AidedChain(navigator, note_of, self._outputs)
        # Blocks that still wait for fixes, and fixes that do not belong to a block yet.
        self._held, self._fixes = deque(), []

    def advance(self, ideal, truth):
        """Process ideal ImuSamples and a list of parts of the truth for the other instruments."""
        if self.refused:
            return
        try:
            self._sense(self._sensed.take(ideal), truth)
            while self._held and self._known_until(int(self._held[0][0].t_ns[-1])):
                self._fly()
        except ValueError as error:
            self._refuse(error)

    def finish(self):
        """Process the remaining blocks and complete the result."""
        if self.refused:
            return
        try:
            if self._meter is not None:
                self._add(METER, self._meter.finish())
            while self._held:
                self._fly()
            self.result = self._chain.finish()
        except ValueError as error:
            self._refuse(error)

    def _refuse(self, error):
        self.refused = str(error)
        self._held.clear()

    def _sense(self, imu, truths):
        if self._strapdown is not None:
            states = [s for _, s, _ in self._strapdown.take(imu)] if len(imu) else []
            if states:
                states = NavStates.concatenate(states)
                self._ins_ns = int(states.t_ns[-1])
                self._meter.follow_ins(states.t_ns, body_velocity(states))
            else:
                self._meter.follow_ins(np.empty(0, dtype=np.int64), np.empty((0, 3)))
        for truth in truths:
            self._truth_ns = int(truth.t_ns[-1])
            for source, instrument in ((METER, self._meter), (GNSS, self._gnss)):
                if instrument is not None:
                    self._add(source, instrument.advance(truth))
        if len(imu):
            self._held.append((imu, self._motion.at(imu.t_ns)))

    def _add(self, source, fixes):
        self._fixes += [(fix.arrival_ns, source, fix) for fix in fixes]

    def _known_until(self, end_ns):
        """Return whether all fixes that arrive up to an instant are known."""
        return (self._strapdown is None or self._ins_ns >= end_ns
                or self._truth_ns >= end_ns + WAIT_NS + self._span_ns)

    def _fly(self):
        imu, truth = self._held.popleft()
        fixes, self._fixes = self._fixes, []
        self._chain.block(imu, truth, fixes)

    @property
    def numbers(self):
        """Return the indices (n,) of the wanted instants that the result contains."""
        return self._outputs.numbers(self.result.errors.t_ns)

    def nees(self):
        """Return NEES and its degrees of freedom at the output instants, (n, BLOCKS) each."""
        return self._normaliser.of(self.result)
