"""The whole aided chain offline: six stages, the numbers of the six nodes in lock-step."""

from dataclasses import dataclass, replace

from ins_sim.core.aiding.navigator import AidedNavigator
from ins_sim.core.earth.great_circle import Route
from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.sensors.velocity_meter.over_truth import MeterOnTruth
from ins_sim.settings.aided_navigator import AidedNavigatorSettings
from ins_sim.settings.gnss import GnssSettings
from ins_sim.settings.velocity_meter import VelocityMeterSettings
from .aided_run import aid, Reported, with_truth
from .inertial import Settings, truth_blocks

# what both sides of a fix must have alike: (instrument, keys)
AGREED = (('velocity_meter', ('rate_hz', 'window')), ('gnss', ('gnss',)))


@dataclass(frozen=True)
class AidedSettings:
    """Settings of the six stages; raises ValueError where both sides of a fix do not agree."""

    simulation: Settings
    velocity_meter: VelocityMeterSettings
    gnss: GnssSettings
    aided_navigator: AidedNavigatorSettings

    def __post_init__(self):
        """Refuse what a live navigator would report with every fix."""
        navigator, sensor = self.aided_navigator, self.simulation.imu_sensor
        for name, keys in AGREED:
            for key in keys:
                theirs, ours = getattr(getattr(self, name), key), getattr(navigator, key)
                if theirs != ours:
                    raise ValueError(f'aided_navigator: {key} is {ours}; expected that of {name}, '
                                     f'{theirs}: a fix has one schedule on both sides')
        if navigator.rate_hz != sensor.rate_hz:
            raise ValueError(f'aided_navigator: rate_hz is {navigator.rate_hz:g} Hz; expected '
                             f'that of imu_sensor, {sensor.rate_hz:g} Hz')
        if navigator.input != sensor.output:
            raise ValueError(f'aided_navigator: input is {navigator.input}; expected the output '
                             f'of imu_sensor, {sensor.output}')
        self._check_streams()
        self._check_route()
        # what does not go together within a stage is said by the stage, before the run
        self.instruments()
        AidedNavigator(navigator)

    def _check_streams(self):
        """Refuse streams that the live stages would report with every message."""
        generator, sensor = self.simulation.motion_generator, self.simulation.imu_sensor
        sent = generator.rate_hz
        if self.velocity_meter.rate_hz != sent:
            raise ValueError(f'velocity_meter: rate_hz is {self.velocity_meter.rate_hz:g} Hz; '
                             f'expected that of motion_generator, {sent:g} Hz: a cycle is from '
                             'truth to truth')
        if self.gnss.rate_hz > sent:
            raise ValueError(f'gnss: rate_hz is {self.gnss.rate_hz:g} Hz; expected at most that '
                             f'of motion_generator, {sent:g} Hz')
        for key in ('jitter_us', 'latency_us'):
            value = getattr(sensor.sampling, key)
            if value:
                raise ValueError(f'imu_sensor: sampling.{key} is {value:g} us; expected 0 with '
                                 'aided_navigator, which needs the truth of the same stamp')

    def _check_route(self):
        """Refuse a route that orthodromic coordinates cannot refer to, or another one."""
        points, motion = self.aided_navigator.motion.route.points, \
            self.simulation.motion_generator.motion
        try:
            Route.of_points(points)
        except ValueError as error:
            raise ValueError(f'aided_navigator: {error}') from None
        if motion.kind == 'route' and points != motion.route.points:
            raise ValueError('aided_navigator: motion.route.points are not those of '
                             'motion_generator; expected the route that is flown: name it under '
                             '"/**", for both')

    def instruments(self, ins=None):
        """Return the velocity meter and GNSS on the truth, new ones; ins: as of MeterOnTruth."""
        return MeterOnTruth(VelocityMeter(self.velocity_meter), ins), Gnss(self.gnss)


def simulate_aided(settings, motion, run, progress=None):
    """
    Return the AidedRun on a Run of the first three stages.

    settings: AidedSettings; motion: that of the run; run: simulation.Run, whose solution, as often
    as it is put out, gives the velocity meter the angle of attack, as it does on ins/odometry;
    progress: called with the fraction done.  The instruments see the truth of the generator,
    whatever the IMU loses.  Raises ValueError as the stages do.
    """
    meter, gnss = settings.instruments((run.states.t_ns, body_velocity(run.states)))
    generator = settings.simulation.motion_generator
    velocity_fixes, gnss_fixes = [], []
    done, total = 0, 2 * len(run.imu)

    def went(count):
        nonlocal done
        done += count
        if progress is not None:
            progress(min(1.0, done / total))

    for truth in truth_blocks(generator, motion):
        velocity_fixes += meter.fixes(truth)
        gnss_fixes += gnss.fixes(truth)
        went(len(truth))
    velocity_fixes += meter.finish()

    def blocks():
        for imu in _blocks(run.imu):
            yield imu
            went(len(imu))

    flown = aid(settings.aided_navigator, with_truth(motion, blocks()), Reported(velocity_fixes),
                Reported(gnss_fixes))
    return replace(flown, velocity_fixes=tuple(velocity_fixes), gnss_fixes=tuple(gnss_fixes))


def _blocks(imu, length=4096):
    for first in range(0, len(imu), length):
        yield imu[first:first + length]
