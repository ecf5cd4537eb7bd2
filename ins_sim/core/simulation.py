"""The whole chain offline: motion, IMU, strapdown, errors, and the zero-delay twin."""

from dataclasses import dataclass, replace

import numpy as np

from .imu import MotionImu, period_ns
from .imu_stream import StreamImu
from .instrument import with_errors
from .map_frame import MapFrame
from .motions import check_length, make_motion
from .navigator import Strapdown
from .records import ImuSamples, NavErrors, NavStates, Truth
from .settings import DelaysUs, ImuSensorSettings, MotionGeneratorSettings, StrapdownSettings

BLOCK = 4096


@dataclass(frozen=True)
class Run:
    """
    One offline run: the truth, the solution and its errors at the output instants.

    imu holds every reading; twin the errors of the same run with all delays zero (or None).
    """

    truth: Truth
    imu: ImuSamples
    states: NavStates
    errors: NavErrors
    twin: NavErrors | None


@dataclass(frozen=True)
class Settings:
    """Settings of the three stages."""

    motion_generator: MotionGeneratorSettings
    imu_sensor: ImuSensorSettings
    strapdown: StrapdownSettings

    def __post_init__(self):
        """Refuse rates that do not go together; a live strapdown reports them."""
        sends, expects = self.imu_sensor.rate_hz, self.strapdown.rate_hz
        if sends != expects:
            raise ValueError(f'strapdown: rate_hz is {expects:g} Hz; expected that of imu_sensor, '
                             f'{sends:g} Hz')

    def without_delays(self):
        """Return the settings of the zero-delay twin; it has the same instrument errors."""
        imu = self.imu_sensor
        return replace(self, imu_sensor=replace(
            imu, gyro=replace(imu.gyro, delay_us=DelaysUs()),
            accelerometer=replace(imu.accelerometer, delay_us=DelaysUs())))

    @property
    def delayed(self):
        """Return whether any channel is late."""
        imu = self.imu_sensor
        return imu.gyro.delay_us != DelaysUs() or imu.accelerometer.delay_us != DelaysUs()


def sense(settings, motion):
    """Yield blocks of ImuSamples of a whole run, from the motion or through the stream."""
    errors = with_errors(settings.imu_sensor)
    for block in _ideal(settings, motion):
        yield block if errors is None else errors.advance(block)


def _ideal(settings, motion):
    generator, sensor = settings.motion_generator, settings.imu_sensor
    first_ns = round(generator.start_s * 1e9)
    steps = _steps(generator)
    if sensor.source == 'motion':
        imu = MotionImu(sensor, motion, first_ns)
        left = steps * period_ns(generator.rate_hz) // imu.dt_ns + 1
        while left > 0:
            yield imu.advance(min(BLOCK, left))
            left -= BLOCK
        return
    imu, frame = StreamImu(sensor), MapFrame(sensor.datum, sensor.earth.rotation)
    for start in range(0, steps + 1, BLOCK):
        k = np.arange(start, min(start + BLOCK, steps + 1), dtype=np.int64)
        truth = motion.at(first_ns + period_ns(generator.rate_hz) * k)
        readings = []
        for sample in zip(truth.t_ns.tolist(), frame.attitude(truth).tolist(),
                          truth.omega_ib_b.tolist(), truth.f_ib_b.tolist()):
            readings.extend(imu.push(*sample))
        if readings:
            t_ns, omega, f = zip(*readings)
            yield ImuSamples(np.array(t_ns, dtype=np.int64), np.array(omega), np.array(f))


def navigate(settings, motion, blocks):
    """
    Run the strapdown over blocks of ImuSamples, the truth coming from the motion.

    Yield (truth, states, errors) records of the output instants of each block.
    """
    nav, every = Strapdown(settings), settings.output_every
    count = 0
    for imu in blocks:
        truth = motion.at(imu.t_ns)
        kept, solutions, errors = [], [], []
        samples = zip(imu.t_ns.tolist(), imu.omega.tolist(), imu.f.tolist(), truth.lat.tolist(),
                      truth.lon.tolist(), truth.height.tolist(), truth.v_n.tolist(),
                      truth.q_nb.tolist())
        for k, (t_ns, omega, f, *now) in enumerate(samples):
            if not nav.step(t_ns, omega, f, now):
                continue
            error = nav.errors(t_ns, now)
            if count % every == 0:
                kept.append(k)
                solutions.append(nav.solution(t_ns))
                errors.append(error)
            count += 1
        if kept:
            t_ns = imu.t_ns[kept]
            yield (truth[kept], NavStates(t_ns, *map(np.array, zip(*solutions))),
                   NavErrors(t_ns, *map(np.array, zip(*errors))))


def simulate(settings, twin=True, progress=None):
    """
    Return the Run of Settings.

    twin: also run with all delays zero.  progress: called with the fraction done.  Raises
    ValueError where the settings name no run of finite length.
    """
    generator = settings.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    check_length(generator, motion)
    twin = twin and settings.delayed
    total = 1.0 + _steps(generator)
    total *= period_ns(generator.rate_hz) * (2 if twin else 1)

    def watch(blocks, done):
        for imu in blocks:
            yield imu
            if progress is not None:
                progress((done + imu.t_ns[-1] - first_ns) / total)

    first_ns = round(generator.start_s * 1e9)
    imu = []

    def keep(blocks):
        for block in blocks:
            imu.append(block)
            yield block

    parts = list(navigate(settings.strapdown, motion, keep(watch(sense(settings, motion), 0))))
    if not parts:
        raise ValueError('the run has no navigation output; expected duration_s longer than '
                         'initial.after_s')
    truth, states, errors = (cls.concatenate(p) for cls, p in zip(
        (Truth, NavStates, NavErrors), zip(*parts)))
    twin_errors = None
    if twin:
        ideal = settings.without_delays()
        blocks = watch(sense(ideal, motion), total / 2)
        twin_errors = NavErrors.concatenate(e for _, _, e in navigate(settings.strapdown, motion,
                                                                      blocks))
    return Run(truth, ImuSamples.concatenate(imu), states, errors, twin_errors)


def _steps(generator):
    return round(generator.duration_s * 1e9) // period_ns(generator.rate_hz)
