"""Check that the instants of readings agree with the stamps of the stream behind them."""

from ins_sim.core.numerics.instants import seconds
from .faults import StreamFault

# Number of equal steps in a row after which a stream counts as steady.
STEADY = 10


class SampleGrid:
    """
    Detects a steady stream whose stamps lie between the instants of the readings.

    The readings begin at the first sample; if that was a stray from another stream, all their
    instants are wrong.

    Parameters
    ----------
    dt_ns : period of the readings, ns
    """

    def __init__(self, dt_ns):
        self._dt_ns = dt_ns
        self._last_ns = self._step_ns = None
        self._steady = 0

    def check(self, t_ns, reading_ns):
        """Check a stamp against the instant of any reading (or None); may raise StreamFault."""
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
            raise StreamFault(f'truth at {seconds(t_ns)} is {off_ns * 1e-9:.9g} s off the '
                              'instants counted from the first sample of the truth, which came '
                              'from another stream; expected a single stream', restart=True)
