"""
Continuous motion from streamed truth, with no look-ahead (spec/delays section 8).

Attitude: cubic Hermite on SO(3) from attitude and body rate.  Rate and specific force: the cubic
through the last four samples, which is of the same order.
"""

from collections import deque

from . import attitude
from .faults import StreamFault, check_finite, check_interval, check_unit, seconds

SAMPLES_OF_CUBIC = 4
TURN_LIMIT = 2.0


def hermite(h, q_start, q_end, w_start, w_end):
    """
    Return the vectors c1, c2, c3 of r(s) = c1 s + c2 s^2 + c3 s^3, q(s) = q_start exp(r(s)).

    h: interval, s; w: rate of b relative to the frame of q, resolved in b, rad/s.  The end rate
    passes through the inverse right Jacobian of the rotation vector to second order.
    """
    d = attitude.logarithm(attitude.multiply(attitude.conjugate(q_start), q_end))
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


def newton(samples):
    """Return the divided differences of up to four (t, vector) samples, newest first."""
    times = [t for t, _ in samples]
    column = [v for _, v in samples]
    table = [column[0]]
    for order in range(1, len(samples)):
        column = [tuple((y - x) / (times[k + order] - times[k]) for x, y in zip(p, q))
                  for k, (p, q) in enumerate(zip(column, column[1:]))]
        table.append(column[0])
    return times[:-1], table


def newton_value(times, table, t):
    """Return the vector of the polynomial of ``newton`` at t."""
    x, y, z = table[-1]
    for t_k, (a, b, c) in zip(reversed(times), reversed(table[:-1])):
        s = t - t_k
        x, y, z = x * s + a, y * s + b, z * s + c
    return x, y, z


class TruthBuffer:
    """
    Ring buffer of streamed truth that answers for any instant it covers.

    frame: MapFrame; reach_ns: how far behind the newest sample it must answer; frozen: the
    history before the first sample stands still (else it goes on at the first rate and force).
    """

    def __init__(self, frame, reach_ns, frozen):
        self._frame = frame
        self._reach_ns = reach_ns
        self._frozen = frozen
        self._pieces = deque()
        self._last = deque(maxlen=SAMPLES_OF_CUBIC)
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
        self._last.appendleft(sample)
        curve = hermite(h, start[1], q_mb, start[2], omega_mb_b)
        # the cubics are built when first asked for: most channels never ask
        self._pieces.append([start[0], t_ns, start[1], 1.0 / step_ns, curve, tuple(self._last),
                             {}])
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

    def force_m(self, t_ns):
        """Return the specific force in m, m/s^2."""
        return self._cubic(t_ns, 3)

    def rate(self, t_ns):
        """Return omega_ib_b, rad/s."""
        return self._cubic(t_ns, 4)

    def force_b(self, t_ns):
        """Return f_ib_b, m/s^2."""
        return self._cubic(t_ns, 5)

    def _cubic(self, t_ns, field):
        if t_ns <= self._first[0]:
            return self._first[field]
        piece = self._piece(t_ns)
        cubic = piece[6].get(field)
        if cubic is None:
            cubic = newton([((s[0] - piece[0]) * piece[3], s[field]) for s in piece[5]])
            piece[6][field] = cubic
        return newton_value(*cubic, (t_ns - piece[0]) * piece[3])
