"""The instants of readings, counted from the first sample, and those of the samples behind it."""

from ins_sim.core.numerics.instants import seconds
from .faults import StreamFault

# so many equal steps in a row are no jitter
STEADY = 10


class SampleGrid:
    """
    Sees that a steady stream goes on between the instants of the readings it has begun.

    That is so where the first sample was not of this stream: a stray one.  dt_ns: period of the
    readings.
    """

    def __init__(self, dt_ns):
        self._dt_ns = dt_ns
        self._last_ns = self._step_ns = None
        self._steady = 0

    def check(self, t_ns, reading_ns):
        """Raise StreamFault (restart) for such a sample; reading_ns: of any reading, or None."""
        step_ns = None if self._last_ns is None else t_ns - self._last_ns
        self._last_ns = t_ns
        if step_ns != self._step_ns:
            self._step_ns, self._steady = step_ns, 0
            return
        self._steady += 1
        if self._steady != STEADY or not step_ns or reading_ns is None:
            return
        self._steady = 0
        shorter, longer = sorted((step_ns, self._dt_ns))
        off_ns = (t_ns - reading_ns) % shorter if shorter > 0 else 0
        if off_ns and longer % shorter == 0:
            raise StreamFault(f'truth at {seconds(t_ns)} goes on {off_ns * 1e-9:.9g} s beside the '
                              'instants it began with: its first sample was not of this stream',
                              restart=True)
