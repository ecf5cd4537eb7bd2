"""Messages of a master of time that follows another one: sent at once, or as consumers answer."""

from bisect import bisect_right
from collections import deque
import time

from ..recording.run_clock import JUMP_NS
from .pacing import LockStep


class Release:
    """
    Sends what is made of an input, and says of each sample of the input when that is done.

    In lock-step at most ``window`` samples are unanswered, and a sample of the input is done only
    when all that was made of it has been sent: who waits for that waits for the consumers.

    Parameters
    ----------
    pacing : LockStepPacing
    send : callable
        Called with the messages of a sample.
    done : callable
        Called with the motion time of a sample of the input.
    """

    def __init__(self, pacing, send, done):
        self._send, self._done = send, done
        self._waiting = deque()
        self._lock = None
        if pacing.waits:
            self._lock = LockStep(pacing.required, pacing.window, pacing.timeout_s)
        self._stamps, self._sent = deque(maxlen=pacing.window + 2), 0
        self._first = None

    def __len__(self):
        return len(self._waiting)

    def clear(self):
        """Drop what waits."""
        self._waiting.clear()

    def add(self, stamp_ns, messages):
        """Take the messages of a sample."""
        self._waiting.append((stamp_ns, messages))

    def finish(self, t_ns):
        """Take note that all is there that is made of a sample of the input, and send what may."""
        self._waiting.append((t_ns, None))
        self.advance()

    def advance(self):
        """Send what may be sent."""
        waiting = self._waiting
        while waiting:
            stamp_ns, messages = waiting[0]
            if messages is None:
                self._done(stamp_ns)
            elif self._lock is None or self._may_send(stamp_ns, messages):
                self._send(messages)
            else:
                return
            waiting.popleft()

    def _may_send(self, stamp_ns, messages):
        lock, stamps = self._lock, self._stamps
        if self._sent and stamp_ns <= stamps[-1]:
            # The input has begun anew, and the consumers will, once they have answered all.
            if not lock.done(self._sent):
                return False
            self._sent = 0
            stamps.clear()
            lock.restart()
        if self._sent >= lock.allowed():
            return False
        if not self._sent:
            self._first = messages
        if self._sent - 1 <= lock.slowest:
            # Nothing was unanswered: from now on answers are due.
            lock.moved = time.monotonic()
        stamps.append(stamp_ns)
        self._sent += 1
        return True

    def ack(self, name, stamp_ns):
        """Take the acknowledgement of a stamp."""
        stamps = self._stamps
        if not stamps or stamp_ns > stamps[-1] + JUMP_NS:
            # An echo of what was before.
            return
        # An answer may stand between two samples, or before the first, by a known latency.
        k = self._sent - len(stamps) + max(0, bisect_right(stamps, stamp_ns) - 1)
        self._lock.ack(name, k, self._sent)

    def look(self, who):
        """
        Send the first sample again while it is unanswered.

        Return a sentence where consumers are overdue, who they are expected to be, else ''.
        """
        lock = self._lock
        if lock.repeat_due(self._sent):
            self._send(self._first)
        late = lock.overdue(self._sent)
        return lock.complaint(late, who) if late else ''
