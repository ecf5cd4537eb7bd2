"""
The scheme without twist: derivatives of position and attitude from the poses alone.

Position is a quintic with given position, velocity and acceleration at both knots; the derivatives
come from five positions each. Attitude is a Hermite curve on SO(3) whose rates come from five
quaternions.
"""

from .knots import LastKnots, turn_between
from .piece import Piece
from .stencils import MIDDLE, POINTS, stencil, weighted


class PoseKnots:
    """Makes pieces from samples: the piece up to knot k is available with knot k + 2."""

    def __init__(self):
        self._last = LastKnots(POINTS)
        self._before = None

    def push(self, sample):
        """Process a Sample as the next knot; return the Piece that it completes, or None."""
        q = sample.q
        if len(self._last) and _are_opposite(q, self._last[-1].q):
            sample = sample._replace(q=tuple(-x for x in q))
        self._last.add(sample)
        if len(self._last) < POINTS:
            return None
        start, self._before = self._before, self._derivatives()
        return None if start is None else _piece(start, self._before)

    def _derivatives(self):
        """Return t_ns, r, v, a, q and w of the middle knot."""
        t_ns, r, q = self._last[MIDDLE][:3]
        first, second = stencil(self._last.steps(0, POINTS), MIDDLE)
        places = self._last.column(1, 0, POINTS)
        turns = [turn_between(q, other) for other in self._last.column(2, 0, POINTS)]
        return (t_ns, r, weighted(first, places, r), weighted(second, places, r), q,
                weighted(first, turns, (0.0, 0.0, 0.0)))


def _are_opposite(q, p):
    """Return whether two quaternions have opposite signs, so that one must be negated."""
    return q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3] < 0.0


def _piece(start, end):
    """Return the Piece between two knots, given as ``_derivatives`` returns them."""
    h = (end[0] - start[0]) * 1e-9
    path = [quintic(h, *axis) for axis in zip(*start[1:4], *end[1:4])]
    return Piece(start[0], end[0], path, start[4], turn_between(start[4], end[4]), start[5],
                 end[5])


def quintic(h, p0, v0, a0, p1, v1, a1):
    """
    Return c0...c5 of the quintic with given values and first two derivatives at both ends.

    Parameters
    ----------
    h : length of the interval, s
    p0, v0, a0 : position (m), velocity and acceleration at its start
    p1, v1, a1 : the same at its end
    """
    n = 1.0 / h
    half = 0.5 * a0
    dp = (p1 - p0 - h * (v0 + h * half)) * n * n * n
    dv = (v1 - v0 - h * a0) * n * n
    da = (a1 - a0) * n
    return (p0, v0, half, 10.0 * dp - 4.0 * dv + 0.5 * da, (-15.0 * dp + 7.0 * dv - da) * n,
            (6.0 * dp - 3.0 * dv + 0.5 * da) * n * n)
