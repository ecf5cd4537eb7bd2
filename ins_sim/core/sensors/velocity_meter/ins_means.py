"""Mean velocities of the INS over the windows of the velocity meter."""

from functools import reduce
from operator import add

import numpy as np

from ins_sim.core.numerics.elementary import atan2
from ins_sim.core.streams.restarts import LastStamps, RestartDetector
from ins_sim.core.timeseries.fixes import VALID
from .blocks import in_order, pieces

NO_INS = 'no INS velocity in the window'
NO_ANGLE = 'INS velocity gives no angle of attack below 45 deg'
# Status, tan(alpha) and sideslip of a window for which no INS velocity is available.
UNSEEN = (NO_INS, 0.0, None)
# Longest wait of a window for the INS, in motion time; in lock-step the INS lags by less.
WAIT_NS = 60_000_000_000


class InsMeans:
    """
    Sums of INS velocities by part of a window; they belong to one run of the truth.

    If the stamps of the INS jump back, a new run begins, unless the stamp before was a stray one.

    Parameters
    ----------
    dt_ns : navigation cycle, ns
    span_ns : length of a window, ns
    part_ns : time from the end of a window to the end of the next, ns
    """

    def __init__(self, dt_ns, span_ns, part_ns):
        self._dt_ns, self._span_ns, self._part_ns = dt_ns, span_ns, part_ns
        self._kept_ns = max(WAIT_NS, span_ns) + span_ns - part_ns
        self.forget()

    def forget(self):
        """Forget all velocities of the INS."""
        # For the detector the truth is the first stream and the INS the second.
        self._runs, self.newest_ns, self._sums = RestartDetector(), None, {}
        self._truth_ns, self._truth_stamps, self._stamps = None, LastStamps(), LastStamps()

    @property
    def is_parted(self):
        """Return whether truth or INS has jumped back and the other has not followed."""
        return not self._runs.same_run

    @property
    def reached_ns(self):
        """Return the newest INS stamp in the present run of the truth, or None."""
        return None if self.is_parted else self.newest_ns

    def follow_truth(self, t_ns):
        """Register a stamp of the truth."""
        if self._truth_ns is not None and t_ns < self._truth_ns \
                and not self._truth_stamps.was_ahead(t_ns):
            self._runs.first_jumps(t_ns, self.newest_ns)
            if self._runs.first_is_ahead:
                self._sums = {}
        self._truth_ns = t_ns
        if self._truth_stamps.take(t_ns):
            self._runs.first_returns()

    def skip_truth(self, t_ns):
        """Register the last one of several rising stamps of the truth."""
        self._truth_ns = t_ns

    def rises(self, t_ns):
        """Return whether a stamp of the truth is later than the last one."""
        return self._truth_ns is None or t_ns > self._truth_ns

    def push(self, t_ns, v_b):
        """Process a velocity (FLU, m/s); a repeated stamp is ignored."""
        if self.newest_ns is not None and t_ns <= self.newest_ns:
            if t_ns == self.newest_ns:
                return
            self._jump_back(t_ns)
        self.newest_ns = t_ns
        if self._stamps.take(t_ns):
            self._runs.second_returns()
        if self._runs.first_is_ahead:
            return
        end_ns, sums = self._end_of(t_ns), self._sums
        last = sums.get(end_ns, (0.0, 0.0, 0.0))
        sums[end_ns] = tuple(a + b for a, b in zip(last, v_b))
        while next(iter(sums)) < end_ns - self._kept_ns:
            del sums[next(iter(sums))]

    def _jump_back(self, t_ns):
        if self._stamps.was_ahead(t_ns):
            # Discard the sums of the stray; at most its share in the mean of this window stays.
            end_ns = self._end_of(t_ns)
            self._sums = {end: total for end, total in self._sums.items() if end <= end_ns}
        else:
            self._runs.second_jumps(t_ns, self._truth_ns)
            self._sums = {}

    def _end_of(self, t_ns):
        """Return the end of the part that contains an instant."""
        return -(-(t_ns - self._dt_ns // 2) // self._part_ns) * self._part_ns

    def advance(self, t_ns, v_b, push):
        """
        Return the results of push(t_ns, v_b) for a block of velocities.

        Most velocities are added together; ``push`` is called only for the others.

        Parameters
        ----------
        t_ns : (n,) int64 motion times, ns
        v_b : (n, 3) velocities, FLU, m/s
        push : function (t_ns, v_b) that calls the method ``push`` and returns a list
        """
        found, half_ns = [], self._dt_ns // 2
        ends = self._end_of(t_ns)
        for a, b in pieces(np.diff(ends, append=0) != 0):
            # Velocities before the earliest end of the part are added together.
            end_ns = int(ends[a])
            inside = a + int(np.searchsorted(t_ns[a:b], end_ns - half_ns))
            rising = (np.diff(t_ns[a:inside]) > 0).all() and (
                self.newest_ns is None or t_ns[a] > self.newest_ns)
            if a + 2 < inside and rising and np.isfinite(
                    v_b[a:inside]).all() and not self._runs.first_is_ahead:
                self._sums[end_ns] = in_order(self._sums.get(end_ns, (0.0, 0.0, 0.0)),
                                              v_b[a:inside].T)
                self.newest_ns = int(t_ns[inside - 1])
                a = inside
            for t, v in zip(t_ns[a:b].tolist(), v_b[a:b].tolist()):
                found += push(t, v)
        return found

    def angle(self, end_ns, now_ns):
        """
        Return status, tan(alpha) and sideslip (rad) of a window, or None if not known yet.

        The status is VALID or says why there is no angle. See equation (8) of Ivanov 2015.

        Parameters
        ----------
        end_ns : end of the window, ns
        now_ns : motion time of the newest truth, ns
        """
        reached_ns = self.reached_ns
        if reached_ns is None or reached_ns < end_ns - self._dt_ns // 2:
            return UNSEEN if now_ns >= end_ns + WAIT_NS else None
        first_ns = end_ns - self._span_ns + self._part_ns
        parts = [self._sums[t_ns] for t_ns in range(first_ns, end_ns + 1, self._part_ns)
                 if t_ns in self._sums]
        if not parts:
            return UNSEEN
        forward, left, up = (reduce(add, values) for values in zip(*parts))
        if abs(up) >= forward:
            return NO_ANGLE, 0.0, None
        return VALID, -up / forward, atan2(-left, forward)
