"""How far the generator may go: the clock, and in lock-step the consumers.  No ROS is imported."""

import math
import time

from ins_sim.messages import topics
from ..process.said import short

REPEAT_S = 0.1
# longer than a busy machine keeps a consumer from its core
SILENCE_S = 2.0
STARTING = -1
# names on sim/ack that nobody waits for: so many are kept, of so many characters
STRANGERS, STRANGER = 10, 60


class Pace:
    """
    Real time: sample k is due k dt / factor after the start.

    The clock counts samples, never ticks, so that nothing drifts and nothing is skipped.
    """

    def __init__(self, factor, dt_s):
        self._dt_s, self._step_s = dt_s, dt_s / factor if factor else 0.0
        self._start = 0.0

    def set_factor(self, factor, k):
        """
        Go at another factor from now on, the next sample being k.

        What is left of the wait for it is stretched, so that time goes on without a jump; what
        was due and has not been sent is due from now on at the new pace.
        """
        now, left = time.monotonic(), 0.0
        if self._step_s:
            left = min(1.0, max(0.0, (self._start + k * self._step_s - now) / self._step_s))
        self._step_s = self._dt_s / factor if factor else 0.0
        self._start = now + (left - k) * self._step_s

    def anchor(self, k):
        """Let sample k be due now."""
        self._start = time.monotonic() - k * self._step_s

    def allowed(self):
        """Return how many samples may have been sent by now."""
        if not self._step_s:
            return math.inf
        return int((time.monotonic() - self._start) / self._step_s) + 1

    def wait_s(self, k):
        """Return how long it is until sample k is due."""
        return self._start + k * self._step_s - time.monotonic()


class LivePace(Pace):
    """
    The pace of a generator, whose real_time_factor may be set while it runs.

    pacing: settings; source: TruthSource; sent: function that returns how many samples were sent;
    tell: called when stamps may follow the wall clock no longer.
    """

    def __init__(self, pacing, source, sent, tell):
        super().__init__(pacing.real_time_factor, source.dt_ns * 1e-9)
        self._waits, self._source, self._sent, self._tell = pacing.waits, source, sent, tell

    def check_change(self, settings):
        """Refuse a factor of 0 where the run has no lock-step."""
        if settings.pacing.waits and not self._waits:
            raise ValueError('pacing.real_time_factor is 0 without pacing.lock_step; expected '
                             'more than 0: lock-step begins with the run or not at all')

    def effective_ns(self, name):
        """Return the motion time of the next sample, None before the first."""
        sent, source = self._sent(), self._source
        return source.first_ns + sent * source.dt_ns if sent else None

    def change(self, settings):
        """Go at the real_time_factor of other settings."""
        self.set_factor(settings.pacing.real_time_factor, self._sent())
        if not self._waits:
            # with lock-step that was said at the start
            self._tell()


class LockStep:
    """
    Lock-step: at most ``window`` samples ahead of the slowest required consumer.

    Sample 0 is repeated until every consumer has acknowledged it, so that neither the order of
    start nor the time of discovery matters.
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
        """Take the acknowledgement of sample k; sent: number of samples sent."""
        last = self._acked.get(name)
        if last is None:
            self._hear(name)
        # before the first sample is acknowledged a later one can only be an echo of a past run
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
        """Return the last sample that every consumer has acknowledged; STARTING before 0."""
        return min(self._acked.values())

    def allowed(self):
        """Return how many samples may have been sent."""
        slowest = self.slowest
        return 1 if slowest == STARTING else slowest + 1 + self._window

    def repeat_due(self, sent, heard=True):
        """
        Return whether sample 0 is to be sent again, at most every REPEAT_S.

        heard: whether what else has to answer it has done so.
        """
        now = time.monotonic()
        if sent != 1 or (self.slowest != STARTING and heard) or now - self._repeated < REPEAT_S:
            return False
        self._repeated = now
        return True

    def done(self, count):
        """Return whether all count samples are processed, as far as consumers will ever say."""
        left = count - 1 - self.slowest
        return left <= 0 or (left <= self._window and self.slowest != STARTING
                             and time.monotonic() - self.moved > SILENCE_S)

    def overdue(self, sent):
        """Return the names of the consumers that have let the timeout pass, or ()."""
        if sent - 1 <= self.slowest or time.monotonic() - self.moved < self._timeout_s:
            return ()
        return tuple(n for n, k in self._acked.items() if k == self.slowest)

    def complaint(self, late, expected):
        """Return the sentence about consumers that are late; expected: who was to run."""
        names = ', '.join(sorted(self.strangers)) + (' and others' if self._more else '')
        heard = f' (heard: {names})' if names else ''
        return (f'no acknowledgement on {topics.ACK.name} from {", ".join(late)} for '
                f'{self._timeout_s:g} s; expected {expected} to run{heard}')
