"""Settings of the node gnss."""

from .aiding_settings import GnssTiming
from .place_settings import Datum, Earth, Time, Topics
from .setting import group, setting, Settings, settings_class


@settings_class
class GnssSettings(Settings):
    """Node gnss."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    time: Time = group(Time)
    topics: Topics = group(Topics)
    gnss: GnssTiming = group(GnssTiming)
    seed: int = setting(0, 'seed of the random errors: the same seed, the same errors', '', 0,
                        2147483647)
    rate_hz: float = setting(100.0, 'rate of the truth that is expected at least, that of the '
                             'IMU', 'Hz', 0.01, 20000.0)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew (reset) or end the node (stop)', choices=('reset', 'stop'))
