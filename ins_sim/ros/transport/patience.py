"""Waiting for what another topic must bring, for as long as it may reasonably take."""

import time

from .qos import hand_over_of
from .wall_timer import wall_timer

RETRY_S = 0.005
PATIENCE_S = 0.001
NAP_S = 5e-5
MISSING_S = 5.0


class Patience:
    """
    Waits while waiting() is true: here for a moment, then from a timer of the node.

    take() takes what has come; settle() follows each time, be it that nothing is waited for or
    that the timer goes on; missed() is called when progress() has given the same value for
    MISSING_S of wall time, and must end that waiting.  No number depends on a clock: without
    missed() the outcome is the same however long it takes.
    """

    def __init__(self, node, waiting, progress, take, missed, settle):
        self._node, self._waiting, self._progress = node, waiting, progress
        self._take, self._missed, self._settle = take, missed, settle
        self._since = self._mark = None
        self._patience_s = PATIENCE_S
        hand_over = hand_over_of(node)
        if hand_over is not None:
            # nothing comes while this process waits
            self._patience_s = 0.0
            hand_over.add_patience(node, self)
        self._retry = wall_timer(node, RETRY_S, node.guarded(self._on_retry))
        self._retry.cancel()

    @property
    def waits(self):
        """Return whether something has not come in that moment."""
        return self._since is not None

    def wait(self):
        """Wait for a moment, and if that is not enough let the timer go on."""
        self._wait(self._patience_s)

    def _wait(self, patience_s):
        start = time.monotonic()
        while self._waiting() and not self._node.stop:
            now, mark = time.monotonic(), self._progress()
            if mark != self._mark:
                self._mark, self._since = mark, None
            if self._since is not None and now - self._since > MISSING_S:
                self._missed()
                self._since, start = None, now
            elif self._since is not None or now - start >= patience_s:
                self._since = self._since or now
                self._retry.reset()
                self._settle()
                return
            else:
                time.sleep(NAP_S)
                self._take()
        self._since = None
        self._settle()

    def _on_retry(self):
        self._retry.cancel()
        self.go_on()
        self._node.on_drained()

    def go_on(self):
        """Take what has come."""
        self._take()
        self._wait(0.0)
