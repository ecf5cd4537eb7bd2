"""Settings of the node aided_navigator."""

from collections import namedtuple

from .field import group, setting, settings_class, SettingsGroup
from .fix_schedule import GnssTiming, Window
from .node import Topics
from .place import Datum, Earth, Frames, Tf
from .route import RouteSettings

# A filter: where its class is ('module:class'), the instruments whose fixes it processes, and
# whether windows of the velocity meter may overlap.
FilterEntry = namedtuple('FilterEntry', 'location takes_velocity takes_gnss takes_sliding',
                         defaults=(True, False, False))
_FOLDER = 'ins_sim.core.aiding.filters'
# The one table of the aiding filters. Classes are named by text and imported when an
# AidedNavigator is made, because settings need nothing but Python.
FILTERS = {
    'free': FilterEntry(f'{_FOLDER}.base:NoCorrection', takes_velocity=False,
                        takes_sliding=True),
    'conventional': FilterEntry(f'{_FOLDER}.fixed_gain:ConventionalFilter', takes_sliding=True),
    'paper': FilterEntry(f'{_FOLDER}.fixed_gain:PaperFilter'),
    'paper_corrected': FilterEntry(f'{_FOLDER}.fixed_gain:PaperCorrectedFilter'),
    'window_kf': FilterEntry(f'{_FOLDER}.window_kalman:WindowFilter'),
    'eskf': FilterEntry(f'{_FOLDER}.eskf:ErrorStateFilter', takes_gnss=True),
}


@settings_class
class AidedVertical(SettingsGroup):
    """The vertical channel."""

    channel: str = setting('altimeter', 'height and vertical velocity of the truth, as from an '
                           'altimeter, or free (eskf: aided by GNSS)',
                           choices=('altimeter', 'free'))
    height_sigma_m: float = setting(0.3, 'standard deviation the filter gives the height of the '
                                    'altimeter', 'm', 1e-3, 1000.0)
    velocity_sigma_m_s: float = setting(0.02, 'and the vertical velocity', 'm/s', 1e-4, 100.0)


@settings_class
class InitialSigmas(SettingsGroup):
    """Initial errors: drawn from the seed with these standard deviations, and the filter's own."""

    after_s: float = setting(0.0, 'start this long after the first IMU sample', 's', 0.0, 1e6)
    position_sigma_m: float = setting(0.0, 'horizontal position, each axis', 'm', 0.0, 1e6)
    velocity_sigma_m_s: float = setting(0.05, 'horizontal velocity, each axis', 'm/s', 0.0, 1e3)
    tilt_sigma_mrad: float = setting(0.3, 'tilt, each axis', 'mrad', 0.0, 500.0)
    azimuth_sigma_mrad: float = setting(1.5, 'azimuth', 'mrad', 0.0, 500.0)


@settings_class
class ImuModel(SettingsGroup):
    """What the filter believes of the IMU (a mid-grade one by default)."""

    gyro_bias_sigma_deg_h: float = setting(0.05, 'gyro bias at the start', 'deg/h', 0.0, 1e5)
    gyro_bias_walk_deg_h_sqrt_h: float = setting(0.0, 'its random walk', 'deg/h/sqrt(h)', 0.0,
                                                 1e5)
    angle_random_walk_deg_sqrt_h: float = setting(0.01, 'angle random walk', 'deg/sqrt(h)', 0.0,
                                                  1e3)
    gyro_scale_sigma_ppm: float = setting(0.0, 'scale factors and misalignment of the gyros, '
                                          'seen in turns', 'ppm', 0.0, 1e5)
    accelerometer_bias_sigma_ug: float = setting(200.0, 'accelerometer bias at the start', 'ug',
                                                 0.0, 1e7)
    accelerometer_bias_walk_ug_sqrt_h: float = setting(0.0, 'its random walk', 'ug/sqrt(h)', 0.0,
                                                       1e7)
    velocity_random_walk_m_s_sqrt_h: float = setting(0.018, 'velocity random walk (30 '
                                                     'ug/sqrt(Hz))', 'm/s/sqrt(h)', 0.0, 1e3)


@settings_class
class MeterModel(SettingsGroup):
    """What the filter believes of the velocity meter at the start."""

    use: bool = setting(True, 'the velocity meter aids')
    bias_x_m_s: float = setting(-16.0, 'known forward bias of the fits of one cycle; that of a '
                                'fix is this over window.cycles, and is taken off', 'm/s', -1e3,
                                1e3)
    mounting_sigma_arcmin: float = setting(0.0, 'mounting error in yaw; 0 = known', 'arcmin', 0.0,
                                           600.0)
    scale_x_sigma: float = setting(0.0, 'forward scale error; 0 = known', '', 0.0, 1.0)
    scale_z_sigma: float = setting(0.0, 'lateral scale error; 0 = known', '', 0.0, 1.0)


@settings_class
class GnssModel(SettingsGroup):
    """How the navigator takes GNSS."""

    use: bool = setting(False, 'GNSS aids')
    lever_arm_m: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'antenna from base_link, forward, '
                                             'left, up', 'm', -1e3, 1e3, size=3)


@settings_class
class ReferenceRoute(SettingsGroup):
    """The route that orthodromic coordinates refer to, under the names of the motion's."""

    route: RouteSettings = group(RouteSettings)


@settings_class
class AidedNavigatorSettings(SettingsGroup):
    """Node aided_navigator."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    motion: ReferenceRoute = group(ReferenceRoute)
    topics: Topics = group(Topics)
    window: Window = group(Window)
    gnss: GnssTiming = group(GnssTiming)
    filter: str = setting('eskf', 'how the fixes correct the solution', choices=FILTERS)
    vertical: AidedVertical = group(AidedVertical)
    initial: InitialSigmas = group(InitialSigmas)
    imu_model: ImuModel = group(ImuModel)
    meter_model: MeterModel = group(MeterModel)
    gnss_model: GnssModel = group(GnssModel)
    seed: int = setting(0, 'seed of the random errors: the same seed, the same errors', '', 0,
                        2147483647)
    run: int = setting(0, 'number of the run in an ensemble: each draws other random errors', '',
                       0, 2147483647)
    rate_hz: float = setting(100.0, 'rate of the IMU', 'Hz', 0.01, 20000.0)
    input: str = setting('rotation_vector', 'what the IMU sends (imu_sensor: output)',
                         choices=('rotation_vector', 'integrated'))
    output_every: int = setting(1, 'publish every n-th step', 'steps', 1, 1000000)
    covariance_every: int = setting(10, 'eskf: IMU steps in a step of the covariance', 'steps',
                                    1, 1000)
    gain: float = setting(0.4, 'conventional: part of the velocity error that a fix takes away; '
                          'paper (0 to 1) and paper_corrected (0 to 2): gain of the acceleration',
                          '', 0.0, 2.0)
    gain_per_s: float = setting(1.0, 'conventional with windows that overlap (window.slide_cycles)'
                                ', in place of gain: part of the velocity error that is taken '
                                'away in a second, K_v', '1/s', 0.0, 1e4)
    gate_probability: float = setting(1e-6, 'a fix less likely than this by its innovation is not '
                                      'taken; 0 = all are', '', 0.0, 0.5)
    buffer_s: float = setting(10.0, 'how late a fix may be', 's', 0.0, 600.0)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew from truth (reset) or end the node (stop)',
                            choices=('reset', 'stop'))

    def check(self):
        """Refuse a filter, a gain and latencies that do not go together."""
        takes_gnss = [name for name, entry in FILTERS.items() if entry.takes_gnss]
        if self.gnss_model.use and self.filter not in takes_gnss:
            raise ValueError(f'gnss_model.use is true with filter {self.filter}; expected a '
                             f'filter that takes GNSS: {", ".join(takes_gnss)}')
        self._check_windows()
        if self.filter == 'paper' and self.gain > 1.0:
            raise ValueError(f'gain is {self.gain:g} with filter paper; expected at most 1, '
                             'beyond which it is unstable')
        for name, latency_ms in (('window', self.window.latency_ms),
                                 ('gnss', self.gnss.latency_ms)):
            if latency_ms > 1e3 * self.buffer_s:
                raise ValueError(f'{name}.latency_ms is {latency_ms:g} ms; expected at most '
                                 f'buffer_s, {self.buffer_s:g} s: such fixes come too late')

    def _check_windows(self):
        """Refuse windows that overlap with a filter that follows one, and a gain too high."""
        if not self.window.slides:
            return
        slide = f'window.slide_cycles is {self.window.slide_cycles}'
        if not FILTERS[self.filter].takes_sliding:
            takes = [name for name, entry in FILTERS.items() if entry.takes_sliding]
            raise ValueError(f'{slide} with filter {self.filter}, which needs windows that do not '
                             f'overlap; expected 0, or filter {" or ".join(takes)}')
        most = 2.0 * self.rate_hz / self.window.slide_cycles
        if self.filter == 'conventional' and self.gain_per_s >= most:
            raise ValueError(f'gain_per_s is {self.gain_per_s:g} 1/s, and {slide}; expected less '
                             f'than {most:g} 1/s, two over the time between fixes, beyond which '
                             'conventional is unstable')
