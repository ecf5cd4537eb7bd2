"""Settings of the motions and of the node motion_generator."""

from .field import column, group, setting, settings_class, SettingsGroup
from .guidance import GuidanceSettings, GuidedSettings
from .node import Pacing, Time, Topics
from .place import Datum, Earth, Frames, Tf
from .route import FlownRouteSettings

# With this limit the sum of three rates is less than a third of 1e4 rad/s, above which a message
# counts as damaged. A rate of half a turn or more per IMU interval is refused by another check.
FASTEST_RAD_S = 1000.0


@settings_class
class Rocking(SettingsGroup):
    """Motion 1: angle = amplitude sin(2 pi f t) about one axis."""

    axis: str = setting('north', 'Axis of the rocking: level axis (east, north, up) or body axis '
                        '(x, y, z)', choices=('east', 'north', 'up', 'x', 'y', 'z'))
    amplitude_deg: float = setting(5.0, 'Amplitude of the rocking', 'deg', 0.0, 180.0)
    frequency_hz: float = setting(1.0, 'Frequency of the rocking', 'Hz', 0.0, 1000.0)


@settings_class
class TwoAxis(SettingsGroup):
    """Motion 2: constant rates of psi and gamma at constant theta."""

    psi_rate_rad_s: float = setting(1.0, 'Rate of psi', 'rad/s', -FASTEST_RAD_S, FASTEST_RAD_S)
    gamma_rate_rad_s: float = setting(0.5, 'Rate of gamma', 'rad/s', -FASTEST_RAD_S, FASTEST_RAD_S)
    detuning_rad_s: float = setting(0.0, 'Rate added to the rate of psi, to detune the resonance '
                                    'psi_rate = 2 gamma_rate', 'rad/s', -FASTEST_RAD_S,
                                    FASTEST_RAD_S)


@settings_class
class Coning(SettingsGroup):
    """Coning: a body axis describes a cone about its mean direction."""

    axis: str = setting('z', 'Body axis that describes the cone', choices=('x', 'y', 'z'))
    half_angle_deg: float = setting(1.0, 'Half angle of the cone', 'deg', 0.0, 90.0)
    frequency_hz: float = setting(1.0, 'Frequency of the coning', 'Hz', 0.0, 1000.0)


@settings_class
class Sculling(SettingsGroup):
    """Sculling: rocking about the vertical with vibration along the mean forward axis."""

    amplitude_deg: float = setting(1.0, 'Amplitude of the rocking', 'deg', 0.0, 90.0)
    acceleration_m_s2: float = setting(5.0, 'Amplitude of the vibration', 'm/s^2', 0.0, 1000.0)
    frequency_hz: float = setting(1.0, 'Frequency of rocking and vibration', 'Hz', 0.001, 1000.0)
    phase_deg: float = setting(0.0, 'Phase of the vibration relative to the rocking', 'deg',
                               -360.0, 360.0)


@settings_class
class Sinusoids(SettingsGroup):
    """One sinusoid on each angle (psi, theta, gamma) and on each coordinate (E, N, U)."""

    angle_deg: tuple[float, ...] = setting((3.0, 2.0, 4.0), 'Amplitudes of psi, theta, gamma',
                                           'deg', -180.0, 180.0, size=3)
    angle_hz: tuple[float, ...] = setting((0.3, 0.5, 0.7), 'Frequencies of psi, theta, gamma',
                                          'Hz', 0.0, 1000.0, size=3)
    angle_phase_deg: tuple[float, ...] = setting((0.0, 40.0, 80.0), 'Phases of psi, theta, gamma',
                                                 'deg', -360.0, 360.0, size=3)
    position_m: tuple[float, ...] = setting((1.0, 1.0, 0.5), 'Amplitudes of the position: East, '
                                            'North, Up', 'm', -1e5, 1e5, size=3)
    position_hz: tuple[float, ...] = setting((0.2, 0.3, 0.4), 'Frequencies of the position: East, '
                                             'North, Up', 'Hz', 0.0, 1000.0, size=3)
    position_phase_deg: tuple[float, ...] = setting((0.0, 30.0, 60.0), 'Phases of the position: '
                                                    'East, North, Up', 'deg', -360.0, 360.0,
                                                    size=3)


@settings_class
class Harmonics(SettingsGroup):
    """Periodic angles: entry k of each list is the harmonic k + 1 of the period."""

    period_s: float = setting(10.0, 'Period of the fundamental, common to all three angles', 's',
                              1e-3, 1e6)
    psi_deg: tuple[float, ...] = setting((2.0, 1.0, 0.5), 'Amplitudes of the harmonics of psi',
                                         'deg', -180.0, 180.0)
    psi_phase_deg: tuple[float, ...] = setting((0.0, 50.0, 100.0), 'Phases of the harmonics of '
                                               'psi', 'deg', -360.0, 360.0)
    theta_deg: tuple[float, ...] = setting((1.0, 2.0, 0.5), 'Amplitudes of the harmonics of theta',
                                           'deg', -90.0, 90.0)
    theta_phase_deg: tuple[float, ...] = setting((70.0, 10.0, 120.0), 'Phases of the harmonics of '
                                                 'theta', 'deg', -360.0, 360.0)
    gamma_deg: tuple[float, ...] = setting((3.0, 1.0, 1.0), 'Amplitudes of the harmonics of gamma',
                                           'deg', -180.0, 180.0)
    gamma_phase_deg: tuple[float, ...] = setting((20.0, 90.0, 200.0), 'Phases of the harmonics of '
                                                 'gamma', 'deg', -360.0, 360.0)


@settings_class
class FlightColumns(SettingsGroup):
    """Column headers of a CSV file with a flight or a reference."""

    t_s: str = column('time')
    lat_deg: str = column('latitude')
    lon_deg: str = column('longitude')
    height_m: str = column('height')
    roll_deg: str = column('roll angle')
    pitch_deg: str = column('pitch angle')
    heading_deg: str = column('heading')
    vn_mps: str = column('velocity to the North')
    ve_mps: str = column('velocity to the East')
    vd_mps: str = column('velocity downwards')


@settings_class
class Recording(SettingsGroup):
    """A recorded flight, or the truth of a bag."""

    path: str = setting('', 'Path of the recorded flight: a CSV file, plain or gzip, or a rosbag2 '
                        'bag (folder or file)')
    topic: str = setting('auto', 'Topic of the odometry in the bag; auto: the one whose name ends '
                         'in truth/odometry')
    origin: str = setting('fix', 'Origin of the map frame of the odometry in the bag. fix: from '
                          'NavSatFix messages in the bag, or, if it has none, from datum.*, which '
                          'must then differ from the default; datum: from datum.*, even if the '
                          'bag has NavSatFix messages', choices=('fix', 'datum'))
    start_s: float = setting(3.0, 'Time of the recording that becomes motion time zero, counted '
                             'from the first row', 's', 3.0, 1e7)
    smoothing_s: float = setting(0.0, 'Length of the moving average that smooths the recording; 0 '
                                 '= no smoothing', 's', 0.0, 60.0)
    on_gap: str = setting('refuse', 'What to do about a gap or jump in the recording: refuse the '
                          'recording, or cut it there and keep the part that holds start_s',
                          choices=('refuse', 'cut'))
    columns: FlightColumns = group(FlightColumns)


_FOLDER = 'ins_sim.core.motion'
_BENCH, _FLIGHT = f'{_FOLDER}.bench:bench_motion', f'{_FOLDER}.flights:flight_motion'
# The table of motions: {kind: 'module:maker'}, where maker(MotionSettings, Datum, Earth) returns a
# Motion. Makers are named by text and imported when a motion is created, so that settings import
# only the standard library. None: the poses are in a file, which ins_sim.io.motion reads.
MOTIONS = {
    'static': _BENCH, 'rocking': _BENCH, 'two_axis': _BENCH, 'coning': _BENCH,
    'sculling': _BENCH, 'sinusoids': _BENCH, 'harmonics': _BENCH,
    'cruise': _FLIGHT, 'racetrack': _FLIGHT, 'aggressive': _FLIGHT,
    'route': f'{_FOLDER}.route.motion:route_motion',
    'guided': f'{_FOLDER}.guided.motion:guided_motion', 'recording': None}


@settings_class
class MotionSettings(SettingsGroup):
    """Motion of the vehicle; only the group that belongs to kind is used."""

    kind: str = setting('racetrack', 'Kind of the motion; the parameter group of that name holds '
                        'its details', choices=MOTIONS)
    psi_deg: float = setting(0.0, 'Mean or initial psi of the bench motions, counter-clockwise '
                             'from north', 'deg', -360.0, 360.0)
    theta_deg: float = setting(-30.0, 'Mean or initial theta of the bench motions, nose up', 'deg',
                               -89.9, 89.9)
    gamma_deg: float = setting(0.0, 'Mean or initial gamma of the bench motions, right wing down',
                               'deg', -360.0, 360.0)
    rocking: Rocking = group(Rocking)
    two_axis: TwoAxis = group(TwoAxis)
    coning: Coning = group(Coning)
    sculling: Sculling = group(Sculling)
    sinusoids: Sinusoids = group(Sinusoids)
    harmonics: Harmonics = group(Harmonics)
    route: FlownRouteSettings = group(FlownRouteSettings)
    guided: GuidedSettings = group(GuidedSettings)
    recording: Recording = group(Recording)

    @property
    def maker(self) -> str | None:
        """The entry of the kind in the table MOTIONS."""
        return MOTIONS[self.kind]

    def check(self):
        """Raise ValueError if the kind is recording and no file is given."""
        if self.kind == 'recording' and not self.recording.path:
            raise ValueError('motion.recording.path is empty; expected a CSV file or a bag for '
                             'motion.kind recording')


@settings_class
class MotionGeneratorSettings(SettingsGroup):
    """Settings of the node motion_generator."""

    SETTABLE = ('pacing.real_time_factor',)

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    time: Time = group(Time)
    motion: MotionSettings = group(MotionSettings)
    guidance: GuidanceSettings = group(GuidanceSettings)
    pacing: Pacing = group(Pacing)
    topics: Topics = group(Topics)
    rate_hz: float = setting(100.0, 'Rate of the truth messages', 'Hz', 0.01, 20000.0)
    start_s: float = setting(0.0, 'Motion time of the first sample', 's', 0.0, 1e7)
    duration_s: float = setting(3600.0, 'Length of the run; 0 = endless, which simulate refuses',
                                's', 0.0, 1e7)
    publish_clock: bool = setting(False, 'Whether to publish /clock')
    exit_at_end: bool = setting(True, 'Whether the process ends after the last sample (true) or '
                                'stays up (false)')

    def check(self):
        """Raise ValueError if the lock-step window exceeds the queue depth."""
        self.pacing.check_depth(self.topics.depth)
