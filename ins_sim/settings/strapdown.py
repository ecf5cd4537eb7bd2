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
    """The vertical channel."""

    channel: str = setting('truth', 'height and vertical velocity from truth, free, or damped '
                           'towards the height of the truth', choices=('truth', 'free', 'damped'))
    time_constant_s: float = setting(20.0, 'time constant of the damped channel', 's', 0.1, 1e4)
    reference: str = setting('fix', 'without truth, towards what height the channel is damped: '
                             'that of inputs.fix, or by inputs.pressure in the standard '
                             'atmosphere, from the height of the start on',
                             choices=('fix', 'pressure'))


@settings_class
class Initial(StandaloneStart):
    """
    The state at the start, and its errors.

    The errors are added to the truth, resolved in East, North, Up. The standard deviations are
    those that the covariances of ins/* begin with; the errors are squared in.
    """

    after_s: float = setting(0.0, 'start this long after the first IMU sample', 's', 0.0, 1e6)
    attitude_error_deg: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'rotation vector of the '
                                                    'attitude error', 'deg', -180.0, 180.0, size=3)
    velocity_error_m_s: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'velocity error', 'm/s',
                                                    -1e4, 1e4, size=3)
    position_error_m: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'position error', 'm', -1e6,
                                                  1e6, size=3)
    position_sigma_m: float = setting(0.0, 'standard deviation of the position, each axis', 'm',
                                      0.0, 1e6)
    velocity_sigma_m_s: float = setting(0.0, 'that of the velocity, each axis', 'm/s', 0.0, 1e3)
    tilt_sigma_mrad: float = setting(0.0, 'that of the tilt, each axis', 'mrad', 0.0, 500.0)
    azimuth_sigma_mrad: float = setting(0.0, 'that of the azimuth', 'mrad', 0.0, 3142.0)

    def check(self):
        """Refuse values that the source of the start leaves unused."""
        self.check_used()
        given = [key for key in ('attitude_error_deg', 'velocity_error_m_s', 'position_error_m')
                 if any(getattr(self, key))]
        if given and self.source != 'truth':
            raise ValueError(f'initial.{given[0]} is {list(getattr(self, given[0]))} and would '
                             f'not be used with initial.source {self.source}; expected zeros')


@settings_class
class GyroFigures(SettingsGroup):
    """The gyros, of which the covariances of ins/* need the errors alone."""

    errors: GyroErrors = group(GyroErrors)


@settings_class
class AccelerometerFigures(SettingsGroup):
    """The accelerometers, likewise."""

    errors: AccelerometerErrors = group(AccelerometerErrors)


@settings_class
class StrapdownSettings(SettingsGroup):
    """Node strapdown."""

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
    rate_hz: float = setting(100.0, 'rate of the IMU', 'Hz', 0.01, 20000.0)
    input: str = setting('rotation_vector', 'what the IMU sends (imu_sensor: output). instant: '
                         'the value at its stamp, as from most drivers; only without truth',
                         choices=INPUTS)
    orientation: str = setting('quaternion', 'attitude algorithm: quaternion (exact), or by RK4 '
                               'the matrix of Poisson\'s equation or the Euler vector',
                               choices=('quaternion', 'poisson', 'euler_vector'))
    imu_time: str = setting('stamp', 'instant of a reading: its stamp, or the nearest multiple of '
                            'the period in motion time (nominal; for jitter and latency)',
                            choices=('stamp', 'nominal'))
    imu_latency_us: float = setting(0.0, 'known latency of the stamps, taken off before the '
                                    'nominal instant is found', 'us', -1e6, 1e6)
    imu_data: bool = setting(False, 'publish imu/data: imu/data_raw with the orientation of the '
                             'INS and its covariance')
    output_every: int = setting(1, 'publish every n-th step', 'steps', 1, 1000000)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew from truth (reset) or end the node (stop)',
                            choices=('reset', 'stop'))

    @property
    def standalone(self):
        """Whether the node needs no truth."""
        return self.initial.source != 'truth'

    def check(self):
        """Refuse readings that the strapdown beside the truth does not take."""
        if self.input not in OUTPUTS and not self.standalone:
            raise ValueError(f'input is {self.input} and initial.source truth; expected one of '
                             f'{", ".join(OUTPUTS)}, as imu_sensor sends them')
        if self.mounting.source == 'level' and self.initial.source != 'alignment':
            raise ValueError(f'mounting.source is level and initial.source {self.initial.source}; '
                             'expected initial.source alignment, whose standstill shows what is '
                             'level')
        if any(self.mounting.rpy_deg) and not self.standalone:
            raise ValueError(f'mounting.rpy_deg is {list(self.mounting.rpy_deg)} and would not be '
                             'used with initial.source truth; expected zeros')
