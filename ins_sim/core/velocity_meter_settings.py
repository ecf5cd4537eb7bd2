"""Settings of the node velocity_meter."""

from .aiding_settings import Window
from .place_settings import Datum, Earth, Time, Topics
from .setting import group, setting, Settings, settings_class


@settings_class
class VelocityMeterSettings(Settings):
    """Node velocity_meter."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    time: Time = group(Time)
    topics: Topics = group(Topics)
    window: Window = group(Window)
    seed: int = setting(0, 'seed of the random errors: the same seed, the same errors', '', 0,
                        2147483647)
    rate_hz: float = setting(100.0, 'rate of the navigation cycles, that of the IMU', 'Hz', 0.01,
                             20000.0)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew (reset) or end the node (stop)', choices=('reset', 'stop'))
