"""
Settings of the nodes as frozen dataclasses: default, unit, bounds and doc of every key.

This catalogue is the only place a parameter is described.  ROS parameters, the YAML reader and
the configuration reference are derived from it.
"""

from .dtg_settings import Dtg
from .error_settings import AccelerometerErrors, GyroErrors, Sampling, Temperature
from .place_settings import Datum, Earth, Time, Topics
from .route_settings import FlightRoute
from .setting import group, setting, Settings, settings_class


@settings_class
class Rocking(Settings):
    """Motion 1: angle = amplitude sin(2 pi f t) about one axis."""

    axis: str = setting('north', 'level axis (east, north, up) or body axis (x, y, z)',
                        choices=('east', 'north', 'up', 'x', 'y', 'z'))
    amplitude_deg: float = setting(5.0, 'amplitude', 'deg', 0.0, 180.0)
    frequency_hz: float = setting(1.0, 'frequency', 'Hz', 0.0, 1000.0)


@settings_class
class TwoAxis(Settings):
    """Motion 2: constant rates of psi and gamma at constant theta."""

    psi_rate_rad_s: float = setting(1.0, 'rate of psi', 'rad/s', -100.0, 100.0)
    gamma_rate_rad_s: float = setting(0.5, 'rate of gamma', 'rad/s', -100.0, 100.0)
    detuning_rad_s: float = setting(0.0, 'added to the rate of psi', 'rad/s', -100.0, 100.0)


@settings_class
class Coning(Settings):
    """The body axis describes a cone about its mean direction."""

    axis: str = setting('z', 'body axis that describes the cone', choices=('x', 'y', 'z'))
    half_angle_deg: float = setting(1.0, 'half angle of the cone', 'deg', 0.0, 90.0)
    frequency_hz: float = setting(1.0, 'frequency', 'Hz', 0.0, 1000.0)


@settings_class
class Sculling(Settings):
    """Rocking about the vertical with a vibration along the mean forward axis."""

    amplitude_deg: float = setting(1.0, 'amplitude of the rocking', 'deg', 0.0, 90.0)
    acceleration_m_s2: float = setting(5.0, 'amplitude of the vibration', 'm/s^2', 0.0, 1000.0)
    frequency_hz: float = setting(1.0, 'frequency of both', 'Hz', 0.001, 1000.0)
    phase_deg: float = setting(0.0, 'phase of the vibration', 'deg', -360.0, 360.0)


@settings_class
class Sinusoids(Settings):
    """One sinusoid on each angle (psi, theta, gamma) and on each coordinate (E, N, U)."""

    angle_deg: tuple[float, ...] = setting((3.0, 2.0, 4.0), 'amplitudes of psi, theta, gamma',
                                           'deg', -180.0, 180.0, size=3)
    angle_hz: tuple[float, ...] = setting((0.3, 0.5, 0.7), 'their frequencies', 'Hz', 0.0,
                                          1000.0, size=3)
    angle_phase_deg: tuple[float, ...] = setting((0.0, 40.0, 80.0), 'their phases', 'deg',
                                                 -360.0, 360.0, size=3)
    position_m: tuple[float, ...] = setting((1.0, 1.0, 0.5), 'amplitudes of E, N, U', 'm',
                                            -1e5, 1e5, size=3)
    position_hz: tuple[float, ...] = setting((0.2, 0.3, 0.4), 'their frequencies', 'Hz', 0.0,
                                             1000.0, size=3)
    position_phase_deg: tuple[float, ...] = setting((0.0, 30.0, 60.0), 'their phases', 'deg',
                                                    -360.0, 360.0, size=3)


@settings_class
class Harmonics(Settings):
    """Periodic angles: entry k of each list is the harmonic k + 1 of the period."""

    period_s: float = setting(10.0, 'common period', 's', 1e-3, 1e6)
    psi_deg: tuple[float, ...] = setting((2.0, 1.0, 0.5), 'amplitudes of psi', 'deg',
                                         -180.0, 180.0)
    psi_phase_deg: tuple[float, ...] = setting((0.0, 50.0, 100.0), 'phases of psi', 'deg',
                                               -360.0, 360.0)
    theta_deg: tuple[float, ...] = setting((1.0, 2.0, 0.5), 'amplitudes of theta', 'deg',
                                           -90.0, 90.0)
    theta_phase_deg: tuple[float, ...] = setting((70.0, 10.0, 120.0), 'phases of theta', 'deg',
                                                 -360.0, 360.0)
    gamma_deg: tuple[float, ...] = setting((3.0, 1.0, 1.0), 'amplitudes of gamma', 'deg',
                                           -180.0, 180.0)
    gamma_phase_deg: tuple[float, ...] = setting((20.0, 90.0, 200.0), 'phases of gamma', 'deg',
                                                 -360.0, 360.0)


@settings_class
class Recording(Settings):
    """A recorded flight, or the truth of a bag."""

    path: str = setting('', 'CSV file, plain or gzip, or rosbag2 bag (folder or file)')
    topic: str = setting('auto', 'odometry in the bag; auto: the one that ends in truth/odometry')
    start_s: float = setting(3.0, 'recorder time of motion time zero, from the first row', 's',
                             3.0, 1e7)
    smoothing_s: float = setting(0.0, 'window of the boxcar smoothing; 0 = none', 's', 0.0, 60.0)
    on_gap: str = setting('refuse', 'what to do about a gap or jump in the recording: refuse '
                          'it, or cut the recording there and keep the part that holds start_s',
                          choices=('refuse', 'cut'))


MOTION_KINDS = ('static', 'rocking', 'two_axis', 'coning', 'sculling', 'sinusoids', 'harmonics',
                'cruise', 'racetrack', 'aggressive', 'route', 'recording')


@settings_class
class MotionSettings(Settings):
    """The motion; only the group of its kind is used."""

    kind: str = setting('two_axis', 'which motion', choices=MOTION_KINDS)
    psi_deg: float = setting(0.0, 'mean or initial psi, counter-clockwise from north (bench '
                             'motions)', 'deg', -360.0, 360.0)
    theta_deg: float = setting(-30.0, 'mean or initial theta, nose up (bench motions)', 'deg',
                               -89.9, 89.9)
    gamma_deg: float = setting(0.0, 'mean or initial gamma, right wing down (bench motions)',
                               'deg', -360.0, 360.0)
    rocking: Rocking = group(Rocking)
    two_axis: TwoAxis = group(TwoAxis)
    coning: Coning = group(Coning)
    sculling: Sculling = group(Sculling)
    sinusoids: Sinusoids = group(Sinusoids)
    harmonics: Harmonics = group(Harmonics)
    route: FlightRoute = group(FlightRoute)
    recording: Recording = group(Recording)


@settings_class
class Pacing(Settings):
    """How fast the generator goes."""

    real_time_factor: float = setting(1.0, 'simulated seconds per second; 0 = as fast as the '
                                      'slowest required consumer (implies lock_step)', '',
                                      0.0, 1e6)
    lock_step: bool = setting(False, 'wait for the acknowledgements of the required consumers')
    window: int = setting(200, 'unanswered steps allowed in lock-step', 'steps', 1, 2000)
    required: tuple[str, ...] = setting(('strapdown',), 'names of the consumers that must '
                                        'acknowledge')
    timeout_s: float = setting(30.0, 'wall time without an acknowledgement before the missing '
                               'consumer is named and the run ends', 's', 0.1, 1e5)


@settings_class
class MotionGeneratorSettings(Settings):
    """Node motion_generator."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    time: Time = group(Time)
    motion: MotionSettings = group(MotionSettings)
    pacing: Pacing = group(Pacing)
    topics: Topics = group(Topics)
    rate_hz: float = setting(100.0, 'rate of the truth', 'Hz', 0.01, 20000.0)
    start_s: float = setting(0.0, 'motion time of the first sample', 's', 0.0, 1e7)
    duration_s: float = setting(3600.0, 'length of the run; 0 = endless (in simulate: refused)',
                                's', 0.0, 1e7)
    publish_clock: bool = setting(False, 'publish /clock')
    exit_at_end: bool = setting(True, 'end the process after the last sample; else stay up')


@settings_class
class DelaysUs(Settings):
    """Delay of each channel, by FLU axis (the paper's tau1, tau2, tau3 are y, x, z)."""

    x: float = setting(0.0, 'delay of the forward channel', 'us', -1e6, 1e6)
    y: float = setting(0.0, 'delay of the left channel (tau1, right, in the paper)', 'us',
                       -1e6, 1e6)
    z: float = setting(0.0, 'delay of the up channel', 'us', -1e6, 1e6)


@settings_class
class Gyro(Settings):
    """The gyro triad."""

    model: str = setting('ideal', 'ideal, or dtg: two dynamically tuned gyros (needs output '
                         'integrated)', choices=('ideal', 'dtg'))
    dtg: Dtg = group(Dtg)
    delay_us: DelaysUs = group(DelaysUs)
    errors: GyroErrors = group(GyroErrors)


@settings_class
class Accelerometer(Settings):
    """The accelerometer triad."""

    delay_us: DelaysUs = group(DelaysUs)
    errors: AccelerometerErrors = group(AccelerometerErrors)


OUTPUTS = ('rotation_vector', 'integrated')


@settings_class
class ImuSensorSettings(Settings):
    """Node imu_sensor."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    time: Time = group(Time)
    motion: MotionSettings = group(MotionSettings)
    gyro: Gyro = group(Gyro)
    accelerometer: Accelerometer = group(Accelerometer)
    temperature: Temperature = group(Temperature)
    sampling: Sampling = group(Sampling)
    topics: Topics = group(Topics)
    seed: int = setting(0, 'seed of the random errors: the same seed, the same errors', '', 0,
                        2147483647)
    rate_hz: float = setting(100.0, 'rate of the IMU', 'Hz', 0.01, 20000.0)
    source: str = setting('stream', 'where the motion comes from: the streamed truth, or the '
                          'closed form or recording of motion.* (the stream then only paces)',
                          choices=('stream', 'motion'))
    output: str = setting('rotation_vector', 'rotation_vector: mean of the finite rotation and of '
                          'the inertially rotated velocity increment; integrated: plain '
                          'integrals of rate and specific force', choices=OUTPUTS)
    history: str = setting('analytic', 'motion before the first instant: continued backwards '
                           '(analytic) or held (frozen)', choices=('analytic', 'frozen'))
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew (reset) or end the node (stop)', choices=('reset', 'stop'))


@settings_class
class Vertical(Settings):
    """The vertical channel."""

    channel: str = setting('truth', 'height and vertical velocity from truth, free, or damped '
                           'towards the height of the truth', choices=('truth', 'free', 'damped'))
    time_constant_s: float = setting(20.0, 'time constant of the damped channel', 's', 0.1, 1e4)


@settings_class
class Initial(Settings):
    """Initial errors, added to the truth, resolved in East, North, Up."""

    after_s: float = setting(0.0, 'start this long after the first IMU sample', 's', 0.0, 1e6)
    attitude_error_deg: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'rotation vector of the '
                                                    'attitude error', 'deg', -180.0, 180.0, size=3)
    velocity_error_m_s: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'velocity error', 'm/s',
                                                    -1e4, 1e4, size=3)
    position_error_m: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'position error', 'm', -1e6,
                                                  1e6, size=3)


@settings_class
class StrapdownSettings(Settings):
    """Node strapdown."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    time: Time = group(Time)
    vertical: Vertical = group(Vertical)
    initial: Initial = group(Initial)
    topics: Topics = group(Topics)
    rate_hz: float = setting(100.0, 'rate of the IMU', 'Hz', 0.01, 20000.0)
    input: str = setting('rotation_vector', 'what the IMU sends (imu_sensor: output)',
                         choices=OUTPUTS)
    orientation: str = setting('quaternion', 'attitude algorithm: quaternion (exact), or by RK4 '
                               'the matrix of Poisson\'s equation or the Euler vector',
                               choices=('quaternion', 'poisson', 'euler_vector'))
    imu_time: str = setting('stamp', 'instant of a reading: its stamp, or the nearest multiple of '
                            'the period in motion time (nominal; for jitter and latency)',
                            choices=('stamp', 'nominal'))
    imu_latency_us: float = setting(0.0, 'known latency of the stamps, taken off before the '
                                    'nominal instant is found', 'us', -1e6, 1e6)
    output_every: int = setting(1, 'publish every n-th step', 'steps', 1, 1000000)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew from truth (reset) or end the node (stop)',
                            choices=('reset', 'stop'))


NODES = {'motion_generator': MotionGeneratorSettings, 'imu_sensor': ImuSensorSettings,
         'strapdown': StrapdownSettings}
