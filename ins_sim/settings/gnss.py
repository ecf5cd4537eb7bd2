"""Settings of the node gnss."""

from .field import group, setting, settings_class, SettingsGroup
from .fix_schedule import GnssTiming
from .node import Topics
from .place import Datum, Earth, Frames, Tf

Axes = tuple[float, ...]


def enu(default, doc, unit, low, high, equal_axes=True):
    """Return a setting of three numbers, by East, North, Up."""
    return setting(default, doc, unit, low, high, size=3, equal_axes=equal_axes)


def check_span(name, start, end):
    """Raise ValueError unless a span of time ends after it begins."""
    if end <= start:
        raise ValueError(f'{name}.end_s is {end:g} s with {name}.start_s {start:g} s; expected a '
                         'later end')


@settings_class
class GnssErrors(SettingsGroup):
    """Errors of the fixes; lists are by East, North, Up."""

    position_noise_m: Axes = enu((1.5, 1.5, 3.0), 'white noise of the position, standard '
                                 'deviation', 'm', 0.0, 1e6)
    position_drift_m: Axes = enu((0.0, 0.0, 0.0), 'correlated error of the position, stationary '
                                 'Gauss-Markov process, standard deviation', 'm', 0.0, 1e6)
    position_drift_time_s: float = setting(300.0, 'its correlation time', 's', 1e-3, 1e7)
    velocity_noise_m_s: Axes = enu((0.05, 0.05, 0.1), 'white noise of the velocity, standard '
                                   'deviation', 'm/s', 0.0, 1e4)


@settings_class
class GnssOutages(SettingsGroup):
    """Outages by schedule, in motion time; the service ~/outage forces one."""

    start_s: Axes = setting((), 'each outage begins, a fix then being none', 's', 0.0, 1e7)
    end_s: Axes = setting((), 'and ends, a fix then being one', 's', 0.0, 1e7)

    def check(self):
        """Refuse lists that do not go together."""
        if len(self.start_s) != len(self.end_s):
            raise ValueError(f'outages.start_s has {len(self.start_s)} entries and outages.end_s '
                             f'{len(self.end_s)}; expected as many')
        for start, end in zip(self.start_s, self.end_s):
            check_span('outages', start, end)


@settings_class
class GnssJump(SettingsGroup):
    """A jump of the position that the reported sigma does not know, in motion time."""

    start_s: float = setting(0.0, 'the jump begins', 's', 0.0, 1e7)
    end_s: float = setting(0.0, 'and ends', 's', 0.0, 1e7)
    offset_m: Axes = enu((0.0, 0.0, 0.0), 'offset of the position', 'm', -1e6, 1e6,
                         equal_axes=False)

    def check(self):
        """Refuse a jump that ends before it begins."""
        if any(self.offset_m):
            check_span('jump', self.start_s, self.end_s)


@settings_class
class GnssReported(SettingsGroup):
    """Standard deviations that are reported, by East, North, Up."""

    position_sigma_m: Axes = enu((-1.0, -1.0, -1.0), 'of the position; negative = that of the '
                                 'errors', 'm', -1.0, 1e6)
    velocity_sigma_m_s: Axes = enu((-1.0, -1.0, -1.0), 'of the velocity; negative = that of the '
                                   'errors', 'm/s', -1.0, 1e4)


@settings_class
class GnssSettings(SettingsGroup):
    """Node gnss."""

    SETTABLE = ('outages.start_s', 'outages.end_s', 'jump.start_s', 'jump.end_s', 'jump.offset_m')
    SPANS = ('outages',)
    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    topics: Topics = group(Topics)
    gnss: GnssTiming = group(GnssTiming)
    lever_arm_m: Axes = setting((0.0, 0.0, 0.0), 'antenna from base_link, forward, left, up', 'm',
                                -1e3, 1e3, size=3)
    errors: GnssErrors = group(GnssErrors)
    outages: GnssOutages = group(GnssOutages)
    jump: GnssJump = group(GnssJump)
    reported: GnssReported = group(GnssReported)
    seed: int = setting(0, 'seed of the random errors: the same seed, the same errors', '', 0,
                        2147483647)
    run: int = setting(0, 'number of the run in an ensemble: each draws other random errors', '',
                       0, 2147483647)
    rate_hz: float = setting(100.0, 'rate of the truth that is expected at least, that of the '
                             'IMU', 'Hz', 0.01, 20000.0)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew (reset) or end the node (stop)', choices=('reset', 'stop'))
