"""Settings of the node gnss."""

from .field import group, setting, settings_class, SettingsGroup
from .fix_schedule import GnssTiming
from .node import Topics
from .place import Datum, Earth, Frames, Tf

Axes = tuple[float, ...]


def enu(default, doc, unit, low, high, equal_axes=True):
    """Return a setting of three numbers: East, North, Up."""
    return setting(default, doc, unit, low, high, size=3, equal_axes=equal_axes)


def check_span(name, start, end):
    """Raise ValueError unless an interval ends after it begins."""
    if end <= start:
        raise ValueError(f'{name}.end_s is {end:g} s with {name}.start_s {start:g} s; expected a '
                         'later end')


@settings_class
class GnssErrors(SettingsGroup):
    """Errors of the fixes; lists are in the order East, North, Up."""

    position_noise_m: Axes = enu((1.5, 1.5, 3.0), 'Standard deviation of the white noise of the '
                                 'position', 'm', 0.0, 1e6)
    position_drift_m: Axes = enu((0.0, 0.0, 0.0), 'Standard deviation of the correlated position '
                                 'error, a stationary Gauss-Markov process', 'm', 0.0, 1e6)
    position_drift_time_s: float = setting(300.0, 'Correlation time of the correlated position '
                                           'error', 's', 1e-3, 1e7)
    velocity_noise_m_s: Axes = enu((0.05, 0.05, 0.1), 'Standard deviation of the white noise of '
                                   'the velocity', 'm/s', 0.0, 1e4)


@settings_class
class GnssOutages(SettingsGroup):
    """Scheduled outages in motion time; the service ~/outage forces one at any time."""

    start_s: Axes = setting((), 'Motion time at which each outage begins; fixes during an outage '
                            'are invalid', 's', 0.0, 1e7)
    end_s: Axes = setting((), 'Motion time at which each outage ends; a fix at this instant is '
                          'valid', 's', 0.0, 1e7)

    def check(self):
        """Raise ValueError unless each outage has a start and a later end."""
        if len(self.start_s) != len(self.end_s):
            raise ValueError(f'outages.start_s has {len(self.start_s)} entries and outages.end_s '
                             f'{len(self.end_s)}; expected equal numbers')
        for start, end in zip(self.start_s, self.end_s):
            check_span('outages', start, end)


@settings_class
class GnssJump(SettingsGroup):
    """Position jump in motion time, which the reported standard deviation does not include."""

    start_s: float = setting(0.0, 'Motion time at which the jump begins', 's', 0.0, 1e7)
    end_s: float = setting(0.0, 'Motion time at which the jump ends', 's', 0.0, 1e7)
    offset_m: Axes = enu((0.0, 0.0, 0.0), 'Position offset during the jump: East, North, Up', 'm',
                         -1e6, 1e6, equal_axes=False)

    def check(self):
        """Raise ValueError if the jump ends before it begins."""
        if any(self.offset_m):
            check_span('jump', self.start_s, self.end_s)


@settings_class
class GnssReported(SettingsGroup):
    """Reported standard deviations, in the order East, North, Up."""

    position_sigma_m: Axes = enu((-1.0, -1.0, -1.0), 'Standard deviation reported for the '
                                 'position; negative = standard deviation of the simulated errors',
                                 'm', -1.0, 1e6)
    velocity_sigma_m_s: Axes = enu((-1.0, -1.0, -1.0), 'Standard deviation reported for the '
                                   'velocity; negative = standard deviation of the simulated '
                                   'errors', 'm/s', -1.0, 1e4)


@settings_class
class GnssSettings(SettingsGroup):
    """Settings of the node gnss."""

    SETTABLE = ('outages.start_s', 'outages.end_s', 'jump.start_s', 'jump.end_s', 'jump.offset_m')
    SPANS = ('outages',)
    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    topics: Topics = group(Topics)
    gnss: GnssTiming = group(GnssTiming)
    lever_arm_m: Axes = setting((0.0, 0.0, 0.0), 'Position of the GNSS antenna relative to '
                                'base_link: forward, left, up', 'm', -1e3, 1e3, size=3)
    errors: GnssErrors = group(GnssErrors)
    outages: GnssOutages = group(GnssOutages)
    jump: GnssJump = group(GnssJump)
    reported: GnssReported = group(GnssReported)
    seed: int = setting(0, 'Seed of the random errors; the same seed gives the same errors', '', 0,
                        2147483647)
    run: int = setting(0, 'Number of the run in a Monte Carlo ensemble; each number gives other '
                       'random errors', '', 0, 2147483647)
    rate_hz: float = setting(100.0, 'Lowest rate of truth samples that is accepted; give the rate '
                             'of the IMU', 'Hz', 0.01, 20000.0)
    on_fault: str = setting('reset', 'What the node does after a gap, a backward time stamp or an '
                            'invalid message: start anew (reset) or end (stop)',
                            choices=('reset', 'stop'))
