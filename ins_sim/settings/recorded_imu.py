"""Settings of an IMU without truth, recorded or real: its data, its mounting and its start."""

from .field import column, group, setting, settings_class, SettingsGroup
from .place import HIGHEST_M

# Possible meanings of an IMU sample, see the setting ``input``.
INPUTS = ('instant', 'integrated', 'rotation_vector')


@settings_class
class ImuColumns(SettingsGroup):
    """Column headers of a CSV file with IMU samples."""

    t_s: str = column('time')
    gx_rps: str = column('angular rate about x')
    gy_rps: str = column('angular rate about y')
    gz_rps: str = column('angular rate about z')
    ax_mps2: str = column('specific force along x')
    ay_mps2: str = column('specific force along y')
    az_mps2: str = column('specific force along z')


@settings_class
class SampleUnits(SettingsGroup):
    """Units of an IMU; auto: those in the headers of a CSV file, else SI."""

    rate: str = setting('auto', 'Unit of the angular rate', choices=('auto', 'rad/s', 'deg/s'))
    force: str = setting('auto', 'Unit of the specific force; g is 9.80665 m/s^2',
                         choices=('auto', 'm/s^2', 'g', 'mg'))


@settings_class
class RecordUnits(SampleUnits):
    """Units of a recorded IMU; auto: those in the headers of a CSV file, else SI."""

    time: str = setting('auto', 'Unit of the time column of a CSV file; not used for bags',
                        choices=('auto', 's', 'ms', 'us', 'ns'))


@settings_class
class StampSettings(SettingsGroup):
    """Time stamps of the samples."""

    source: str = setting('auto', 'Source of the time stamps. header: message headers, or column '
                          't_s; log: log times of the bag; even: the first stamp, continued at '
                          'rate_hz; auto: header, or log if all header stamps are zero',
                          choices=('auto', 'header', 'log', 'even'))
    rate_hz: float = setting(0.0, 'Sampling rate for stamps.source even; 0 for the other sources',
                             'Hz', 0.0, 1e5)
    on_repeat: str = setting('drop', 'What to do with a stamp equal to the previous one. drop: '
                             'discard the sample and count it; spread: distribute the samples '
                             'with that stamp evenly up to the next stamp',
                             choices=('drop', 'spread'))

    def check(self):
        """Raise ValueError unless rate_hz is given exactly when source is even."""
        if (self.source == 'even') != (self.rate_hz >= 0.01):
            raise ValueError(f'stamps.source is {self.source} and stamps.rate_hz '
                             f'{self.rate_hz:g} Hz; expected a rate of 0.01 Hz or more '
                             'with stamps.source even, and 0 with any other')


@settings_class
class AcceptSettings(SettingsGroup):
    """Doubtful data that is refused unless it is accepted here."""

    unmeasured: bool = setting(False, 'Accept angular rates and accelerations whose covariance '
                               'begins with -1, which marks them as not measured (REP-145)')
    frames: bool = setting(False, 'Accept a topic whose messages have several frame_ids; the most '
                           'frequent one is used')
    orientations: bool = setting(False, 'Accept orientation quaternions that are not of unit '
                                 'length (but not zero) and normalise them')


@settings_class
class AcceptNavigated(AcceptSettings):
    """Doubtful data of a recording to navigate that is refused unless it is accepted here."""

    zero_fixes: bool = setting(False, 'Accept fixes at latitude 0, longitude 0')
    zero_readings: str = setting('refuse', 'What to do about angular rates and specific forces '
                                 'that are exactly zero in alternate messages, as from drivers '
                                 'that fill only one of the two. refuse: report an error; fill: '
                                 'interpolate linearly between the neighbours; keep: use the '
                                 'zeros', choices=('refuse', 'fill', 'keep'))


@settings_class
class ConvertSettings(SettingsGroup):
    """Settings of the command convert."""

    columns: ImuColumns = group(ImuColumns)
    units: RecordUnits = group(RecordUnits)
    stamps: StampSettings = group(StampSettings)
    accept: AcceptSettings = group(AcceptSettings)


@settings_class
class MountingAngles(SettingsGroup):
    """Mounting of the IMU: rotation from base_link to the frame of the IMU."""

    source: str = setting('auto', 'Source of the rotation from base_link to the IMU. tf: '
                          '/tf_static; given: rpy_deg; level: the smallest rotation that makes '
                          'the mean specific force of the stationary interval point up, followed '
                          'by the yaw of rpy_deg; auto: given if rpy_deg is not zero, otherwise '
                          'tf if available', choices=('auto', 'tf', 'given', 'level'))
    rpy_deg: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'Roll, pitch, yaw of the IMU about the '
                                         'fixed axes x, y, z, as in URDF', 'deg', -360.0, 360.0,
                                         size=3)


@settings_class
class GivenState(SettingsGroup):
    """Given initial state; each value is used only if its source is "given"."""

    roll_deg: float = setting(0.0, 'Given roll, right side down', 'deg', -180.0, 180.0)
    pitch_deg: float = setting(0.0, 'Given pitch, nose up', 'deg', -90.0, 90.0)
    heading_deg: float = setting(0.0, 'Given heading, clockwise from true north', 'deg', -360.0,
                                 360.0)
    velocity_m_s: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'Given velocity: East, North, Up',
                                              'm/s', -1e4, 1e4, size=3)
    latitude_deg: float = setting(0.0, 'Given geodetic latitude', 'deg', -89.9, 89.9)
    longitude_deg: float = setting(0.0, 'Given longitude', 'deg', -180.0, 180.0)
    height_m: float = setting(0.0, 'Given height above the WGS-84 ellipsoid', 'm', -500.0,
                              HIGHEST_M)


@settings_class
class AlignmentSettings(SettingsGroup):
    """
    Search for a stationary interval, and alignment in it.

    The standstill limits are wide, because engines may run. They apply to the standard deviation
    within a window (rms over the three axes) and to the deviation of each window mean from the
    mean of the interval.
    """

    window_s: float = setting(1.0, 'Length of the windows that are tested for standstill', 's',
                              0.01, 600.0)
    shortest_s: float = setting(5.0, 'Shortest stationary interval that is used for alignment',
                                's', 0.1, 1e5)
    longest_s: float = setting(60.0, 'Length of the stationary interval that is used, from its '
                               'start', 's', 0.1, 1e5)
    force_sd_m_s2: float = setting(0.15, 'Standstill limit for the standard deviation of the '
                                   'specific force', 'm/s^2', 0.0, 100.0)
    rate_sd_rad_s: float = setting(0.03, 'Standstill limit for the standard deviation of the '
                                   'angular rate', 'rad/s', 0.0, 10.0)
    rate_rad_s: float = setting(0.1, 'Standstill limit for the mean angular rate', 'rad/s', 0.0,
                                10.0)
    gravity_m_s2: float = setting(2.0, 'Largest difference of the mean specific force at rest '
                                  'from gravity; 1e3 accepts any value', 'm/s^2', 0.0, 1e3)
    speed_m_s: float = setting(0.3, 'Standstill limit for the speed of the reference', 'm/s', 0.0,
                               100.0)
    heading_sigma_deg: float = setting(2.0, 'Largest standard error of a gyrocompass heading that '
                                       'is accepted; the mean angular rate must agree with that '
                                       'of the Earth equally well', 'deg', 0.0, 90.0)
    gyro_bias_sigma_deg_h: float = setting(10.0, 'Standard deviation of the gyro bias, which '
                                           'turns a gyrocompass heading by bias / (15.04 '
                                           'cos(latitude)) rad. Navigation-grade gyros have 0.01; '
                                           'the default is for an unknown IMU', 'deg/h', 0.0, 1e5)
    gyro_bias: str = setting('auto', 'Whether to correct the gyro bias. subtract: subtract the '
                             'mean rate of the stationary interval, less the rate of the Earth, '
                             'from every sample; keep: no correction; auto: subtract after an '
                             'alignment without gyrocompassing',
                             choices=('auto', 'subtract', 'keep'))
    course_distance_m: float = setting(20.0, 'Distance that the reference must travel before its '
                                       'course is used as heading', 'm', 0.1, 1e5)
    course_search_s: float = setting(300.0, 'Time within which the reference must have travelled '
                                     'course_distance_m', 's', 1.0, 1e5)


@settings_class
class StandaloneInputs(SettingsGroup):
    """Input topics of a strapdown without truth; they can also be remapped."""

    imu: str = setting('imu/data_raw', 'Topic of the sensor_msgs/Imu messages')
    fix: str = setting('gnss/fix', 'Topic of the sensor_msgs/NavSatFix messages')
    pressure: str = setting('imu/pressure', 'Topic of the sensor_msgs/FluidPressure messages')
    magnetic_field: str = setting('imu/mag', 'Topic of the sensor_msgs/MagneticField messages, '
                                  'resolved in the frame of the IMU')


@settings_class
class GapSettings(SettingsGroup):
    """Gaps in the IMU data of a strapdown without truth."""

    factor: float = setting(3.0, 'Number of median sampling intervals above which an interval '
                            'counts as a gap', '', 1.1, 1e6)
    longest_bridge_s: float = setting(1.0, 'Longest gap over which angular rate and specific '
                                      'force are interpolated linearly; after a longer one the '
                                      'node starts again', 's', 0.0, 1e5)


@settings_class
class StandaloneStart(GivenState):
    """Sources of the initial state."""

    source: str = setting('truth', 'Source of the initial state. truth: the simulation. For a '
                          'real IMU, without truth: given: position, velocity and attitude of '
                          'initial.*; alignment: at rest, levelled by gravity; fix: position from '
                          'inputs.fix and attitude of initial.* or, with initial.heading course, '
                          'heading from the motion',
                          choices=('truth', 'given', 'alignment', 'fix'))
    heading: str = setting('auto', 'Source of the heading for an alignment or a start from a fix. '
                           'gyrocompass: from the rotation of the Earth; given: heading_deg; '
                           'course: direction of travel of the fixes, once they have moved; '
                           'magnetometer: inputs.magnetic_field; auto: the first available of '
                           'gyrocompass, course, magnetometer',
                           choices=('auto', 'gyrocompass', 'given', 'course', 'magnetometer'))
    position: str = setting('fix', 'Source of the position for an alignment. fix: inputs.fix; '
                            'given: latitude_deg, longitude_deg, height_m',
                            choices=('fix', 'given'))
    declination: str = setting('model', 'Source of the magnetic declination. model: World '
                               'Magnetic Model, which needs the package pygeomag; given: '
                               'declination_deg', choices=('model', 'given'))
    declination_deg: float = setting(0.0, 'Magnetic declination, positive to the East of true '
                                     'north', 'deg', -180.0, 180.0)
    magnetic_sigma_deg: float = setting(5.0, 'Standard deviation of a magnetic heading', 'deg',
                                        0.1, 180.0)

    def check_used(self):
        """
        Raise ValueError if a heading is given that would not be used, or cannot be determined.

        Otherwise the user would not notice that the given heading is ignored. Without it, a start
        from a fix can take its heading only from the course of the vehicle.
        """
        used = self.source == 'given' or self.heading == 'given'
        if self.heading_deg and not used:
            raise ValueError(f'initial.heading_deg is {self.heading_deg} and would not be used; '
                             'expected initial.heading (or initial.source) given')
        if self.source == 'fix' and self.heading not in ('auto', 'given', 'course'):
            raise ValueError(f'initial.heading is {self.heading} and initial.source fix; expected '
                             'given or course, the only ones available to a moving vehicle')


CONVERT = {'convert': ConvertSettings}
