"""Settings of the command ``navigate``: strapdown navigation with a recorded IMU."""

from .field import group, setting, settings_class, SettingsGroup
from .motion import FlightColumns
from .place import Earth
from .recorded_imu import (AcceptNavigated, AlignmentSettings, GivenState, ImuColumns, INPUTS,
                           MountingAngles, RecordUnits, StampSettings)


@settings_class
class ReferenceSource(SettingsGroup):
    """Reference with which the solution is compared."""

    fix: str = setting('auto', 'Topic of the NavSatFix messages of the reference; auto: the only '
                       'such topic, if there is exactly one; none: not used')
    odometry: str = setting('auto', 'Topic of the Odometry messages of the reference, whose frame '
                            'is aligned with the solution at the start; auto: the only such '
                            'topic, if there is exactly one; none: not used')
    velocity: str = setting('auto', 'Topic of the TwistStamped messages of the reference, in '
                            'East, North, Up; auto: the only such topic, if there is exactly one; '
                            'none: not used')
    path: str = setting('', 'CSV file of the reference, with the columns of a recorded flight and '
                        't_s on the clock of the IMU; the reference topics are then not used')
    columns: FlightColumns = group(FlightColumns)


@settings_class
class MountingSettings(MountingAngles):
    """Mounting of the IMU: rotation from base_link to the frame of the IMU."""

    base_frame: str = setting('base_link', 'Name of the vehicle frame in /tf_static')


@settings_class
class StartSettings(GivenState):
    """Initial state; each value is used only if its source is "given"."""

    attitude: str = setting('align', 'Source of the initial attitude. align: alignment in a '
                            'stationary interval; given: roll_deg, pitch_deg, heading_deg; '
                            'reference: attitude of the reference; imu: orientation in the IMU '
                            'messages', choices=('align', 'given', 'reference', 'imu'))
    heading: str = setting('auto', 'Source of the heading of an alignment. gyrocompass: from the '
                           'rotation of the Earth; given: heading_deg; reference: attitude of the '
                           'reference (the x axis of an Odometry frame is assumed to point East); '
                           'course: direction of travel of the reference, once it has moved; '
                           'auto: the first that the data allow of gyrocompass, reference in '
                           'East, North, Up, course, reference',
                           choices=('auto', 'gyrocompass', 'given', 'reference', 'course'))
    velocity: str = setting('auto', 'Source of the initial velocity. given: velocity_m_s; '
                            'reference: velocity of the reference; auto: zero after an alignment, '
                            'otherwise the reference', choices=('auto', 'given', 'reference'))
    position: str = setting('reference', 'Source of the initial position. given: latitude_deg, '
                            'longitude_deg, height_m; reference: NavSatFix or the CSV file',
                            choices=('given', 'reference'))


@settings_class
class FreeVertical(SettingsGroup):
    """Vertical channel."""

    channel: str = setting('free', 'How height and vertical velocity are found: free '
                           '(integrated), or damped towards the height of the reference',
                           choices=('free', 'damped'))
    time_constant_s: float = setting(20.0, 'Time constant of the damped vertical channel', 's',
                                     0.1, 1e4)


@settings_class
class NavigateSettings(SettingsGroup):
    """Settings of the command navigate."""

    topic: str = setting('auto', 'Topic of the sensor_msgs/Imu messages; auto: the only such '
                         'topic of the bag')
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
    start_s: float = setting(0.0, 'Time after the first sample at which the navigation, or the '
                             'search for a stationary interval, begins', 's', 0.0, 1e7)
    duration_s: float = setting(0.0, 'Length of the navigation; 0 = to the end of the recording',
                                's', 0.0, 1e7)
    input: str = setting('instant', 'Meaning of a sample. instant: the value at its stamp, as '
                         'from most drivers; integrated: the mean since the previous sample; '
                         'rotation_vector: the default output of imu_sensor', choices=INPUTS)
    gap_factor: float = setting(3.0, 'Number of median sampling intervals above which an interval '
                                'counts as a gap', '', 1.1, 1e6)
    on_gap: str = setting('stop', 'What to do at a gap. stop: end the solution; restart: start '
                          'again from the reference or from a stationary interval after the gap; '
                          'bridge: interpolate angular rate and specific force linearly across '
                          'the gap', choices=('stop', 'restart', 'bridge'))
    longest_bridge_s: float = setting(600.0, 'Longest gap that is bridged; the solution ends at a '
                                      'longer one', 's', 0.0, 1e5)

    def check(self):
        """
        Raise ValueError if a value is given that would not be used.

        The user would otherwise believe that it was used.
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
