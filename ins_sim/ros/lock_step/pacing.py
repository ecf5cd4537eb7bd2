"""
Pace of the generator, set by the wall clock and, in lock-step, by the consumers.

This module does not import ROS.
"""

import math
import time

from ins_sim.messages import topics
from ..process.said import short

REPEAT_S = 0.1
# Longer than a busy machine delays a consumer that is still running, s.
SILENCE_S = 2.0
STARTING = -1
# Other names heard on sim/ack: how many are kept for the error message, and their length.
STRANGERS, STRANGER = 10, 60


class Pace:
    """
    Real-time pace: sample k is due k dt / factor after the start.

    Due times are computed from the sample number, not accumulated, so the pace does not drift and
    no sample is skipped.

    Parameters
    ----------
    factor : simulated time per wall time; 0 for as fast as possible
    dt_s : sampling period, s
    """

    def __init__(self, factor, dt_s):
        self._dt_s, self._step_s = dt_s, dt_s / factor if factor else 0.0
        self._start = 0.0

    def set_factor(self, factor, k):
        """
        Change the factor from now on; k is the next sample.

        The remaining wait for sample k is scaled, so that simulated time does not jump. Samples
        that are already overdue become due from now on at the new pace.
        """
        now, left = time.monotonic(), 0.0
        if self._step_s:
            left = min(1.0, max(0.0, (self._start + k * self._step_s - now) / self._step_s))
        self._step_s = self._dt_s / factor if factor else 0.0
        self._start = now + (left - k) * self._step_s

    def anchor(self, k):
        """Restart the pace: sample k is due now."""
        self._start = time.monotonic() - k * self._step_s

    def allowed(self):
        """Return the number of samples that are due by now."""
        if not self._step_s:
            return math.inf
        return int((time.monotonic() - self._start) / self._step_s) + 1

    def wait_s(self, k):
        """Return the time until sample k is due, s."""
        return self._start + k * self._step_s - time.monotonic()


class LivePace(Pace):
    """
    Pace of a generator whose real_time_factor can be set while it runs.

    Parameters
    ----------
    pacing : settings ``pacing``
    source : TruthSource
    sent : function that returns the number of samples sent
    tell : function that logs that the stamps may no longer follow the wall clock
    """

    def __init__(self, pacing, source, sent, tell):
        super().__init__(pacing.real_time_factor, source.dt_ns * 1e-9)
        self._waits, self._source, self._sent, self._tell = pacing.waits, source, sent, tell

    def check_change(self, settings):
        """Refuse a factor of 0 in a run without lock-step."""
        if settings.pacing.waits and not self._waits:
            raise ValueError('pacing.real_time_factor is 0 without pacing.lock_step; expected '
                             'more than 0, because lock-step cannot be switched on during a run')

    def effective_ns(self, name):
        """Return the motion time of the next sample, ns, or None before the first one."""
        sent, source = self._sent(), self._source
        return source.first_ns + sent * source.dt_ns if sent else None

    def change(self, settings):
        """Apply the real_time_factor of new settings."""
        self.set_factor(settings.pacing.real_time_factor, self._sent())
        if not self._waits:
            # In lock-step this was logged at the start.
            self._tell()


class LockStep:
    """
    Lock-step: send at most ``window`` samples ahead of the slowest required consumer.

    Sample 0 is repeated until every consumer has acknowledged it, so that neither the order of
    start nor the time of discovery matters.

    Parameters
    ----------
    required : names of the consumers that must acknowledge
    window : maximum number of unacknowledged samples
    timeout_s : time after which a silent consumer is overdue, s
    """

    def __init__(self, required, window, timeout_s):
        self._required, self._window, self._timeout_s = tuple(required), window, timeout_s
        self.restart()

    def restart(self):
        """Forget all acknowledgements."""
        self._acked = dict.fromkeys(self._required, STARTING)
        self.strangers, self._more = set(), False
        self._repeated = self.moved = time.monotonic()

    def ack(self, name, k, sent):
        """Process the acknowledgement of sample k when ``sent`` samples have been sent."""
        last = self._acked.get(name)
        if last is None:
            self._hear(name)
        # Before sample 0 is acknowledged, a later acknowledgement can only be from an earlier run.
        if last is None or k >= sent or k <= last or (last == STARTING and k != 0):
            return
        self._acked[name] = k
        self.moved = time.monotonic()

    def _hear(self, name):
        if len(self.strangers) < STRANGERS:
            self.strangers.add(short(name, STRANGER))
        elif not self._more:
            self._more = short(name, STRANGER) not in self.strangers

    @property
    def slowest(self):
        """Return the last sample acknowledged by every consumer; STARTING before sample 0."""
        return min(self._acked.values())

    def allowed(self):
        """Return the number of samples that may be sent in total."""
        slowest = self.slowest
        return 1 if slowest == STARTING else slowest + 1 + self._window

    def repeat_due(self, sent, heard=True):
        """
        Return whether to send sample 0 again, at most every REPEAT_S.

        ``heard`` is False while another expected answer to sample 0 is missing.
        """
        now = time.monotonic()
        if sent != 1 or (self.slowest != STARTING and heard) or now - self._repeated < REPEAT_S:
            return False
        self._repeated = now
        return True

    def done(self, count):
        """
        Return whether all ``count`` samples are acknowledged.

        A rest within the window counts as acknowledged after SILENCE_S without progress: some
        consumers never acknowledge the last samples.
        """
        left = count - 1 - self.slowest
        return left <= 0 or (left <= self._window and self.slowest != STARTING
                             and time.monotonic() - self.moved > SILENCE_S)

    def overdue(self, sent):
        """Return the names of the consumers that have been silent for the timeout, or ()."""
        if sent - 1 <= self.slowest or time.monotonic() - self.moved < self._timeout_s:
            return ()
        return tuple(n for n, k in self._acked.items() if k == self.slowest)

    def complaint(self, late, expected):
        """Return a sentence about overdue consumers; ``expected`` says who should be running."""
        names = ', '.join(sorted(self.strangers)) + (' and others' if self._more else '')
        heard = f' (heard: {names})' if names else ''
        return (f'no acknowledgement on {topics.ACK.name} from {", ".join(late)} for '
                f'{self._timeout_s:g} s; expected {expected} to run{heard}')
