"""Settings of the node aided_navigator."""

from collections import namedtuple

from .field import group, setting, settings_class, SettingsGroup
from .fix_schedule import GnssTiming, Window
from .node import Topics
from .place import Datum, Earth, Frames, Tf
from .route import RouteSettings

# A filter: the location of its class ('module:class'), the sensors whose fixes it processes, and
# whether it accepts overlapping windows of the velocity meter.
FilterEntry = namedtuple('FilterEntry', 'location takes_velocity takes_gnss takes_sliding',
                         defaults=(True, False, False))
_FOLDER = 'ins_sim.core.aiding.filters'
# The table of aiding filters. Classes are named by text and imported when an AidedNavigator is
# created, so that settings import only the standard library.
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
    """Vertical channel."""

    channel: str = setting('altimeter', 'How height and vertical velocity are found: altimeter, '
                           'taken from the truth as from an ideal altimeter; free, integrated '
                           '(with eskf aided by GNSS)', choices=('altimeter', 'free'))
    height_sigma_m: float = setting(0.3, 'Standard deviation that the filter assumes for the '
                                    'height of the altimeter', 'm', 1e-3, 1000.0)
    velocity_sigma_m_s: float = setting(0.02, 'Standard deviation that the filter assumes for the '
                                        'vertical velocity of the altimeter', 'm/s', 1e-4, 100.0)


@settings_class
class InitialSigmas(SettingsGroup):
    """Initial errors, drawn with these standard deviations, which the filter also assumes."""

    after_s: float = setting(0.0, 'Time from the first IMU sample to the start of the navigation',
                             's', 0.0, 1e6)
    position_sigma_m: float = setting(0.0, 'Standard deviation of the initial horizontal position '
                                      'error, each axis', 'm', 0.0, 1e6)
    velocity_sigma_m_s: float = setting(0.05, 'Standard deviation of the initial horizontal '
                                        'velocity error, each axis', 'm/s', 0.0, 1e3)
    tilt_sigma_mrad: float = setting(0.3, 'Standard deviation of the initial tilt error, each '
                                     'axis', 'mrad', 0.0, 500.0)
    azimuth_sigma_mrad: float = setting(1.5, 'Standard deviation of the initial azimuth error',
                                        'mrad', 0.0, 500.0)


@settings_class
class ImuModel(SettingsGroup):
    """IMU errors that the filter assumes; the defaults are those of a mid-grade IMU."""

    gyro_bias_sigma_deg_h: float = setting(0.05, 'Standard deviation of the gyro bias at the '
                                           'start', 'deg/h', 0.0, 1e5)
    gyro_bias_walk_deg_h_sqrt_h: float = setting(0.0, 'Random walk of the gyro bias',
                                                 'deg/h/sqrt(h)', 0.0, 1e5)
    angle_random_walk_deg_sqrt_h: float = setting(0.01, 'Angle random walk of the gyros',
                                                  'deg/sqrt(h)', 0.0, 1e3)
    gyro_scale_sigma_ppm: float = setting(0.0, 'Standard deviation of scale factor error and '
                                          'misalignment of the gyros together, which the filter '
                                          'treats as noise during turns', 'ppm', 0.0, 1e5)
    accelerometer_bias_sigma_ug: float = setting(200.0, 'Standard deviation of the accelerometer '
                                                 'bias at the start', 'ug', 0.0, 1e7)
    accelerometer_bias_walk_ug_sqrt_h: float = setting(0.0, 'Random walk of the accelerometer '
                                                       'bias', 'ug/sqrt(h)', 0.0, 1e7)
    velocity_random_walk_m_s_sqrt_h: float = setting(0.018, 'Velocity random walk of the '
                                                     'accelerometers; the default is 30 '
                                                     'ug/sqrt(Hz)', 'm/s/sqrt(h)', 0.0, 1e3)


@settings_class
class MeterModel(SettingsGroup):
    """Errors of the velocity meter that the filter assumes at the start."""

    use: bool = setting(True, 'Whether fixes of the velocity meter are processed')
    bias_x_m_s: float = setting(-16.0, 'Known bias of the forward velocity from a fit over one '
                                'cycle. The bias of a fix is this value divided by window.cycles; '
                                'it is subtracted', 'm/s', -1e3, 1e3)
    mounting_sigma_arcmin: float = setting(0.0, 'Standard deviation of the yaw mounting error of '
                                           'the antennas; 0 = the mounting is known and not '
                                           'estimated', 'arcmin', 0.0, 600.0)
    scale_x_sigma: float = setting(0.0, 'Standard deviation of the forward scale error; 0 = known '
                                   'and not estimated', '', 0.0, 1.0)
    scale_z_sigma: float = setting(0.0, 'Standard deviation of the lateral scale error; 0 = known '
                                   'and not estimated', '', 0.0, 1.0)


@settings_class
class GnssModel(SettingsGroup):
    """GNSS aiding."""

    use: bool = setting(False, 'Whether GNSS fixes are processed')
    lever_arm_m: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'Position of the GNSS antenna that '
                                             'the filter assumes, relative to base_link: forward, '
                                             'left, up', 'm', -1e3, 1e3, size=3)


@settings_class
class ReferenceRoute(SettingsGroup):
    """Route to which the orthodromic coordinates refer; same names as the route of the motion."""

    route: RouteSettings = group(RouteSettings)


@settings_class
class AidedNavigatorSettings(SettingsGroup):
    """Settings of the node aided_navigator."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    motion: ReferenceRoute = group(ReferenceRoute)
    topics: Topics = group(Topics)
    window: Window = group(Window)
    gnss: GnssTiming = group(GnssTiming)
    filter: str = setting('eskf', 'Aiding filter, which decides how fixes correct the solution',
                          choices=FILTERS)
    vertical: AidedVertical = group(AidedVertical)
    initial: InitialSigmas = group(InitialSigmas)
    imu_model: ImuModel = group(ImuModel)
    meter_model: MeterModel = group(MeterModel)
    gnss_model: GnssModel = group(GnssModel)
    seed: int = setting(0, 'Seed of the random errors; the same seed gives the same errors', '', 0,
                        2147483647)
    run: int = setting(0, 'Number of the run in a Monte Carlo ensemble; each number gives other '
                       'random errors', '', 0, 2147483647)
    rate_hz: float = setting(100.0, 'Rate of the IMU', 'Hz', 0.01, 20000.0)
    input: str = setting('rotation_vector', 'Meaning of the IMU samples; must equal output of '
                         'imu_sensor', choices=('rotation_vector', 'integrated'))
    output_every: int = setting(1, 'Number of steps from one published solution to the next',
                                'steps', 1, 1000000)
    covariance_every: int = setting(10, 'Number of IMU steps in one propagation step of the '
                                    'covariance (eskf only)', 'steps', 1, 1000)
    gain: float = setting(0.4, 'Gain of the fixed-gain filters. conventional: fraction of the '
                          'velocity error that a fix corrects; paper (0 to 1) and paper_corrected '
                          '(0 to 2): gain of the acceleration', '', 0.0, 2.0)
    gain_per_s: float = setting(1.0, 'Gain K_v that conventional uses instead of gain when '
                                'windows overlap (window.slide_cycles): fraction of the velocity '
                                'error corrected per second', '1/s', 0.0, 1e4)
    gate_probability: float = setting(1e-6, 'Probability threshold of the innovation test: a fix '
                                      'whose innovation is less likely than this is rejected; 0 = '
                                      'no test', '', 0.0, 0.5)
    buffer_s: float = setting(10.0, 'Length of the stored history, which is the greatest age at '
                              'which a late fix is still processed', 's', 0.0, 600.0)
    on_fault: str = setting('reset', 'What the node does after a gap, a backward time stamp or an '
                            'invalid message: start anew from truth (reset) or end (stop)',
                            choices=('reset', 'stop'))

    def check(self):
        """Raise ValueError on a filter, gain or latency that contradicts other settings."""
        takes_gnss = [name for name, entry in FILTERS.items() if entry.takes_gnss]
        if self.gnss_model.use and self.filter not in takes_gnss:
            raise ValueError(f'gnss_model.use is true with filter {self.filter}; expected a '
                             f'filter that processes GNSS: {", ".join(takes_gnss)}')
        self._check_windows()
        if self.filter == 'paper' and self.gain > 1.0:
            raise ValueError(f'gain is {self.gain:g} with filter paper; expected at most 1, '
                             'because the filter is unstable above that')
        for name, latency_ms in (('window', self.window.latency_ms),
                                 ('gnss', self.gnss.latency_ms)):
            if latency_ms > 1e3 * self.buffer_s:
                raise ValueError(f'{name}.latency_ms is {latency_ms:g} ms; expected at most '
                                 f'buffer_s, {self.buffer_s:g} s: older fixes are not processed')

    def _check_windows(self):
        """Raise ValueError on overlapping windows that the filter or its gain does not allow."""
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
                             f'than {most:g} 1/s, two divided by the time between fixes, because '
                             'the filter conventional is unstable above that')
