"""The height to which the vertical channel is damped in live navigation without truth."""

from collections import deque

from ins_sim.core.earth.atmosphere import pressure_height

# Number of heights kept until the readings of their time arrive.
MOST = 10_000


class VerticalReference:
    """
    Gives each reading the newest height that is not later; either of the two may arrive first.

    Heights of a barometer are shifted so that the first one equals the height of the start.
    """

    def __init__(self, by_pressure):
        self._by_pressure, self._heights = by_pressure, deque(maxlen=MOST)
        self._held, self._off = 0.0, None

    def begin(self, height):
        """Begin with the height of the start, m."""
        self._held, self._off = height, None

    def push_fix(self, t_ns, height):
        """Process the height of a fix, m."""
        if not self._by_pressure:
            self._heights.append((t_ns, height))

    def push_pressure(self, t_ns, static_pa):
        """Process a static pressure, Pa."""
        if self._by_pressure:
            self._heights.append((t_ns, pressure_height(static_pa)))

    def at(self, t_ns):
        """Return the height for a reading, m."""
        while self._heights and self._heights[0][0] <= t_ns:
            height = self._heights.popleft()[1]
            if self._by_pressure:
                self._off = self._held - height if self._off is None else self._off
                height += self._off
            self._held = height
        return self._held
