"""Settings of the command ``navigate``: the strapdown over a recorded IMU."""

from .field import group, setting, settings_class, SettingsGroup
from .motion import FlightColumns
from .place import Earth, HIGHEST_M
from .recorded_imu import AcceptNavigated, ImuColumns, RecordUnits, StampSettings

INPUTS = ('instant', 'integrated', 'rotation_vector')


@settings_class
class ReferenceSource(SettingsGroup):
    """What the solution is compared with."""

    fix: str = setting('auto', 'topic of NavSatFix; auto: the only one, if there is one; none')
    odometry: str = setting('auto', 'topic of Odometry, its frame laid on the solution at the '
                            'start; auto: the only one, if there is one; none')
    velocity: str = setting('auto', 'topic of TwistStamped in East, North, Up; auto: the only '
                            'one, if there is one; none')
    path: str = setting('', 'CSV file of a reference (columns of a recorded flight, its t_s on '
                        'the clock of the IMU); topics then serve for nothing')
    columns: FlightColumns = group(FlightColumns)


@settings_class
class MountingSettings(SettingsGroup):
    """How the IMU sits in the vehicle: the rotation from base_link to the frame of the IMU."""

    source: str = setting('auto', 'tf: /tf_static of the bag; given: rpy_deg; level: the shortest '
                          'turn that brings the mean specific force of the stationary interval '
                          'up, after it the yaw of rpy_deg; auto: given where rpy_deg is not '
                          'zero, else tf where the bag has it',
                          choices=('auto', 'tf', 'given', 'level'))
    rpy_deg: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'roll, pitch, yaw about the fixed axes '
                                         'x, y, z (URDF)', 'deg', -360.0, 360.0, size=3)
    base_frame: str = setting('base_link', 'frame of the vehicle in /tf_static')


@settings_class
class StartSettings(SettingsGroup):
    """State at the start; the values serve only where their source is "given"."""

    attitude: str = setting('align', 'align: from a stationary interval; given: roll_deg, '
                            'pitch_deg and heading_deg; reference: its attitude; imu: the '
                            'orientation in the IMU messages',
                            choices=('align', 'given', 'reference', 'imu'))
    heading: str = setting('auto', 'heading of an alignment. gyrocompass; given: heading_deg; '
                           'reference: its attitude (of Odometry: its x is taken for East); '
                           'course: of the reference, once it has moved; auto: the first '
                           'of gyrocompass, reference in East, North, Up, course, reference '
                           'that the data allow',
                           choices=('auto', 'gyrocompass', 'given', 'reference', 'course'))
    velocity: str = setting('auto', 'given: velocity_m_s; reference; auto: zero after an '
                            'alignment, else reference',
                            choices=('auto', 'given', 'reference'))
    position: str = setting('reference', 'given: latitude_deg, longitude_deg, height_m; '
                            'reference: NavSatFix or the CSV file',
                            choices=('given', 'reference'))
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
class FreeVertical(SettingsGroup):
    """The vertical channel."""

    channel: str = setting('free', 'free, or damped towards the height of the reference',
                           choices=('free', 'damped'))
    time_constant_s: float = setting(20.0, 'time constant of the damped channel', 's', 0.1, 1e4)


@settings_class
class NavigateSettings(SettingsGroup):
    """The command navigate."""

    topic: str = setting('auto', 'topic of sensor_msgs/Imu; auto: the only one')
    columns: ImuColumns = group(ImuColumns)
    units: RecordUnits = group(RecordUnits)
    stamps: StampSettings = group(StampSettings)
    accept: AcceptNavigated = group(AcceptNavigated)
    earth: Earth = group(Earth)
    reference: ReferenceSource = group(ReferenceSource)
    mounting: MountingSettings = group(MountingSettings)
    initial: StartSettings = group(StartSettings)
    alignment: AlignmentSettings = group(AlignmentSettings)
    vertical: FreeVertical = group(FreeVertical)
    start_s: float = setting(0.0, 'start, or begin the search for a stationary interval, this '
                             'long after the first sample', 's', 0.0, 1e7)
    duration_s: float = setting(0.0, 'length of the navigation; 0 = to the end', 's', 0.0, 1e7)
    input: str = setting('instant', 'what a sample is. instant: the value at its stamp, as from '
                         'most drivers; integrated: the mean since the sample before; '
                         'rotation_vector: as imu_sensor sends it by default', choices=INPUTS)
    gap_factor: float = setting(3.0, 'a step longer than this many median steps is a gap', '',
                                1.1, 1e6)
    on_gap: str = setting('stop', 'stop: the solution ends there; restart: from the reference, '
                          'or from a stationary interval behind the gap; bridge: rate and '
                          'force are drawn straight across the gap',
                          choices=('stop', 'restart', 'bridge'))
    longest_bridge_s: float = setting(600.0, 'the longest gap that is bridged; the solution ends '
                                      'at a longer one', 's', 0.0, 1e5)

    def check(self):
        """
        Refuse a value that its source leaves unused.

        A heading that is given but not used would look as if it had been used.
        """
        initial, mounting = self.initial, self.mounting
        attitude = initial.attitude == 'given'
        heading = attitude or (initial.attitude == 'align' and initial.heading == 'given')
        for key, used, expected in (
                ('roll_deg', attitude, 'initial.attitude given'),
                ('pitch_deg', attitude, 'initial.attitude given'),
                ('heading_deg', heading, 'initial.heading (or initial.attitude) given'),
                ('velocity_m_s', initial.velocity == 'given', 'initial.velocity given'),
                *((key, initial.position == 'given', 'initial.position given')
                  for key in ('latitude_deg', 'longitude_deg', 'height_m'))):
            value = getattr(initial, key)
            if not used and value != type(initial)().__dict__[key]:
                raise ValueError(f'initial.{key} is {value} and would not be used; expected '
                                 f'{expected}')
        roll, pitch, yaw = mounting.rpy_deg
        if (mounting.source == 'tf' and (roll or pitch or yaw)) or (
                mounting.source == 'level' and (roll or pitch)):
            raise ValueError(f'mounting.rpy_deg is {list(mounting.rpy_deg)} and would not be used '
                             f'with mounting.source {mounting.source}; expected '
                             + ('zeros' if mounting.source == 'tf' else 'a yaw alone'))


NAVIGATE = {'navigate': NavigateSettings}
