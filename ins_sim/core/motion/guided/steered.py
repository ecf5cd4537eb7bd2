"""
The lateral motion of a guided vehicle: offset, its rate and the sideslip under a linear command.

    beta' = (beta_c - beta)/tau,  v_z' = -Z beta,  z' = v_z

z (m) is the offset to the right of the track, v_z (m/s) its rate. The sideslip beta (rad) is
positive if the track is to the right of the nose, so that the side force acts to the side of the
nose. Over a control period the command beta_c changes linearly from its last value to the new one
(docs/theory/guided_motion.md).
"""

import numpy as np

from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.instants import seconds

# Number of control periods for which memory is allocated at the start.
ROOM = 1024
# Columns: z, v_z, beta, the command at the start of a period, its slope over the period (1/s).
COLUMNS = 5


def moved_on(force, lag_s, period, t):
    """
    Return z, v_z, beta and the command at t seconds after the start of a control period.

    Parameters
    ----------
    force : Z, m/s^2 per rad
    lag_s : tau, s
    period : z, v_z, beta and command at the start of the period, and the slope of the command
        (1/s); floats or arrays
    t : time since the start of the period, s

    """
    z, v_z, beta, command, slope = period
    # Solution: beta = command + slope (t - tau) + c exp(-t/tau); v_z and z are its integrals.
    c = beta - command + slope * lag_s
    decay = elementary.expm1(t * (-1.0 / lag_s))
    once = command * t + slope * (t * (0.5 * t - lag_s)) - c * (lag_s * decay)
    twice = (0.5 * command * (t * t) + slope * (t * t * (t * (1.0 / 6.0) - 0.5 * lag_s))
             + c * (lag_s * (t + lag_s * decay)))
    return (z + v_z * t - force * twice, v_z - force * once,
            command + slope * (t - lag_s) + c * (1.0 + decay), command + slope * t)


class SteeredHistory:
    """
    The control periods of a flight in sequence.

    Parameters
    ----------
    force, lag_s : see ``moved_on``
    period_ns : length of a control period, ns
    start : z (m) and v_z (m/s) at motion time zero; until ``begin`` the vehicle flies straight
        from there

    Attributes
    ----------
    known_ns : motion time up to which the motion is known, ns

    """

    def __init__(self, force, lag_s, period_ns, start):
        self._force, self._lag_s, self.period_ns = force, lag_s, period_ns
        self._start = start
        self.begin(0)

    def begin(self, t_ns):
        """Forget all commands; the first one will be given at t_ns."""
        z, v_z = self._start
        # Before the first command the motion continues with the last state, without steering.
        self._first_ns = self.known_ns = self._begin_ns = t_ns
        self._state = z + v_z * (t_ns * 1e-9), v_z, 0.0, 0.0
        self._before = (*self._state, 0.0)
        self._rows, self._count, self._last = np.empty((ROOM, COLUMNS)), 0, self._before

    @property
    def is_steered(self):
        """Return whether a command has been given."""
        return self._count > 0

    def command(self, t_ns, beta_c):
        """
        Add the control period that begins at t_ns; the command changes linearly to beta_c, rad.

        Raises ValueError unless t_ns is ``known_ns`` and the command is finite.
        """
        if t_ns != self.known_ns:
            raise ValueError(f'the command is for {seconds(t_ns)}; expected one for '
                             f'{seconds(self.known_ns)}, up to which the guided motion is known')
        if not abs(beta_c) < np.inf:
            raise ValueError(f'the command at {seconds(t_ns)} is {beta_c}; expected a number')
        length = self.period_ns * 1e-9
        row = (*self._state, (beta_c - self._state[3]) / length)
        if self._count == len(self._rows):
            self._rows = np.concatenate([self._rows, np.empty_like(self._rows)])
        self._rows[self._count] = self._last = row
        self._count += 1
        self.known_ns = t_ns + self.period_ns
        z, v_z, beta, _ = moved_on(self._force, self._lag_s, row, length)
        self._state = z, v_z, beta, beta_c

    def forget(self, t_ns):
        """Forget the periods that end before t_ns, which are not needed any more."""
        count = int(min((t_ns - self._first_ns) // self.period_ns, self._count - 1))
        if count > 0:
            self._rows, self._count = self._rows[count:].copy(), self._count - count
            self._first_ns += count * self.period_ns

    def at(self, t_ns):
        """
        Return z, v_z, beta, the command and its slope at motion times t_ns (n,), arrays.

        An instant at the boundary belongs to the period that ends there. Raises ValueError for
        instants that are not yet known or already forgotten.
        """
        t_ns = np.asarray(t_ns, dtype=np.int64)
        if not len(t_ns):
            return (np.zeros(0),) * COLUMNS
        self._check(int(t_ns.min()), int(t_ns.max()))
        index = -((self._first_ns - t_ns) // self.period_ns) - 1
        inside = index >= 0
        rows = np.where(inside[:, None], self._rows[np.maximum(index, 0)], self._before)
        since_ns = np.where(inside, self._first_ns + index * self.period_ns, self._begin_ns)
        period = tuple(rows.T)
        return *moved_on(self._force, self._lag_s, period, (t_ns - since_ns) * 1e-9), period[4]

    def one(self, t_ns):
        """Return the values of ``at`` at one instant as floats."""
        start_ns = self.known_ns - self.period_ns
        if start_ns < t_ns <= self.known_ns and self._count:
            row = self._last
        else:
            self._check(t_ns, t_ns)
            index = -((self._first_ns - t_ns) // self.period_ns) - 1
            start_ns = self._first_ns + index * self.period_ns if index >= 0 else self._begin_ns
            row = tuple(self._rows[index].tolist()) if index >= 0 else self._before
        return *moved_on(self._force, self._lag_s, row, (t_ns - start_ns) * 1e-9), row[4]

    def _check(self, first_ns, last_ns):
        if last_ns > self.known_ns:
            raise ValueError(f'the guided motion was requested for {seconds(last_ns)}; expected '
                             f'at most {seconds(self.known_ns)}, up to which it has been steered')
        if first_ns <= self._first_ns != self._begin_ns:
            raise ValueError(f'the guided motion was requested for {seconds(first_ns)}; expected '
                             f'later than {seconds(self._first_ns)}: earlier motion is not stored')
