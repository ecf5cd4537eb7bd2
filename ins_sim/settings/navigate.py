"""Settings of the command ``navigate``: the strapdown over a recorded IMU."""

from .field import group, setting, settings_class, SettingsGroup
from .motion import FlightColumns
from .place import Earth
from .recorded_imu import (AcceptNavigated, AlignmentSettings, GivenState, ImuColumns, INPUTS,
                           MountingAngles, RecordUnits, StampSettings)


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
class MountingSettings(MountingAngles):
    """How the IMU sits in the vehicle: the rotation from base_link to the frame of the IMU."""

    base_frame: str = setting('base_link', 'frame of the vehicle in /tf_static')


@settings_class
class StartSettings(GivenState):
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
