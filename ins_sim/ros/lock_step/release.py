"""
Send the messages of truth_adapter immediately or, in lock-step, at the pace of its consumers.

In lock-step a sample is sent when the consumers have acknowledged enough of the earlier ones.
"""

from bisect import bisect_right
from collections import deque
import time

from ..recording.run_clock import JUMP_NS
from .pacing import LockStep


class Release:
    """
    Sends the samples computed from an input, and reports when an input sample is completed.

    In lock-step at most ``window`` samples are unacknowledged. An input sample is completed when
    all samples computed from it have been sent, so a simulator that waits for the completion
    also waits for the consumers.

    Parameters
    ----------
    pacing : LockStepPacing
    send : callable
        Called with the messages of a sample.
    done : callable
        Called with the motion time of a completed input sample, ns.
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
        """Discard the waiting samples."""
        self._waiting.clear()

    def add(self, stamp_ns, messages):
        """Append the messages of a sample."""
        self._waiting.append((stamp_ns, messages))

    def finish(self, t_ns):
        """Mark the input sample of t_ns as complete, and send the samples that may be sent."""
        self._waiting.append((t_ns, None))
        self.advance()

    def advance(self):
        """Send the samples that may be sent."""
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
            # The input has restarted. The consumers restart once they have acknowledged all.
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
            # All samples were acknowledged; measure the timeout from now on.
            lock.moved = time.monotonic()
        stamps.append(stamp_ns)
        self._sent += 1
        return True

    def ack(self, name, stamp_ns):
        """Process the acknowledgement of a stamp, ns."""
        stamps = self._stamps
        if not stamps or stamp_ns > stamps[-1] + JUMP_NS:
            # This acknowledges a sample from before a restart.
            return
        # Because of sensor latency the acknowledged stamp may lie between two samples or before
        # the first.
        k = self._sent - len(stamps) + max(0, bisect_right(stamps, stamp_ns) - 1)
        self._lock.ack(name, k, self._sent)

    def look(self, who):
        """
        Send the first sample again while it is not acknowledged.

        Return a sentence if consumers are overdue, else ''. ``who`` describes them.
        """
        lock = self._lock
        if lock.repeat_due(self._sent):
            self._send(self._first)
        late = lock.overdue(self._sent)
        return lock.complaint(late, who) if late else ''
