"""
Offline simulation without aiding: sense a motion, navigate, and compare with the truth.

A twin is the same run with all channel delays set to zero; the difference shows what the delays
alone cause.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from ins_sim.core.motion.motion import check_length
from ins_sim.core.navigation.loop import NavigationLoop
from ins_sim.core.navigation.navigator import InertialNavigator
from ins_sim.core.navigation.sample_clock import SampleClock
from ins_sim.core.numerics.garbage_collection import paused_in_blocks
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.sensors.imu.sampling import Sampler
from ins_sim.core.sensors.imu.stream import StreamImu
from ins_sim.core.sensors.imu.turning import check_turning
from ins_sim.core.sensors.imu.with_errors import with_errors
from ins_sim.core.timeseries.collecting import Collected
from ins_sim.core.timeseries.histories import ImuSamples, NavErrors, NavStates, Truth

BLOCK = 4096


@dataclass(frozen=True)
class SimulationResult:
    """
    One offline run: truth, solution and errors at the output instants.

    Attributes
    ----------
    truth, states, errors : Truth, NavStates and NavErrors at these instants
    imu : all readings
    twin : the errors of the same run with all delays zero, or None
    faults : a sentence for each gap at which the strapdown started anew

    """

    truth: Truth
    imu: ImuSamples
    states: NavStates
    errors: NavErrors
    twin: NavErrors | None
    faults: tuple = ()


def imu_blocks(settings, motion):
    """Yield ImuSamples of a whole run in blocks, from the motion or from streamed truth."""
    return sensed_blocks(settings.imu_sensor, ideal_blocks(settings, motion))


@paused_in_blocks
def sensed_blocks(sensor, ideal):
    """Yield blocks of the ideal IMU with the errors of ImuSensorSettings added."""
    sensed = SensedRun(sensor)
    for block in ideal:
        block = sensed.take(block)
        if len(block):
            yield block


class SensedRun:
    """
    Adds the instrument errors of ImuSensorSettings to ideal readings, for one run.

    errors: its InstrumentErrors, or None for a perfect instrument.  Raises ValueError as
    ``with_errors`` does.
    """

    def __init__(self, sensor):
        self.errors = with_errors(sensor)
        self._sampler = Sampler(sensor.sampling, sensor.seed, sensor.run, 'sampling',
                                period_ns(sensor.rate_hz))

    def take(self, ideal):
        """Return ImuSamples with errors, given those of the ideal IMU; some may be held back."""
        return self._sampler.take(ideal if self.errors is None else self.errors.advance(ideal))


def reading_count(generator, dt_ns):
    """Return the number of readings of an IMU with sampling period dt_ns during the motion."""
    return _steps(generator) * period_ns(generator.rate_hz) // dt_ns + 1


def truth_blocks(generator, motion):
    """Yield the Truth at the instants of MotionGeneratorSettings, from the first to the last."""
    first_ns, steps = round(generator.start_s * 1e9), _steps(generator)
    for start in range(0, steps + 1, BLOCK):
        k = np.arange(start, min(start + BLOCK, steps + 1), dtype=np.int64)
        yield motion.at(first_ns + period_ns(generator.rate_hz) * k)


def ideal_blocks(settings, motion):
    """Yield blocks of ImuSamples without the errors that ``sensed_blocks`` adds."""
    generator, sensor = settings.motion_generator, settings.imu_sensor
    first_ns = round(generator.start_s * 1e9)
    if sensor.source == 'motion':
        check_turning(sensor, motion, generator.start_s, generator.duration_s)
        imu = MotionImu(sensor, motion, first_ns)
        left = reading_count(generator, imu.dt_ns)
        while left > 0:
            yield imu.advance(min(BLOCK, left))
            left -= BLOCK
        return
    imu = StreamImu(sensor)
    for truth in truth_blocks(generator, motion):
        block = imu.advance(truth)
        if len(block):
            yield block


@paused_in_blocks
def navigate_blocks(settings, motion, blocks, faults=None, covariance=None):
    """
    Run the strapdown over blocks of ImuSamples, with the truth from the motion.

    Parameters
    ----------
    settings : StrapdownSettings
    motion : Motion
    blocks : iterable of ImuSamples
    faults : list, to which a sentence is appended for each gap, or None
    covariance : FreeCovariance to propagate, or None

    Yields
    ------
    truth, states, errors : records at the output instants of each block

    Raises
    ------
    ValueError : at a gap, if on_fault is ``stop``; otherwise the strapdown starts anew there,
        from the truth

    """
    strapdown = StrapdownRun(settings, motion, faults, covariance)
    for imu in blocks:
        yield from strapdown.take(imu)


class StrapdownRun:
    """The strapdown of one run; for the arguments see ``navigate_blocks``."""

    def __init__(self, settings, motion, faults=None, covariance=None):
        dt_ns = period_ns(settings.rate_hz)
        self._motion, self._clock = motion, SampleClock(settings, dt_ns)
        self._loop = NavigationLoop(partial(InertialNavigator, settings, covariance), dt_ns,
                                    settings.output_every, settings.on_fault, faults)

    def take(self, imu):
        """Yield (truth, states, errors) at the output instants among ImuSamples."""
        t_ns = self._clock.instant(imu.t_ns)
        truth = self._motion.at(t_ns)
        for first, (states, errors), due in self._loop.run_block(t_ns, imu.omega, imu.f, truth):
            yield truth[first:first + len(states)][due], states[due], errors[due]


class RecentTruth:
    """The truth of a motion; repeated requests for the last instants are not recomputed."""

    def __init__(self, motion):
        self._motion, self._last = motion, None

    def at(self, t_ns):
        """Return the Truth at instants."""
        last = self._last
        if last is not None and len(t_ns) and t_ns[0] >= last.t_ns[0] and (
                t_ns[-1] <= last.t_ns[-1]):
            k = np.minimum(np.searchsorted(last.t_ns, t_ns), len(last) - 1)
            if np.array_equal(last.t_ns[k], t_ns):
                return last if len(k) == len(last) else last[k]
        self._last = self._motion.at(t_ns)
        return self._last


def simulate(settings, motion, twin=True, progress=None, collect=Collected):
    """
    Return the SimulationResult of SimulationSettings.

    Parameters
    ----------
    settings : SimulationSettings
    motion : Motion of settings.motion_generator
    twin : whether to repeat the run with all delays set to zero
    progress : called with the fraction done
    collect : called once for each history; returns an object that receives the blocks and gives
        the whole, such as Collected, which keeps it in memory

    Raises
    ------
    ValueError : if the run has no finite length

    """
    generator = settings.motion_generator
    check_length(generator, motion)
    check_start(settings)
    twin = twin and settings.delayed
    total = 1.0 + _steps(generator)
    total *= period_ns(generator.rate_hz) * (2 if twin else 1)
    first_ns = round(generator.start_s * 1e9)
    faults = []

    def watch(blocks, done):
        for imu in blocks:
            yield imu
            if progress is not None:
                progress((done + imu.t_ns[-1] - first_ns) / total)

    if settings.imu_sensor.source == 'stream':
        # IMU and navigation request the truth at the same instants.
        motion = RecentTruth(motion)
    sensed, flown = collect(), [collect() for _ in (Truth, NavStates, NavErrors)]
    blocks = watch(_kept(imu_blocks(settings, motion), sensed), 0)
    for parts in navigate_blocks(settings.strapdown, motion, blocks, faults):
        for store, part in zip(flown, parts):
            store.append(part)
    imu, (truth, states, errors) = sensed.history(), (store.history() for store in flown)
    if truth is None:
        raise ValueError('the run has no navigation output; expected duration_s longer than '
                         'initial.after_s')
    twin_errors = None
    if twin:
        store = collect()
        blocks = watch(_until(int(imu.t_ns[-1]), imu_blocks(
            settings.without_delays(), motion)), total / 2)
        for _, _, part in navigate_blocks(settings.strapdown, motion, blocks):
            store.append(part)
        twin_errors = store.history()
    return SimulationResult(truth, imu, states, errors, twin_errors, tuple(faults))


def withheld_readings(settings):
    """
    Return the number of readings at the end of a run that are missing, for lack of later truth.

    A channel with negative delay reads the future; on streamed truth its last readings would need
    truth from beyond the end.
    """
    generator, sensor = settings.motion_generator, settings.imu_sensor
    if sensor.source != 'stream':
        return 0
    lead_ns = -min(0, *sensor.gyro.delay_us.in_ns(), *sensor.accelerometer.delay_us.in_ns())
    dt_ns, span_ns = period_ns(sensor.rate_hz), _steps(generator) * period_ns(generator.rate_hz)
    # The first one contains only the first instant.
    return span_ns // dt_ns - max(0, (span_ns - lead_ns) // dt_ns)


def _until(last_ns, blocks):
    """Yield the readings up to an instant, so that a twin has the same readings as the run."""
    for block in blocks:
        if block.t_ns[-1] > last_ns:
            block = block[:int(np.searchsorted(block.t_ns, last_ns, side='right'))]
        if len(block):
            yield block


def _kept(blocks, store):
    for block in blocks:
        store.append(block)
        yield block


def check_start(settings):
    """Raise ValueError if nominal instants, multiples of the period, would not hit the start."""
    start_s, dt_ns = settings.motion_generator.start_s, period_ns(settings.imu_sensor.rate_hz)
    if settings.strapdown.imu_time == 'nominal' and round(1e9 * start_s) % dt_ns:
        raise ValueError(f'motion_generator: start_s is {start_s:.9g} s with imu_time nominal; '
                         f'expected a multiple of the period of the IMU, {dt_ns * 1e-9:.9g} s')


def _steps(generator):
    return round(generator.duration_s * 1e9) // period_ns(generator.rate_hz)
