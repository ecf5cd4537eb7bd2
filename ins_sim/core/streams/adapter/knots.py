"""Common parts of both schemes: samples of the input, and the most recent knots."""

from collections import deque
from typing import NamedTuple

from ins_sim.core.attitude import quaternion


class Sample(NamedTuple):
    """
    A sample of the input, in its world frame.

    Attributes
    ----------
    t_ns : motion time, ns
    r : position, m
    q : attitude of the child, a unit quaternion
    v, w : velocity (m/s) and angular rate (rad/s) in the axes of the child or of the world
    """

    t_ns: int
    r: tuple
    q: tuple
    v: tuple
    w: tuple


def turn_between(p, q):
    """Return the rotation vector from attitude p to attitude q, in the axes of p, rad."""
    return quaternion.logarithm(quaternion.multiply(quaternion.conjugate(p), q))


class LastKnots:
    """
    The most recent knots of a scheme, and the steps between them.

    Parameters
    ----------
    count : number of knots to keep
    """

    def __init__(self, count):
        self._knots = deque(maxlen=count)

    def __len__(self):
        return len(self._knots)

    def __getitem__(self, k):
        return self._knots[k]

    def add(self, knot):
        """Add a knot; its first entry must be its motion time, ns."""
        self._knots.append(knot)

    def column(self, field, first, stop):
        """Return the entry ``field`` of the knots first to stop - 1."""
        return [self._knots[k][field] for k in range(first, stop)]

    def steps(self, first, stop):
        """Return the steps between the knots first to stop - 1, ns."""
        t = self.column(0, first, stop)
        return tuple(b - a for a, b in zip(t, t[1:]))
