"""Detection of knots that jump or turn more than a vehicle can."""

import math

from ins_sim.core.numerics.instants import seconds
from ..faults import StreamFault
from .knots import LastKnots, turn_between

# Limits beyond any vehicle: acceleration, m/s^2, and turn from knot to knot, rad.
MOST_M_S2, MOST_RAD = 500.0, 2.0
# Noise of a second difference per unit noise of a position, and by how many times acceleration may
# exceed it.
SECOND_DIFFERENCE, NOISES = math.sqrt(6.0), 10.0


class StepCheck:
    """
    Raises StreamFault for knots that jump or turn too far.

    Parameters
    ----------
    name : name of the input, for messages
    """

    def __init__(self, name):
        self._name, self._last = name, LastKnots(3)

    def check(self, knot, spread_m):
        """
        Check a knot; raise StreamFault (restart) if it jumps or turns too far.

        The acceleration is that of the last three positions; spread_m is their noise, m.
        """
        last = self._last
        last.add(knot)
        if len(last) < 2:
            return
        t_ns = knot.t_ns
        turned = _length(turn_between(last[-2].q, knot.q))
        if turned > MOST_RAD:
            raise StreamFault(f'{self._name} at {seconds(t_ns)} turns {turned:.3g} rad in one '
                              f'step; expected at most {MOST_RAD:g}: raise its rate, or '
                              'rate_hz', restart=True)
        if len(last) < 3:
            return
        h0, h1 = (step * 1e-9 for step in last.steps(0, 3))
        a = _length([(z - y) / h1 - (y - x) / h0 for x, y, z in zip(
            *last.column(1, 0, 3))]) / (0.5 * (h0 + h1))
        noise = SECOND_DIFFERENCE * spread_m / (h0 * h1)
        if a > MOST_M_S2 + NOISES * noise:
            raise StreamFault(f'{self._name} jumps at {seconds(t_ns)}: its positions accelerate '
                              f'by {a:.4g} m/s^2; expected at most {MOST_M_S2:g}', restart=True)


def _length(vector):
    x, y, z = vector
    return math.sqrt(x * x + y * y + z * z)
