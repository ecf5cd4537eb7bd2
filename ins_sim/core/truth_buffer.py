"""
Continuous motion from streamed truth, with no look-ahead (spec/delays section 8).

Attitude: cubic Hermite on SO(3) from attitude and body rate.  Rate and specific force: the cubic
through the last four samples, which is of the same order.
"""

from collections import deque

from . import attitude
from .faults import StreamFault, check_finite, check_interval, check_unit, seconds

# fields of a sample
FORCE_M, RATE, FORCE_B = 3, 4, 5
TURN_LIMIT = 2.0
ZERO = (0.0, 0.0, 0.0)


def hermite(h, d, w_start, w_end):
    """
    Return the vectors c1, c2, c3 of r(s) = c1 s + c2 s^2 + c3 s^3, q(s) = q_start exp(r(s)).

    h: interval, s; d: rotation vector from q_start to q_end, rad; w: rate of b relative to the
    frame of q, resolved in b, rad/s.  The end rate passes through the inverse right Jacobian of
    the rotation vector to second order.  Components may be floats or arrays.
    """
    dw = attitude.cross(d, w_end)
    ddw = attitude.cross(d, dw)
    a = (h * w_start[0], h * w_start[1], h * w_start[2])
    b = (h * (w_end[0] + dw[0] / 2.0 + ddw[0] / 12.0),
         h * (w_end[1] + dw[1] / 2.0 + ddw[1] / 12.0),
         h * (w_end[2] + dw[2] / 2.0 + ddw[2] / 12.0))
    c2 = (3.0 * d[0] - 2.0 * a[0] - b[0], 3.0 * d[1] - 2.0 * a[1] - b[1],
          3.0 * d[2] - 2.0 * a[2] - b[2])
    c3 = (a[0] + b[0] - 2.0 * d[0], a[1] + b[1] - 2.0 * d[1], a[2] + b[2] - 2.0 * d[2])
    return a, c2, c3


def newton(last, value, r1, r2, r3):
    """
    Return the divided differences d0..d3 at a new sample, newest first.

    last: those at the sample before; value: the new vector; r1, r2, r3: reciprocals of the times
    back to the last three samples, 1/s, zero where there is none (the order then is lower).
    """
    x, y, z = value
    d = [value]
    for (a, b, c), r in zip(last, (r1, r2, r3)):
        x, y, z = (x - a) * r, (y - b) * r, (z - c) * r
        d.append((x, y, z))
    return d


def newton_value(differences, s0, s1, s2):
    """Return the cubic of ``newton``; s0, s1, s2: time since the last three samples, s."""
    (a0, b0, c0), (a1, b1, c1), (a2, b2, c2), (a3, b3, c3) = differences
    return (a0 + s0 * (a1 + s1 * (a2 + s2 * a3)), b0 + s0 * (b1 + s1 * (b2 + s2 * b3)),
            c0 + s0 * (c1 + s1 * (c2 + s2 * c3)))


class TruthBuffer:
    """
    Ring buffer of streamed truth that answers for any instant it covers.

    frame: MapFrame; reach_ns: how far behind the newest sample it must answer; frozen: the
    history before the first sample stands still (else it goes on at the first rate and force);
    wanted: which of FORCE_M, RATE, FORCE_B it will be asked for.
    """

    def __init__(self, frame, reach_ns, frozen, wanted):
        self._frame = frame
        self._reach_ns = reach_ns
        self._wanted = wanted
        self._frozen = frozen
        self._pieces = deque()
        self._last = deque(maxlen=3)
        self._cubics = None
        self._first = None
        self._step_ns = None

    @property
    def newest_ns(self):
        """Return the newest stamp, or None."""
        return self._last[0][0] if self._last else None

    @property
    def count_is_one(self):
        """Return whether only the first sample has come."""
        return len(self._last) == 1

    def push(self, t_ns, q_mb, omega_ib_b, f_ib_b):
        """
        Take a sample; raise StreamFault on NaN, repeated or backwards stamps, gaps and turns.

        The step between the first two samples is the step expected of all.
        """
        check_finite('truth', t_ns, q_mb, omega_ib_b, f_ib_b)
        check_unit('truth', t_ns, q_mb)
        turn = attitude.rotate_back(q_mb, self._frame.omega_ie_m)
        omega_mb_b = (omega_ib_b[0] - turn[0], omega_ib_b[1] - turn[1], omega_ib_b[2] - turn[2])
        f_m = attitude.rotate(q_mb, f_ib_b)
        sample = (t_ns, q_mb, omega_mb_b, f_m, omega_ib_b, f_ib_b)
        if not self._last:
            self._first = sample
            self._last.appendleft(sample)
            self._cubics = {k: [sample[k], ZERO, ZERO, ZERO] for k in self._wanted}
            return
        start = self._last[0]
        step_ns = t_ns - start[0]
        check_interval('truth', t_ns, start[0], self._step_ns or max(step_ns, 1), 0.2)
        h = step_ns * 1e-9
        if h * max(map(abs, omega_mb_b)) > TURN_LIMIT:
            raise StreamFault(
                f'truth at {seconds(t_ns)} turns {h * max(map(abs, omega_mb_b)):.3g} rad in one '
                f'step; expected less than {TURN_LIMIT:g}: raise rate_hz of motion_generator',
                restart=True)
        self._step_ns = step_ns
        back = [1e9 / (t_ns - other[0]) for other in self._last] + [0.0, 0.0]
        self._cubics = {k: newton(cubic, sample[k], *back[:3])
                        for k, cubic in self._cubics.items()}
        self._last.appendleft(sample)
        times = tuple(other[0] for other in self._last)
        turned = attitude.logarithm(attitude.multiply(attitude.conjugate(start[1]), q_mb))
        curve = hermite(h, turned, start[2], omega_mb_b)
        self._pieces.append((start[0], t_ns, start[1], 1.0 / step_ns, curve, self._cubics,
                             times + (t_ns,) * (3 - len(times))))
        while self._pieces[0][1] < t_ns - self._reach_ns:
            self._pieces.popleft()

    def _piece(self, t_ns):
        for piece in reversed(self._pieces):
            if piece[0] <= t_ns:
                return piece
        return self._pieces[0]

    def attitude(self, t_ns):
        """Return q_mb at t_ns, not later than the newest sample."""
        first = self._first
        if t_ns <= first[0]:
            if self._frozen or t_ns == first[0]:
                return first[1]
            s = (t_ns - first[0]) * 1e-9
            w = first[2]
            return attitude.multiply(first[1],
                                     attitude.exponential((w[0] * s, w[1] * s, w[2] * s)))
        start_ns, _, q, per_step, (c1, c2, c3), _, _ = self._piece(t_ns)
        s = (t_ns - start_ns) * per_step
        r = (s * (c1[0] + s * (c2[0] + s * c3[0])), s * (c1[1] + s * (c2[1] + s * c3[1])),
             s * (c1[2] + s * (c2[2] + s * c3[2])))
        return attitude.multiply(q, attitude.exponential(r))

    def cubic(self, t_ns, field):
        """Return FORCE_M (m/s^2 in m), RATE (omega_ib_b, rad/s) or FORCE_B (f_ib_b, m/s^2)."""
        if t_ns <= self._first[0]:
            return self._first[field]
        piece = self._piece(t_ns)
        t0, t1, t2 = piece[6]
        return newton_value(piece[5][field], (t_ns - t0) * 1e-9, (t_ns - t1) * 1e-9,
                            (t_ns - t2) * 1e-9)
