"""
The scheme with twist: velocity and angular rate are integrated and tied to the poses.

Velocity is a cubic Hermite curve with slopes from five velocities. Position is its integral, tied
to the measured positions by a second-order loop whose acceleration is linear between knots.
Attitude is integrated from the rates and tied to the measured quaternions by a first-order loop.
"""

from ins_sim.core.attitude import quaternion
from .knots import LastKnots, turn_between
from .piece import Piece
from .stencils import MIDDLE, POINTS, stencil, weighted

# DAMPING: twice the damping ratio of the position loop, chosen for the smallest wander of the
# path. TURN_HOLD: bandwidth of the attitude loop, rad/s.
DAMPING, TURN_HOLD = 1.0, 1.5
# A piece needs the knots from two before its start to two after its end.
LOOKED = POINTS + 1
START, END = MIDDLE, MIDDLE + 1
ZERO = (0.0, 0.0, 0.0)


class TwistKnots:
    """
    Makes pieces from samples: the piece up to knot k is available with knot k + 2.

    Parameters
    ----------
    in_parent : whether the twist is in the axes of the parent frame, not of the child
    hold : bandwidth of the position loop, rad/s
    """

    def __init__(self, in_parent, hold):
        self._in_parent, self._hold = in_parent, hold
        self._last = LastKnots(LOOKED)
        # State at the start of the next piece: attitude, rate of its correction now and at the
        # end of the piece; acceleration, velocities there and before, and the position loops.
        self._q, self._turning, self._wanted = None, ZERO, ZERO
        self._a, self._velocities, self._loops = None, None, None

    def push(self, sample):
        """Process a Sample as the next knot; return the Piece that it completes, or None."""
        w = quaternion.rotate_back(sample.q, sample.w) if self._in_parent else sample.w
        self._last.add((sample.t_ns, w, sample))
        if len(self._last) < LOOKED:
            return None
        if self._q is None:
            self._begin()
            return None
        return self._piece()

    def _begin(self):
        """Integrate the first attitude from knot to knot to the start of the first piece."""
        rates = self._rates(range(END + 1), 0)
        q, velocities = self._last[0][2].q, []
        for k in range(END):
            q = self._turned(q, k, rates[k], rates[k + 1], ZERO, ZERO)
            velocities.append(self._velocity(k + 1, q))
        self._q = q
        self._velocities = velocities[1:]
        self._a = self._slope(velocities, q, ZERO)
        r = self._last[END][2].r
        self._loops = [(x, 0.0, 0.0) for x in r]

    def _rates(self, nodes, centred):
        """
        Return angular rate and its slope at the given knots.

        Slopes of nodes below ``centred`` use the five samples around them, others all samples.
        """
        last, w = self._last, self._last.column(1, 0, LOOKED)
        found = []
        for k in nodes:
            first, stop = (k - MIDDLE, k + MIDDLE + 1) if k < centred else (0, LOOKED)
            factors = stencil(last.steps(first, stop), k - first)[0]
            found.append((w[k], weighted(factors, w[first:stop], w[k])))
        return found

    def _turned(self, q, k, start, end, before, now):
        """Return attitude q after the step from knot k; start, end: rates and their slopes."""
        h = (self._last[k + 1][0] - self._last[k][0]) * 1e-9
        w0, w1 = _sum(start[0], before), _sum(end[0], now)
        c = quaternion.cross(w0, w1)
        phi = tuple(0.5 * h * (a + b) + h * h / 12.0 * (d - e + f)
                    for a, b, d, e, f in zip(w0, w1, start[1], end[1], c))
        return quaternion.normalise(quaternion.multiply(q, quaternion.exponential(phi)))

    def _velocity(self, k, q):
        v = self._last[k][2].v
        return v if self._in_parent else quaternion.rotate(q, v)

    def _slope(self, before, q, turning):
        """
        Return the acceleration at the end of a piece.

        The attitudes after the end are provisional; rates still to come will change them a little.

        Parameters
        ----------
        before : velocities at the two knots before the end and at the end, m/s
        q : attitude at the end
        turning : rate of the attitude correction after the end, rad/s
        """
        velocities = list(before)
        rates = self._rates(range(END, LOOKED), END + 1)
        for k in range(END, LOOKED - 1):
            q = self._turned(q, k, rates[k - END], rates[k + 1 - END], turning, turning)
            velocities.append(self._velocity(k + 1, q))
        return weighted(stencil(self._last.steps(1, LOOKED), MIDDLE)[0], velocities,
                        velocities[MIDDLE])

    def _piece(self):
        """Return the Piece between the two middle knots."""
        start_ns, w0, first = self._last[START]
        end_ns, w1, second = self._last[END]
        before, now, q = self._turning, self._wanted, self._q
        q_end = self._turned(q, START, *self._rates((START, END), END + 1), before, now)
        wanted = tuple(TURN_HOLD * x for x in turn_between(q_end, second.q))
        velocities = [*self._velocities, self._velocity(END, q_end)]
        a, loops, h = self._slope(velocities, q_end, wanted), [], (end_ns - start_ns) * 1e-9
        path = []
        for axis in range(3):
            c, loop = held(h, self._hold, self._loops[axis], first.r[axis], velocities[1][axis],
                           velocities[2][axis], self._a[axis], a[axis])
            path.append(c)
            loops.append(loop)
        self._q, self._turning, self._wanted = q_end, now, wanted
        self._a, self._velocities, self._loops = a, velocities[1:], loops
        return Piece(start_ns, end_ns, path, q, turn_between(q, q_end), _sum(w0, before),
                     _sum(w1, now))


def _sum(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def held(h, hold, loop, measured, v0, v1, a0, a1):
    """
    Return c0...c5 of one axis of position, and the state of its loop at the end.

    Parameters
    ----------
    h : length of the piece, s
    hold : bandwidth of the loop, rad/s
    loop : position, and velocity and acceleration of the correction, at the start
    measured : measured position at the start, m
    v0, v1, a0, a1 : velocity and acceleration at both ends
    """
    p, u, alpha = loop
    alpha_end = hold * (hold * (measured - p) - DAMPING * u)
    n = 1.0 / h
    mean = (v1 - v0) * n
    c = (p, v0 + u, 0.5 * (a0 + alpha),
         ((3.0 * mean - 2.0 * a0 - a1) * n / 3.0 + (alpha_end - alpha) * n / 6.0),
         0.25 * (a0 + a1 - 2.0 * mean) * n * n, 0.0)
    end = p + h * (c[1] + h * (c[2] + h * (c[3] + h * c[4])))
    return c, (end, u + 0.5 * h * (alpha + alpha_end), alpha_end)
