"""Wait for messages of another topic for a limited time."""

import time

from .qos import hand_over_of
from .wall_timer import wall_timer

RETRY_S = 0.005
PATIENCE_S = 0.001
NAP_S = 5e-5
MISSING_S = 5.0


class Patience:
    """
    Waits while waiting() is true: first for a moment in the caller, then in a timer of the node.

    No result depends on a clock: unless missed() is called, the outcome is the same however long
    a message takes.

    Parameters
    ----------
    node : Node with ``guarded``, ``on_drained`` and ``stop``
    waiting : callable that returns whether a message is still missing
    progress : callable that returns a value which changes whenever an awaited message arrives
    take : callable that processes the messages that have arrived
    missed : callable, called after MISSING_S of wall time without progress; must end the waiting
    settle : callable, called after each attempt, whether it ended the waiting or not
    """

    def __init__(self, node, waiting, progress, take, missed, settle):
        self._node, self._waiting, self._progress = node, waiting, progress
        self._take, self._missed, self._settle = take, missed, settle
        self._since = self._mark = None
        self._patience_s = PATIENCE_S
        hand_over = hand_over_of(node)
        if hand_over is not None:
            # The messages come from this process, so none can arrive while it waits here.
            self._patience_s = 0.0
            hand_over.add_patience(node, self)
        self._retry = wall_timer(node, RETRY_S, node.guarded(self._on_retry))
        self._retry.cancel()

    @property
    def waits(self):
        """Return whether the timer is still waiting for a message."""
        return self._since is not None

    def wait(self):
        """Wait for a moment; if that is not enough, continue in the timer."""
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
        """Process the messages that have arrived, and check whether more are missing."""
        self._take()
        self._wait(0.0)
