"""What both schemes share: samples of the input, and the last of the knots made of them."""

from collections import deque
from typing import NamedTuple

from ins_sim.core.attitude import quaternion


class Sample(NamedTuple):
    """
    A sample of the input, in its world.

    t_ns: motion time; r: position, m; q: attitude of the child, a unit quaternion; v and w:
    velocity, m/s, and angular rate, rad/s, in the axes of the child or of the world.
    """

    t_ns: int
    r: tuple
    q: tuple
    v: tuple
    w: tuple


def turn_between(p, q):
    """Return the rotation vector, in the axes of p, from attitude p to attitude q."""
    return quaternion.logarithm(quaternion.multiply(quaternion.conjugate(p), q))


class LastKnots:
    """
    The last knots that a scheme looks at, and the steps between them.

    count: how many are kept.
    """

    def __init__(self, count):
        self._knots = deque(maxlen=count)

    def __len__(self):
        return len(self._knots)

    def __getitem__(self, k):
        return self._knots[k]

    def add(self, knot):
        """Keep a knot, whose first entry is its instant."""
        self._knots.append(knot)

    def column(self, field, first, stop):
        """Return an entry of the knots first to stop - 1."""
        return [self._knots[k][field] for k in range(first, stop)]

    def steps(self, first, stop):
        """Return the steps between the knots first to stop - 1, ns."""
        t = self.column(0, first, stop)
        return tuple(b - a for a, b in zip(t, t[1:]))
