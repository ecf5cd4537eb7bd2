"""
Continuous motion from streamed truth, without the use of later samples.

See docs/theory/streamed_truth.md.
"""

from collections import deque
import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.interpolation import (hermite_coefficients, newton_differences,
                                                 newton_value)
from ins_sim.core.numerics.instants import seconds
from .faults import (check_finite, check_interval, check_periods, check_unit,
                     half_turn_sentence, INTERVAL_TOLERANCE, MOST_PERIODS, StreamFault,
                     UNIT_HIGH, UNIT_LOW)
from .truth_pieces import pieces_of_samples, TruthBlock, TruthPieces

# Indices of the fields of a sample.
FORCE_M, RATE, FORCE_B = 3, 4, 5
TURN_LIMIT = 2.0
# Sums of a few components below this bound cannot overflow.
FINITE = 1e100
ZERO = (0.0, 0.0, 0.0)


def leading(true):
    """Return the number of leading true entries of an array of booleans."""
    return len(true) if np.all(true) else int(np.argmin(true))


def _square(vector):
    """Return the square of the length of a vector, floats or arrays."""
    return vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]


class TruthBuffer:
    """
    Ring buffer of streamed truth that gives the motion at any instant it covers.

    Parameters
    ----------
    frame : MapFrame
    reach_ns : how far behind the newest sample it must answer, ns
    before : function of the first sample that returns its BeforeTruth
    wanted : the fields that will be requested, of FORCE_M, RATE, FORCE_B
    dt_ns : period of rate_hz, ns; steps of the truth may be MOST_PERIODS times longer or shorter
    interval_ns : length of the attitude increments that will be requested, ns, which must turn
        less than half a turn; or None
    """

    def __init__(self, frame, reach_ns, before, wanted, dt_ns, interval_ns=None):
        self._frame = frame
        self._reach_ns = reach_ns
        self._wanted = wanted
        self._make_before, self._before = before, None
        self._interval_s = 0.0 if interval_ns is None else interval_ns * 1e-9
        self._pieces = deque()
        self._last = deque(maxlen=3)
        self._cubics = None
        self._step_ns = None
        self._longest_ns, self._shortest_ns = MOST_PERIODS * dt_ns, dt_ns // MOST_PERIODS

    @property
    def newest_ns(self):
        """Return the newest stamp, or None."""
        return self._last[0][0] if self._last else None

    @property
    def count_is_one(self):
        """Return whether only the first sample has arrived."""
        return len(self._last) == 1

    def push(self, t_ns, q_mb, omega_ib_b, f_ib_b):
        """
        Process a sample; raise StreamFault on NaN, repeated or backwards stamps, gaps and turns.

        The step between the first two samples is the step expected of all others; it must itself
        be within the limits for rate_hz.

        Parameters
        ----------
        t_ns : motion time, ns
        q_mb : attitude relative to the map frame
        omega_ib_b : angular rate in inertial space, rad/s
        f_ib_b : specific force, m/s^2
        """
        check_finite('truth', t_ns, q_mb, omega_ib_b, f_ib_b)
        check_unit('truth', t_ns, q_mb)
        sample = self._sample(t_ns, q_mb, omega_ib_b, f_ib_b)
        omega_mb_b = sample[2]
        if not self._last:
            self._before = self._make_before(sample)
            self._last.appendleft(sample)
            self._cubics = {k: [sample[k], ZERO, ZERO, ZERO] for k in self._wanted}
            return
        start = self._last[0]
        step_ns = t_ns - start[0]
        check_interval('truth', t_ns, start[0], self._step_ns or max(step_ns, 1))
        check_periods(t_ns, start[0], self._shortest_ns, self._longest_ns)
        h = step_ns * 1e-9
        if h * max(map(abs, omega_mb_b)) > TURN_LIMIT:
            raise StreamFault(
                f'truth at {seconds(t_ns)} turns {h * max(map(abs, omega_mb_b)):.3g} rad in one '
                f'step; expected less than {TURN_LIMIT:g}: raise rate_hz of motion_generator',
                restart=True)
        rate = math.sqrt(_square(omega_ib_b))
        if rate * self._interval_s >= math.pi:
            raise StreamFault(half_turn_sentence('truth', t_ns, rate, self._interval_s),
                              restart=True)
        if self._step_ns is None:
            self._before.take_second(sample)
        self._step_ns = step_ns
        back = [1e9 / (t_ns - other[0]) for other in self._last] + [0.0, 0.0]
        self._cubics = {k: newton_differences(cubic, sample[k], *back[:3])
                        for k, cubic in self._cubics.items()}
        self._last.appendleft(sample)
        times = tuple(other[0] for other in self._last)
        turned = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(start[1]), q_mb))
        curve = hermite_coefficients(h, turned, start[2], omega_mb_b)
        self._pieces.append((start[0], t_ns, start[1], 1.0 / step_ns, curve, self._cubics,
                             times + (t_ns,) * (3 - len(times))))
        while self._pieces[0][1] < t_ns - self._reach_ns:
            self._pieces.popleft()

    def _sample(self, t_ns, q_mb, omega_ib_b, f_ib_b):
        """Return the fields kept for a sample, or for many if components are arrays."""
        turn = quaternion.rotate_back(q_mb, self._frame.omega_ie_m)
        omega_mb_b = (omega_ib_b[0] - turn[0], omega_ib_b[1] - turn[1], omega_ib_b[2] - turn[2])
        return t_ns, q_mb, omega_mb_b, quaternion.rotate(q_mb, f_ib_b), omega_ib_b, f_ib_b

    def push_block(self, t_ns, q_mb, omega_ib_b, f_ib_b):
        """
        Process as many leading samples of a block as are certainly free of faults.

        The sample after them must go to ``push``, which may raise a StreamFault for it.

        Parameters
        ----------
        t_ns : (n,) int64 motion times, ns
        q_mb, omega_ib_b, f_ib_b : as in ``push``, tuples of arrays (n,)

        Returns
        -------
        count : number of samples processed; 0 if fewer than three samples came before
        block : their TruthBlock, or None
        """
        if len(self._last) < 3:
            return 0, None
        new = self._sample(*self._sound(t_ns, q_mb, omega_ib_b, f_ib_b))
        steps = np.diff(new[0], prepend=self._last[0][0])
        count = leading((steps * 1e-9 * abs(np.array(new[2])).max(axis=0) <= TURN_LIMIT)
                        & (np.sqrt(_square(new[4])) * self._interval_s < math.pi))
        if not count:
            return 0, None
        # The last three samples precede the new ones.
        known = tuple(self._last)[::-1]
        stamps = np.concatenate([[sample[0] for sample in known], t_ns[:count]])
        q, w = (tuple(np.concatenate([before, x[:count]])
                      for before, x in zip(zip(*(sample[k] for sample in known)), new[k]))
                for k in (1, 2))
        fields = {k: tuple(x[:count] for x in new[k]) for k in self._wanted}
        made = pieces_of_samples(stamps, q, w, fields, self._cubics)
        kept = TruthPieces.of_tuples(self._pieces)
        block = TruthBlock(made.behind(kept), len(self._pieces), self._before, self._reach_ns)
        self._keep(block.pieces, new, count)
        return count, block

    def _keep(self, pieces, new, count):
        """Store the same pieces and samples as single pushes would have stored."""
        newest_ns = int(pieces.end_ns[-1])
        first = int(np.searchsorted(pieces.end_ns, newest_ns - self._reach_ns))
        self._pieces = deque(pieces.tuples(first))
        self._cubics = self._pieces[-1][5]
        self._step_ns = newest_ns - self._pieces[-1][0]
        for k in range(max(0, count - 3), count):
            self._last.appendleft((int(new[0][k]), *(tuple(float(x[k]) for x in column)
                                                     for column in new[1:])))

    def _sound(self, t_ns, q_mb, omega_ib_b, f_ib_b):
        """Return the samples before the first unusable one; turns are checked elsewhere."""
        finite = leading(abs(np.array((*q_mb, *omega_ib_b, *f_ib_b))).max(axis=0) < FINITE)
        x, y, z, w = (part[:finite] for part in q_mb)
        n2 = x * x + y * y + z * z + w * w
        steps = np.diff(t_ns[:finite], prepend=self._last[0][0])
        expected = np.concatenate([[self._step_ns], steps[:-1]])
        count = leading((n2 > UNIT_LOW) & (n2 < UNIT_HIGH)
                        & (abs(steps - expected) <= INTERVAL_TOLERANCE * expected)
                        & (steps >= self._shortest_ns) & (steps <= self._longest_ns))
        return t_ns[:count], *(tuple(x[:count] for x in vector)
                               for vector in (q_mb, omega_ib_b, f_ib_b))

    def _piece(self, t_ns):
        for piece in reversed(self._pieces):
            if piece[0] <= t_ns:
                return piece
        return self._pieces[0]

    def attitude(self, t_ns):
        """Return q_mb at t_ns, not later than the newest sample."""
        if t_ns <= self._before.first[0]:
            return self._before.attitude(t_ns)
        start_ns, _, q, per_step, (c1, c2, c3), _, _ = self._piece(t_ns)
        s = (t_ns - start_ns) * per_step
        r = (s * (c1[0] + s * (c2[0] + s * c3[0])), s * (c1[1] + s * (c2[1] + s * c3[1])),
             s * (c1[2] + s * (c2[2] + s * c3[2])))
        return quaternion.multiply(q, quaternion.exponential(r))

    def cubic(self, t_ns, field):
        """Return a field at t_ns: FORCE_M or FORCE_B (m/s^2), or RATE (omega_ib_b, rad/s)."""
        if t_ns <= self._before.first[0]:
            return self._before.value(t_ns, field)
        piece = self._piece(t_ns)
        t0, t1, t2 = piece[6]
        return newton_value(piece[5][field], (t_ns - t0) * 1e-9, (t_ns - t1) * 1e-9,
                            (t_ns - t2) * 1e-9)
