"""Settings that an aiding instrument and the navigator share; ``/**`` of a file sets both."""

from .field import setting, settings_class, SettingsGroup


@settings_class
class Window(SettingsGroup):
    """
    Windows of the velocity meter, the same on both sides.

    Window m is ((m - 1) N dt, m N dt] in motion time, dt being the period of rate_hz.
    """

    cycles: int = setting(1000, 'navigation cycles that a fix averages over, N (the same in '
                          'velocity_meter and aided_navigator)', 'cycles', 1, 100000)
    latency_ms: float = setting(0.0, 'a fix is there this long after the end of its window (the '
                                'same in velocity_meter and aided_navigator)', 'ms', 0.0, 60000.0)


@settings_class
class GnssTiming(SettingsGroup):
    """When GNSS measures, and when its fix is there; the same on both sides."""

    rate_hz: float = setting(1.0, 'rate of the fixes, at whole periods of motion time (the same '
                             'in gnss and aided_navigator)', 'Hz', 0.01, 1000.0)
    latency_ms: float = setting(0.0, 'a fix is there this long after its instant (the same in '
                                'gnss and aided_navigator)', 'ms', 0.0, 60000.0)
