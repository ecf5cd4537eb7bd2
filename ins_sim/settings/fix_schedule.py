"""Settings shared by an aiding sensor and the navigator; give them under ``/**`` to set both."""

from .field import setting, settings_class, SettingsGroup


@settings_class
class Window(SettingsGroup):
    """
    Averaging windows of the velocity meter (both nodes need the same).

    Window k is (k m dt - N dt, k m dt] in motion time, where dt is the period of rate_hz, N the
    cycles in a window and m <= N the cycles from the end of one window to the end of the next.
    """

    cycles: int = setting(1000, 'Number N of navigation cycles that a fix averages over; must be '
                          'the same in velocity_meter and aided_navigator', 'cycles', 1, 100000)
    slide_cycles: int = setting(0, 'Number of cycles from the end of one window to the end of the '
                                'next, a divisor of N. Less than N: windows overlap, which only '
                                'the filters conventional and free accept. 0 or N: windows follow '
                                'one another without overlap. Must be the same in velocity_meter '
                                'and aided_navigator', 'cycles', 0, 100000)
    latency_ms: float = setting(0.0, 'Delay from the end of a window to the delivery of its fix; '
                                'must be the same in velocity_meter and aided_navigator', 'ms',
                                0.0, 60000.0)

    @property
    def step_cycles(self):
        """Return the number of cycles from the end of a window to the end of the next."""
        return self.slide_cycles or self.cycles

    @property
    def slides(self):
        """Return whether windows overlap."""
        return self.step_cycles < self.cycles

    def check(self):
        """Raise ValueError unless a window has a whole number of slides."""
        if self.cycles % self.step_cycles:
            raise ValueError(f'window.slide_cycles is {self.slide_cycles} with window.cycles '
                             f'{self.cycles}; expected 0 or a divisor of window.cycles')


@settings_class
class GnssTiming(SettingsGroup):
    """Rate and latency of the GNSS fixes (both nodes need the same)."""

    rate_hz: float = setting(1.0, 'Rate of the fixes, which fall on whole multiples of the period '
                             'in motion time; must be the same in gnss and aided_navigator', 'Hz',
                             0.01, 1000.0)
    latency_ms: float = setting(0.0, 'Delay from the instant of a fix to its delivery; must be '
                                'the same in gnss and aided_navigator', 'ms', 0.0, 60000.0)
