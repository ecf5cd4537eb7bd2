"""Settings of a whole simulation: the settings of its nodes, checked against each other."""

from dataclasses import dataclass, replace

from .aided_navigator import AidedNavigatorSettings
from .catalogue import values_of
from .gnss import GnssSettings
from .guidance import check_guided
from .imu import DelaysUs, ImuSensorSettings
from .motion import MotionGeneratorSettings
from .strapdown import StrapdownSettings
from .velocity_meter import VelocityMeterSettings


@dataclass(frozen=True)
class SimulationSettings:
    """Settings of motion_generator, imu_sensor and strapdown."""

    motion_generator: MotionGeneratorSettings
    imu_sensor: ImuSensorSettings
    strapdown: StrapdownSettings

    def __post_init__(self):
        """Raise ValueError on contradictions that a live strapdown would report."""
        sends, expects = self.imu_sensor.rate_hz, self.strapdown.rate_hz
        if sends != expects:
            raise ValueError(f'strapdown: rate_hz is {expects:g} Hz; expected the rate of '
                             f'imu_sensor, {sends:g} Hz')
        if self.strapdown.standalone:
            raise ValueError(f'strapdown: initial.source is {self.strapdown.initial.source}; '
                             'expected truth, because an offline simulation compares the solution '
                             'with it (ins_sim navigate works without truth)')
        check_frames(self.motion_generator, imu_sensor=self.imu_sensor, strapdown=self.strapdown)
        if self.motion_generator.motion.kind == 'guided':
            check_guided(self.motion_generator, self.imu_sensor, self.lead_ns)

    @property
    def lead_ns(self):
        """Return the time by which a channel with negative delay reads the motion ahead, ns."""
        imu = self.imu_sensor
        return -min(0, *imu.gyro.delay_us.in_ns(), *imu.accelerometer.delay_us.in_ns())

    def without_delays(self):
        """Return the settings of the twin, the zero-delay reference run; other errors are kept."""
        imu = self.imu_sensor
        return replace(self, imu_sensor=replace(
            imu, gyro=replace(imu.gyro, delay_us=DelaysUs()),
            accelerometer=replace(imu.accelerometer, delay_us=DelaysUs())))

    @property
    def run(self):
        """Return the number of the run in an ensemble."""
        return self.imu_sensor.run

    def with_run(self, run):
        """Return the settings of another run of the ensemble."""
        return replace(self, imu_sensor=replace(self.imu_sensor, run=run))

    @property
    def delayed(self):
        """Return whether any channel has a delay."""
        imu = self.imu_sensor
        return imu.gyro.delay_us != DelaysUs() or imu.accelerometer.delay_us != DelaysUs()


def check_frames(generator, **nodes):
    """Raise ValueError unless all nodes have the frames and tf settings of the generator."""
    for node, settings in nodes.items():
        for group in ('frames', 'tf'):
            ours, theirs = (values_of(getattr(one, group)) for one in (settings, generator))
            for key, value in ours.items():
                if value != theirs[key]:
                    raise ValueError(f'{node}: {group}.{key} is {value!r}; expected the value of '
                                     f'motion_generator, {theirs[key]!r}, because all nodes share '
                                     'one TF tree')


# The nodes other than imu_sensor that draw random numbers.
DRAWING = ('velocity_meter', 'gnss', 'aided_navigator')
# Settings that an aiding sensor and the navigator must have in common.
AGREED = (('velocity_meter', ('rate_hz', 'window')), ('gnss', ('gnss',)))


@dataclass(frozen=True)
class AidedSimulationSettings:
    """Settings of the six nodes of an aided simulation; raises ValueError on contradictions."""

    simulation: SimulationSettings
    velocity_meter: VelocityMeterSettings
    gnss: GnssSettings
    aided_navigator: AidedNavigatorSettings

    def __post_init__(self):
        """Raise ValueError on contradictions that a live navigator would report with every fix."""
        navigator, sensor = self.aided_navigator, self.simulation.imu_sensor
        for name, keys in AGREED:
            for key in keys:
                theirs, ours = getattr(getattr(self, name), key), getattr(navigator, key)
                if theirs != ours:
                    raise ValueError(f'aided_navigator: {key} is {ours}; expected the value of '
                                     f'{name}, {theirs}, because both need the same times of the '
                                     'fixes')
        if navigator.rate_hz != sensor.rate_hz:
            raise ValueError(f'aided_navigator: rate_hz is {navigator.rate_hz:g} Hz; expected '
                             f'the rate of imu_sensor, {sensor.rate_hz:g} Hz')
        if navigator.input != sensor.output:
            raise ValueError(f'aided_navigator: input is {navigator.input}; expected the output '
                             f'of imu_sensor, {sensor.output}')
        check_frames(self.simulation.motion_generator, velocity_meter=self.velocity_meter,
                     gnss=self.gnss, aided_navigator=navigator)
        self._check_run()
        self._check_streams()
        self._check_route()
        self._check_steering()

    @property
    def run(self):
        """Return the number of the run in an ensemble."""
        return self.simulation.run

    def with_run(self, run):
        """Return the settings of another run of the ensemble."""
        return replace(self, simulation=self.simulation.with_run(run), **{
            node: replace(getattr(self, node), run=run) for node in DRAWING})

    def by_node(self):
        """Return {name of a node: its settings}."""
        nodes = {**vars(self.simulation), **vars(self)}
        del nodes['simulation']
        return nodes

    def _check_run(self):
        """Raise ValueError unless all nodes have the same run number."""
        for node in DRAWING:
            theirs = getattr(self, node).run
            if theirs != self.run:
                raise ValueError(f'{node}: run is {theirs}; expected the value of imu_sensor, '
                                 f'{self.run}, because all nodes must belong to one run of an '
                                 'ensemble')

    def _check_streams(self):
        """Raise ValueError on rates and stamps that live nodes would report with every message."""
        generator, sensor = self.simulation.motion_generator, self.simulation.imu_sensor
        sent = generator.rate_hz
        if self.velocity_meter.rate_hz != sent:
            raise ValueError(f'velocity_meter: rate_hz is {self.velocity_meter.rate_hz:g} Hz; '
                             f'expected the rate of motion_generator, {sent:g} Hz, because a '
                             'cycle lasts from one truth sample to the next')
        if self.gnss.rate_hz > sent:
            raise ValueError(f'gnss: rate_hz is {self.gnss.rate_hz:g} Hz; expected at most the '
                             f'rate of motion_generator, {sent:g} Hz')
        for key in ('jitter_us', 'latency_us'):
            value = getattr(sensor.sampling, key)
            if value:
                raise ValueError(f'imu_sensor: sampling.{key} is {value:g} us; expected 0 with '
                                 'aided_navigator, which needs the truth at the stamp of each '
                                 'IMU sample')

    def _check_steering(self):
        """Raise ValueError if fixes, and so the steering, would wait for the strapdown."""
        simulation = self.simulation
        if (simulation.motion_generator.motion.kind == 'guided'
                and self.velocity_meter.attack_angle == 'ins'
                and simulation.strapdown.output_every != 1):
            raise ValueError(f'strapdown: output_every is {simulation.strapdown.output_every} '
                             'with motion.kind guided and attack_angle ins; expected 1, because '
                             'velocity_meter waits for the solution of strapdown at the end of a '
                             'window')

    def _check_route(self):
        """Raise ValueError unless the orthodromic coordinates refer to the route that is flown."""
        points, motion = self.aided_navigator.motion.route.points, \
            self.simulation.motion_generator.motion
        if motion.kind in ('route', 'guided') and points != motion.route.points:
            raise ValueError('aided_navigator: motion.route.points differ from those of '
                             'motion_generator; expected the same route: set it under "/**", for '
                             'both nodes')
