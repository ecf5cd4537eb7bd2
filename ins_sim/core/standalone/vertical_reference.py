"""The height towards which a live vertical channel without truth is damped."""

from collections import deque

from ins_sim.core.earth.atmosphere import pressure_height

# Heights that wait for the readings of their time.
MOST = 10_000


class VerticalReference:
    """
    The last height of a stamp up to that of a reading, whichever of both came first.

    Heights of a barometer are shifted so that the first one is that of the start.
    """

    def __init__(self, by_pressure):
        self._by_pressure, self._heights = by_pressure, deque(maxlen=MOST)
        self._held, self._off = 0.0, None

    def begin(self, height):
        """Begin with the height of the start, m."""
        self._held, self._off = height, None

    def push_fix(self, t_ns, height):
        """Take the height of a fix, m."""
        if not self._by_pressure:
            self._heights.append((t_ns, height))

    def push_pressure(self, t_ns, static_pa):
        """Take a static pressure, Pa."""
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
