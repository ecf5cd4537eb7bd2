"""Settings of the node gnss."""

from .field import group, setting, Settings, settings_class
from .fix_schedule import GnssTiming
from .node import Time, Topics
from .place import Datum, Earth

Axes = tuple[float, ...]


def enu(default, doc, unit, low, high):
    """Return a setting of three numbers, by East, North, Up."""
    return setting(default, doc, unit, low, high, size=3)


@settings_class
class GnssErrors(Settings):
    """Errors of the fixes; lists are by East, North, Up."""

    position_noise_m: Axes = enu((1.5, 1.5, 3.0), 'white noise of the position, standard '
                                 'deviation', 'm', 0.0, 1e6)
    position_drift_m: Axes = enu((0.0, 0.0, 0.0), 'correlated error of the position, stationary '
                                 'Gauss-Markov process, standard deviation', 'm', 0.0, 1e6)
    position_drift_time_s: float = setting(300.0, 'its correlation time', 's', 1e-3, 1e7)
    velocity_noise_m_s: Axes = enu((0.05, 0.05, 0.1), 'white noise of the velocity, standard '
                                   'deviation', 'm/s', 0.0, 1e4)


@settings_class
class GnssOutages(Settings):
    """Outages by schedule, in motion time; the service ~/outage forces one."""

    start_s: Axes = setting((), 'each outage begins, a fix then being none', 's', 0.0, 1e7)
    end_s: Axes = setting((), 'and ends, a fix then being one', 's', 0.0, 1e7)


@settings_class
class GnssJump(Settings):
    """A jump of the position that the reported sigma does not know, in motion time."""

    start_s: float = setting(0.0, 'the jump begins', 's', 0.0, 1e7)
    end_s: float = setting(0.0, 'and ends', 's', 0.0, 1e7)
    offset_m: Axes = enu((0.0, 0.0, 0.0), 'offset of the position', 'm', -1e6, 1e6)


@settings_class
class GnssReported(Settings):
    """Standard deviations that are reported, by East, North, Up."""

    position_sigma_m: Axes = enu((-1.0, -1.0, -1.0), 'of the position; negative = that of the '
                                 'errors', 'm', -1.0, 1e6)
    velocity_sigma_m_s: Axes = enu((-1.0, -1.0, -1.0), 'of the velocity; negative = that of the '
                                   'errors', 'm/s', -1.0, 1e4)


@settings_class
class GnssSettings(Settings):
    """Node gnss."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    time: Time = group(Time)
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
    rate_hz: float = setting(100.0, 'rate of the truth that is expected at least, that of the '
                             'IMU', 'Hz', 0.01, 20000.0)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew (reset) or end the node (stop)', choices=('reset', 'stop'))
