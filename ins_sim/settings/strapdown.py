"""Settings of the node strapdown."""

from .field import group, setting, settings_class, SettingsGroup
from .imu import OUTPUTS
from .instrument_errors import AccelerometerErrors, GyroErrors
from .node import Topics
from .place import Datum, Earth, Frames, Tf
from .recorded_imu import (AlignmentSettings, GapSettings, INPUTS, MountingAngles, SampleUnits,
                           StandaloneInputs, StandaloneStart)


@settings_class
class Vertical(SettingsGroup):
    """Vertical channel."""

    channel: str = setting('truth', 'How height and vertical velocity are found. truth: taken '
                           'from the truth; free: integrated; damped: integrated and damped '
                           'towards the height of the truth or of vertical.reference',
                           choices=('truth', 'free', 'damped'))
    time_constant_s: float = setting(20.0, 'Time constant of the damped vertical channel', 's',
                                     0.1, 1e4)
    reference: str = setting('fix', 'Height towards which the vertical channel is damped without '
                             'truth. fix: height of inputs.fix; pressure: height of the start, '
                             'changed by inputs.pressure through the standard atmosphere',
                             choices=('fix', 'pressure'))


@settings_class
class Initial(StandaloneStart):
    """
    Initial state and its errors.

    The errors are added to the truth, resolved in East, North, Up. The standard deviations set
    the initial covariances on the ins/ topics, to which the squared errors are added.
    """

    after_s: float = setting(0.0, 'Time from the first IMU sample to the start of the navigation',
                             's', 0.0, 1e6)
    attitude_error_deg: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'Rotation vector of the '
                                                    'initial attitude error: East, North, Up',
                                                    'deg', -180.0, 180.0, size=3)
    velocity_error_m_s: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'Initial velocity error: '
                                                    'East, North, Up', 'm/s', -1e4, 1e4, size=3)
    position_error_m: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'Initial position error: East, '
                                                  'North, Up', 'm', -1e6, 1e6, size=3)
    position_sigma_m: float = setting(0.0, 'Standard deviation of the initial position, each axis',
                                      'm', 0.0, 1e6)
    velocity_sigma_m_s: float = setting(0.0, 'Standard deviation of the initial velocity, each '
                                        'axis', 'm/s', 0.0, 1e3)
    tilt_sigma_mrad: float = setting(0.0, 'Standard deviation of the initial tilt, each axis',
                                     'mrad', 0.0, 500.0)
    azimuth_sigma_mrad: float = setting(0.0, 'Standard deviation of the initial azimuth', 'mrad',
                                        0.0, 3142.0)

    def check(self):
        """Raise ValueError if a value is given that would not be used."""
        self.check_used()
        given = [key for key in ('attitude_error_deg', 'velocity_error_m_s', 'position_error_m')
                 if any(getattr(self, key))]
        if given and self.source != 'truth':
            raise ValueError(f'initial.{given[0]} is {list(getattr(self, given[0]))} and would '
                             f'not be used with initial.source {self.source}; expected zeros')


@settings_class
class GyroFigures(SettingsGroup):
    """Gyros: only their errors are used, for the covariances on the ins/ topics."""

    errors: GyroErrors = group(GyroErrors)


@settings_class
class AccelerometerFigures(SettingsGroup):
    """Accelerometers: only their errors are used, for the covariances on the ins/ topics."""

    errors: AccelerometerErrors = group(AccelerometerErrors)


@settings_class
class StrapdownSettings(SettingsGroup):
    """Settings of the node strapdown."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    vertical: Vertical = group(Vertical)
    initial: Initial = group(Initial)
    gyro: GyroFigures = group(GyroFigures)
    accelerometer: AccelerometerFigures = group(AccelerometerFigures)
    topics: Topics = group(Topics)
    inputs: StandaloneInputs = group(StandaloneInputs)
    units: SampleUnits = group(SampleUnits)
    mounting: MountingAngles = group(MountingAngles)
    alignment: AlignmentSettings = group(AlignmentSettings)
    gaps: GapSettings = group(GapSettings)
    rate_hz: float = setting(100.0, 'Rate of the IMU', 'Hz', 0.01, 20000.0)
    input: str = setting('rotation_vector', 'Meaning of the IMU samples; must equal output of '
                         'imu_sensor. Without truth also instant: the value at its stamp, as from '
                         'most drivers', choices=INPUTS)
    orientation: str = setting('quaternion', 'Attitude algorithm. quaternion: exact; poisson: RK4 '
                               'integration of the direction cosine matrix (equation of Poisson); '
                               'euler_vector: RK4 integration of the Euler vector',
                               choices=('quaternion', 'poisson', 'euler_vector'))
    imu_time: str = setting('stamp', 'Instant of a reading. stamp: its stamp; nominal: the '
                            'nearest multiple of the sampling period in motion time, for stamps '
                            'with jitter and latency', choices=('stamp', 'nominal'))
    imu_latency_us: float = setting(0.0, 'Known latency of the stamps, subtracted before the '
                                    'nominal instant is found', 'us', -1e6, 1e6)
    imu_data: bool = setting(False, 'Whether to publish imu/data: imu/data_raw with the '
                             'orientation of the INS and its covariance')
    output_every: int = setting(1, 'Number of steps from one published solution to the next',
                                'steps', 1, 1000000)
    on_fault: str = setting('reset', 'What the node does after a gap, a backward time stamp or an '
                            'invalid message: start anew from truth (reset) or end (stop)',
                            choices=('reset', 'stop'))

    @property
    def standalone(self):
        """Whether the node works without truth."""
        return self.initial.source != 'truth'

    def check(self):
        """Raise ValueError if input or mounting contradict the source of the initial state."""
        if self.input not in OUTPUTS and not self.standalone:
            raise ValueError(f'input is {self.input} with initial.source truth; expected one of '
                             f'{", ".join(OUTPUTS)}, the outputs of imu_sensor')
        if self.mounting.source == 'level' and self.initial.source != 'alignment':
            raise ValueError(f'mounting.source is level and initial.source {self.initial.source}; '
                             'expected initial.source alignment, which levels the IMU at '
                             'standstill')
        if any(self.mounting.rpy_deg) and not self.standalone:
            raise ValueError(f'mounting.rpy_deg is {list(self.mounting.rpy_deg)} and would not be '
                             'used with initial.source truth; expected zeros')
