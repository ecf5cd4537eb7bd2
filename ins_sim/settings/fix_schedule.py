"""Settings that an aiding instrument and the navigator share; ``/**`` of a file sets both."""

from .field import setting, settings_class, SettingsGroup


@settings_class
class Window(SettingsGroup):
    """
    Windows of the velocity meter, the same on both sides.

    Window k is (k m dt - N dt, k m dt] in motion time, dt being the period of rate_hz and m the
    cycles from end to end, N or fewer.
    """

    cycles: int = setting(1000, 'navigation cycles that a fix averages over, N (the same in '
                          'velocity_meter and aided_navigator)', 'cycles', 1, 100000)
    slide_cycles: int = setting(0, 'cycles from the end of a window to that of the next, a '
                                'divisor of N: windows overlap, which of the filters conventional '
                                'alone takes; 0 or N: they follow one another (the same in both)',
                                'cycles', 0, 100000)
    latency_ms: float = setting(0.0, 'a fix is there this long after the end of its window (the '
                                'same in velocity_meter and aided_navigator)', 'ms', 0.0, 60000.0)

    @property
    def step_cycles(self):
        """Return the cycles from the end of a window to that of the next."""
        return self.slide_cycles or self.cycles

    @property
    def slides(self):
        """Return whether windows overlap."""
        return self.step_cycles < self.cycles

    def check(self):
        """Refuse windows that do not end where a whole number of slides does."""
        if self.cycles % self.step_cycles:
            raise ValueError(f'window.slide_cycles is {self.slide_cycles} with window.cycles '
                             f'{self.cycles}; expected 0 or a divisor of window.cycles')


@settings_class
class GnssTiming(SettingsGroup):
    """When GNSS measures, and when its fix is there; the same on both sides."""

    rate_hz: float = setting(1.0, 'rate of the fixes, at whole periods of motion time (the same '
                             'in gnss and aided_navigator)', 'Hz', 0.01, 1000.0)
    latency_ms: float = setting(0.0, 'a fix is there this long after its instant (the same in '
                                'gnss and aided_navigator)', 'ms', 0.0, 60000.0)
