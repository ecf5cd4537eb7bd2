"""Settings of the motions and of the node motion_generator."""

from .field import column, group, setting, settings_class, SettingsGroup
from .guidance import GuidanceSettings, GuidedSettings
from .node import Pacing, Time, Topics
from .place import Datum, Earth, Frames, Tf
from .route import FlownRouteSettings

# The sum of the three is less than a third of the rate at which a message is taken to be damaged,
# 1e4 rad/s; half a turn in an interval of the IMU is refused before, by its rate.
FASTEST_RAD_S = 1000.0


@settings_class
class Rocking(SettingsGroup):
    """Motion 1: angle = amplitude sin(2 pi f t) about one axis."""

    axis: str = setting('north', 'level axis (east, north, up) or body axis (x, y, z)',
                        choices=('east', 'north', 'up', 'x', 'y', 'z'))
    amplitude_deg: float = setting(5.0, 'amplitude', 'deg', 0.0, 180.0)
    frequency_hz: float = setting(1.0, 'frequency', 'Hz', 0.0, 1000.0)


@settings_class
class TwoAxis(SettingsGroup):
    """Motion 2: constant rates of psi and gamma at constant theta."""

    psi_rate_rad_s: float = setting(1.0, 'rate of psi', 'rad/s', -FASTEST_RAD_S,
                                    FASTEST_RAD_S)
    gamma_rate_rad_s: float = setting(0.5, 'rate of gamma', 'rad/s', -FASTEST_RAD_S,
                                      FASTEST_RAD_S)
    detuning_rad_s: float = setting(0.0, 'added to the rate of psi', 'rad/s', -FASTEST_RAD_S,
                                    FASTEST_RAD_S)


@settings_class
class Coning(SettingsGroup):
    """The body axis describes a cone about its mean direction."""

    axis: str = setting('z', 'body axis that describes the cone', choices=('x', 'y', 'z'))
    half_angle_deg: float = setting(1.0, 'half angle of the cone', 'deg', 0.0, 90.0)
    frequency_hz: float = setting(1.0, 'frequency', 'Hz', 0.0, 1000.0)


@settings_class
class Sculling(SettingsGroup):
    """Rocking about the vertical with a vibration along the mean forward axis."""

    amplitude_deg: float = setting(1.0, 'amplitude of the rocking', 'deg', 0.0, 90.0)
    acceleration_m_s2: float = setting(5.0, 'amplitude of the vibration', 'm/s^2', 0.0, 1000.0)
    frequency_hz: float = setting(1.0, 'frequency of both', 'Hz', 0.001, 1000.0)
    phase_deg: float = setting(0.0, 'phase of the vibration', 'deg', -360.0, 360.0)


@settings_class
class Sinusoids(SettingsGroup):
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
class Harmonics(SettingsGroup):
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
class FlightColumns(SettingsGroup):
    """Headers of a CSV file of a flight, or of a reference."""

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

    path: str = setting('', 'CSV file, plain or gzip, or rosbag2 bag (folder or file)')
    topic: str = setting('auto', 'odometry in the bag; auto: the one that ends in truth/odometry')
    origin: str = setting('fix', 'origin of the map frame of an odometry in the bag. fix: where a '
                          'NavSatFix beside it puts it; without one, datum.* if it is not the '
                          'default; datum: datum.*, whatever else the bag holds',
                          choices=('fix', 'datum'))
    start_s: float = setting(3.0, 'recorder time of motion time zero, from the first row', 's',
                             3.0, 1e7)
    smoothing_s: float = setting(0.0, 'window of the boxcar smoothing; 0 = none', 's', 0.0, 60.0)
    on_gap: str = setting('refuse', 'what to do about a gap or jump in the recording: refuse '
                          'it, or cut the recording there and keep the part that holds start_s',
                          choices=('refuse', 'cut'))
    columns: FlightColumns = group(FlightColumns)


_FOLDER = 'ins_sim.core.motion'
_BENCH, _FLIGHT = f'{_FOLDER}.bench:bench_motion', f'{_FOLDER}.flights:flight_motion'
# The one table of the motions: {kind: 'module:maker'}, where maker(MotionSettings, Datum, Earth)
# returns a Motion. Makers are named by text and imported when a motion is made, because settings
# need nothing but Python. None: the poses are in a file, which ins_sim.io.motion reads.
MOTIONS = {
    'static': _BENCH, 'rocking': _BENCH, 'two_axis': _BENCH, 'coning': _BENCH,
    'sculling': _BENCH, 'sinusoids': _BENCH, 'harmonics': _BENCH,
    'cruise': _FLIGHT, 'racetrack': _FLIGHT, 'aggressive': _FLIGHT,
    'route': f'{_FOLDER}.route.motion:route_motion',
    'guided': f'{_FOLDER}.guided.motion:guided_motion', 'recording': None}


@settings_class
class MotionSettings(SettingsGroup):
    """The motion; only the group of its kind is used."""

    kind: str = setting('racetrack', 'which motion', choices=MOTIONS)
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
    route: FlownRouteSettings = group(FlownRouteSettings)
    guided: GuidedSettings = group(GuidedSettings)
    recording: Recording = group(Recording)

    @property
    def maker(self) -> str | None:
        """The entry of the kind in the table MOTIONS."""
        return MOTIONS[self.kind]

    def check(self):
        """Refuse a recording without a file."""
        if self.kind == 'recording' and not self.recording.path:
            raise ValueError('motion.recording.path is empty; motion.kind recording expects a CSV '
                             'file or a bag')


@settings_class
class MotionGeneratorSettings(SettingsGroup):
    """Node motion_generator."""

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
    rate_hz: float = setting(100.0, 'rate of the truth', 'Hz', 0.01, 20000.0)
    start_s: float = setting(0.0, 'motion time of the first sample', 's', 0.0, 1e7)
    duration_s: float = setting(3600.0, 'length of the run; 0 = endless (in simulate: refused)',
                                's', 0.0, 1e7)
    publish_clock: bool = setting(False, 'publish /clock')
    exit_at_end: bool = setting(True, 'end the process after the last sample; else stay up')

    def check(self):
        """Refuse a window of lock-step that the queues cannot hold."""
        self.pacing.check_depth(self.topics.depth)
