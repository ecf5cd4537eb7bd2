"""An IMU without truth, recorded or real: how it is read, how it is mounted, where it starts."""

from .field import column, group, setting, settings_class, SettingsGroup
from .place import HIGHEST_M

# What a sample of an IMU is, see the setting ``input``.
INPUTS = ('instant', 'integrated', 'rotation_vector')


@settings_class
class ImuColumns(SettingsGroup):
    """Headers of a CSV file of an IMU."""

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

    rate: str = setting('auto', 'unit of the angular rate', choices=('auto', 'rad/s', 'deg/s'))
    force: str = setting('auto', 'unit of the specific force; g is 9.80665 m/s^2',
                         choices=('auto', 'm/s^2', 'g', 'mg'))


@settings_class
class RecordUnits(SampleUnits):
    """Units of a recorded IMU; auto: those in the headers of a CSV file, else SI."""

    time: str = setting('auto', 'unit of the column of time; of a bag without use',
                        choices=('auto', 's', 'ms', 'us', 'ns'))


@settings_class
class StampSettings(SettingsGroup):
    """The stamps of the samples."""

    source: str = setting('auto', 'header: those in the messages, or column t_s; log: when the '
                          'bag logged them; even: the first stamp and then rate_hz; auto: '
                          'header, but log where all stamps are zero',
                          choices=('auto', 'header', 'log', 'even'))
    rate_hz: float = setting(0.0, 'rate of stamps that are made even', 'Hz', 0.0, 1e5)
    on_repeat: str = setting('drop', 'a stamp that is that of the sample before. drop: the sample '
                             'is left out and counted; spread: the samples with it are spread '
                             'evenly up to the next stamp', choices=('drop', 'spread'))

    def check(self):
        """Refuse even stamps without a rate, and a rate without use."""
        if (self.source == 'even') != (self.rate_hz >= 0.01):
            raise ValueError(f'stamps.source is {self.source} and stamps.rate_hz '
                             f'{self.rate_hz:g} Hz; expected a rate of 0.01 Hz or more '
                             'with even stamps, and 0 with others')


@settings_class
class AcceptSettings(SettingsGroup):
    """What is refused or left out unless it is said here that it is meant so."""

    unmeasured: bool = setting(False, 'take rates and accelerations whose covariance begins with '
                               '-1, which says that they are not measured (REP-145)')
    frames: bool = setting(False, 'take a topic whose messages have several frame_ids; the most '
                           'frequent one counts')
    orientations: bool = setting(False, 'take orientations of any length but zero, normalised')


@settings_class
class AcceptNavigated(AcceptSettings):
    """The same, and of what is navigated."""

    zero_fixes: bool = setting(False, 'take fixes at latitude 0, longitude 0')
    zero_readings: str = setting('refuse', 'rates and forces that are exactly zero in turns, as '
                                 'of drivers that send one of both with each message. refuse; '
                                 'fill: they are drawn straight between their neighbours; keep',
                                 choices=('refuse', 'fill', 'keep'))


@settings_class
class ConvertSettings(SettingsGroup):
    """The command convert."""

    columns: ImuColumns = group(ImuColumns)
    units: RecordUnits = group(RecordUnits)
    stamps: StampSettings = group(StampSettings)
    accept: AcceptSettings = group(AcceptSettings)


@settings_class
class MountingAngles(SettingsGroup):
    """How the IMU sits in the vehicle: the rotation from base_link to the frame of the IMU."""

    source: str = setting('auto', 'tf: /tf_static; given: rpy_deg; level: the shortest '
                          'turn that brings the mean specific force of the stationary interval '
                          'up, after it the yaw of rpy_deg; auto: given where rpy_deg is not '
                          'zero, else tf where it is there',
                          choices=('auto', 'tf', 'given', 'level'))
    rpy_deg: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'roll, pitch, yaw about the fixed axes '
                                         'x, y, z (URDF)', 'deg', -360.0, 360.0, size=3)


@settings_class
class GivenState(SettingsGroup):
    """A state; the values serve only where their source is "given"."""

    roll_deg: float = setting(0.0, 'right side down', 'deg', -180.0, 180.0)
    pitch_deg: float = setting(0.0, 'nose up', 'deg', -90.0, 90.0)
    heading_deg: float = setting(0.0, 'clockwise from true north', 'deg', -360.0, 360.0)
    velocity_m_s: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'East, North, Up', 'm/s', -1e4,
                                              1e4, size=3)
    latitude_deg: float = setting(0.0, 'geodetic latitude', 'deg', -89.9, 89.9)
    longitude_deg: float = setting(0.0, 'longitude', 'deg', -180.0, 180.0)
    height_m: float = setting(0.0, 'height above the WGS-84 ellipsoid', 'm', -500.0, HIGHEST_M)


@settings_class
class AlignmentSettings(SettingsGroup):
    """
    The search for a stationary interval and what is taken from it.

    The limits of a standstill are wide: engines may run.  They hold for the standard deviation
    within a window, mean of the three axes, and for what a window mean may differ from the
    mean of the interval.
    """

    window_s: float = setting(1.0, 'length of the windows whose variance is tested', 's', 0.01,
                              600.0)
    shortest_s: float = setting(5.0, 'shortest stationary interval', 's', 0.1, 1e5)
    longest_s: float = setting(60.0, 'length of it that is used, from its start', 's', 0.1, 1e5)
    force_sd_m_s2: float = setting(0.15, 'limit of a standstill, specific force', 'm/s^2', 0.0,
                                   100.0)
    rate_sd_rad_s: float = setting(0.03, 'limit of a standstill, angular rate', 'rad/s', 0.0,
                                   10.0)
    rate_rad_s: float = setting(0.1, 'limit of a standstill, mean angular rate', 'rad/s', 0.0,
                                10.0)
    gravity_m_s2: float = setting(2.0, 'what the mean specific force at rest may differ from '
                                  'gravity by; 1e3 navigates whatever it is', 'm/s^2', 0.0, 1e3)
    speed_m_s: float = setting(0.3, 'limit of a standstill, speed of the reference', 'm/s', 0.0,
                               100.0)
    heading_sigma_deg: float = setting(2.0, 'worst standard error with which gyrocompassing is '
                                       'trusted; the mean rate must agree with that of the '
                                       'Earth to the same measure', 'deg', 0.0, 90.0)
    gyro_bias_sigma_deg_h: float = setting(
        10.0, 'standard deviation of the bias of the gyros, which a gyrocompass takes for a part '
        'of the rate of the Earth: it turns the heading by bias / (15.04 cos(latitude)) rad. '
        '10 is assumed where nothing is known; navigation-grade gyros have 0.01', 'deg/h',
        0.0, 1e5)
    gyro_bias: str = setting('auto', 'subtract: the mean rate less the rate of the Earth, from '
                             'the stationary interval, is taken off every sample; keep; auto: '
                             'subtract after an alignment that could not gyrocompass',
                             choices=('auto', 'subtract', 'keep'))
    course_distance_m: float = setting(20.0, 'way the reference must have gone for its course',
                                       'm', 0.1, 1e5)
    course_search_s: float = setting(300.0, 'time within which it must have gone it', 's', 1.0,
                                     1e5)


@settings_class
class StandaloneInputs(SettingsGroup):
    """Topics of a strapdown without truth; a remapping serves as well."""

    imu: str = setting('imu/data_raw', 'sensor_msgs/Imu')
    fix: str = setting('gnss/fix', 'sensor_msgs/NavSatFix')
    pressure: str = setting('imu/pressure', 'sensor_msgs/FluidPressure')
    magnetic_field: str = setting('imu/mag', 'sensor_msgs/MagneticField, in the frame of the IMU')


@settings_class
class GapSettings(SettingsGroup):
    """Gaps in the readings of a strapdown without truth."""

    factor: float = setting(3.0, 'a step longer than this many median steps is a gap', '', 1.1,
                            1e6)
    longest_bridge_s: float = setting(1.0, 'over a gap up to this long rate and force are drawn '
                                      'straight; after a longer one the start is searched anew',
                                      's', 0.0, 1e5)


@settings_class
class StandaloneStart(GivenState):
    """Where the start comes from."""

    source: str = setting('truth', 'truth: from the simulation. Without truth, for a real IMU, '
                          'given: position, velocity and attitude of initial.*; alignment: at '
                          'rest, level from gravity; fix: position from inputs.fix, attitude of '
                          'initial.*, or with initial.heading course on the move',
                          choices=('truth', 'given', 'alignment', 'fix'))
    heading: str = setting('auto', 'heading of an alignment, or of a start from a fix. '
                           'gyrocompass; given: heading_deg; course: that of the fixes, once '
                           'they have moved; magnetometer; auto: the first of gyrocompass, '
                           'course, magnetometer that can be had',
                           choices=('auto', 'gyrocompass', 'given', 'course', 'magnetometer'))
    position: str = setting('fix', 'position of an alignment: that of inputs.fix, or given',
                            choices=('fix', 'given'))
    declination: str = setting('model', 'of the magnetic field. model: by the World Magnetic '
                               'Model, where pygeomag is installed; given: declination_deg',
                               choices=('model', 'given'))
    declination_deg: float = setting(0.0, 'declination, East of true north', 'deg', -180.0, 180.0)
    magnetic_sigma_deg: float = setting(5.0, 'standard deviation of a magnetic heading', 'deg',
                                        0.1, 180.0)

    def check_used(self):
        """
        Refuse a heading that its source leaves unused.

        A heading that is given but not used would look as if it had been used.
        """
        used = self.source == 'given' or self.heading == 'given'
        if self.heading_deg and not used:
            raise ValueError(f'initial.heading_deg is {self.heading_deg} and would not be used; '
                             'expected initial.heading (or initial.source) given')
        if self.source == 'fix' and self.heading not in ('auto', 'given', 'course'):
            raise ValueError(f'initial.heading is {self.heading} and initial.source fix; expected '
                             'given or course: a start on the move has no other')


CONVERT = {'convert': ConvertSettings}
