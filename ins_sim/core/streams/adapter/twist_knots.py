"""
The scheme that believes the twist: velocity and rate are integrated, the pose holds them.

Velocity is a cubic Hermite curve with slopes from five velocities; position is its integral, held
to the measured positions by a loop of second order whose acceleration is linear between knots.
Attitude is integrated from the rates, held to the measured quaternions by a loop of first order.
"""

from ins_sim.core.attitude import quaternion
from .knots import LastKnots, turn_between
from .piece import Piece
from .stencils import MIDDLE, POINTS, stencil, weighted

# Bandwidth of both loops, rad/s.
HOLD = 0.5
# Fields of a knot.
T_NS, R, Q, V, W = range(5)
# Looked at: the knots from two before the start of a piece to two behind its end.
LOOKED = POINTS + 1
# Rates behind a knot by which it is turned.
RATES = 6


class TwistKnots:
    """
    Makes pieces of samples: that up to knot k is there with knot k + 2.

    in_parent: whether the twist is in the axes of the parent frame, not of the child.
    """

    def __init__(self, in_parent):
        self._in_parent = in_parent
        self._first = []
        self._last = LastKnots(LOOKED)
        # Rates of the correction of the attitude: at the last knot, and what its error asks for.
        self._turning = self._wanted = (0.0, 0.0, 0.0)
        self._rates = LastKnots(RATES)
        self._loops = None

    def push(self, sample):
        """Take a Sample that is a knot; return the Piece that it completes, or None."""
        w = sample.w
        if self._in_parent:
            w = quaternion.rotate_back(sample.q, w)
        self._rates.add((sample.t_ns, w))
        if self._first is not None:
            self._first.append(sample)
            if len(self._first) < RATES:
                return None
            q = self._first[0].q
            self._keep(self._first[0], q, self._rates[0][1])
            for k in range(1, RATES):
                self._turn(self._first[k], k - 1)
            self._first = None
            return None
        self._turn(sample, RATES - 2)
        return self._piece()

    def _keep(self, sample, q, w):
        v = sample.v if self._in_parent else quaternion.rotate(q, sample.v)
        self._last.add((sample.t_ns, sample.r, q, v, w))

    def _turn(self, sample, node):
        """Add a knot: turn the last one by the rates from one node of the stencil to the next."""
        q, before = self._last[-1][Q], self._turning
        steps = self._rates.steps(0, RATES)
        w = self._rates.column(1, 0, RATES)
        slopes = [weighted(stencil(steps, k)[0], w, w[k]) for k in (node, node + 1)]
        w0, w1 = w[node], w[node + 1]
        h = steps[node] * 1e-9
        # The correction is linear between knots; at the end it is what the last error asked for.
        self._turning = now = self._wanted
        mean = [0.5 * h * (a + b + c + d) + h * h / 12.0 * (e - f) for a, b, c, d, e, f in zip(
            w0, w1, before, now, *slopes)]
        start = tuple(a + b for a, b in zip(w0, before))
        end = tuple(a + b for a, b in zip(w1, now))
        phi = tuple(m + h * h / 12.0 * c for m, c in zip(mean, quaternion.cross(start, end)))
        q = quaternion.normalise(quaternion.multiply(q, quaternion.exponential(phi)))
        self._wanted = tuple(HOLD * x for x in turn_between(q, sample.q))
        self._keep(sample, q, end)

    def _piece(self):
        """Return the Piece between the two knots in the middle."""
        last = self._last
        start, end = last[MIDDLE], last[MIDDLE + 1]
        v = last.column(V, 0, LOOKED)
        a0, a1 = (weighted(stencil(last.steps(k, k + POINTS), MIDDLE)[0], v[k:k + POINTS],
                           v[k + MIDDLE]) for k in (0, 1))
        h = (end[T_NS] - start[T_NS]) * 1e-9
        if self._loops is None:
            self._loops = [(r, 0.0, 0.0) for r in start[R]]
        path, loops = [], []
        for axis in range(3):
            c, state = _held(h, self._loops[axis], start[R][axis], start[V][axis], end[V][axis],
                             a0[axis], a1[axis])
            path.append(c)
            loops.append(state)
        self._loops = loops
        return Piece(start[T_NS], end[T_NS], path, start[Q], turn_between(start[Q], end[Q]),
                     start[W], end[W])


def _held(h, state, measured, v0, v1, a0, a1):
    """
    Return c0...c5 of one axis of position, and the state of its loop at the end.

    state: position, velocity and acceleration of the correction at the start; measured: position
    there; the others are velocity and its slope at both ends.
    """
    p, u, alpha = state
    alpha_end = HOLD * (HOLD * (measured - p) - 2.0 * u)
    n = 1.0 / h
    mean = (v1 - v0) * n
    c = (p, v0 + u, 0.5 * (a0 + alpha),
         ((3.0 * mean - 2.0 * a0 - a1) * n / 3.0 + (alpha_end - alpha) * n / 6.0),
         0.25 * (a0 + a1 - 2.0 * mean) * n * n, 0.0)
    end = p + h * (c[1] + h * (c[2] + h * (c[3] + h * c[4])))
    return c, (end, u + 0.5 * h * (alpha + alpha_end), alpha_end)
