"""Restarts of two streams of the same run: jumps back in time, and stray samples."""


class LastStamps:
    """
    The last two stamps of a stream, which distinguish a stray sample from a jump.

    A single stamp from the future or the past is a stray if the next stamp continues where the
    stream was before. A stray must not make the other stream wait for a restart.
    """

    def __init__(self):
        self._before_ns = self._newest_ns = None

    def was_ahead(self, t_ns):
        """Return whether the newest stamp was a stray ahead: t_ns lies between the last two."""
        return self._before_ns is not None and self._before_ns < t_ns < self._newest_ns

    def was_of_the_past(self, t_ns):
        """Return whether the newest stamp was a stray of the past: t_ns follows the one before."""
        return self._before_ns is not None and self._newest_ns < self._before_ns < t_ns

    def take(self, t_ns):
        """Register a stamp; return whether the one before was a stray of the past."""
        newest_ns, before_ns = self._newest_ns, self._before_ns
        if before_ns is not None and before_ns < newest_ns < t_ns:
            # Fast path for rising stamps, the usual case.
            self._before_ns, self._newest_ns = newest_ns, t_ns
            return False
        if t_ns == newest_ns:
            return False
        returned = self.was_of_the_past(t_ns)
        if not (returned or self.was_ahead(t_ns)):
            self._before_ns = newest_ns
        self._newest_ns = t_ns
        return returned


class RestartDetector:
    """
    Tracks which of two streams has begun a new run that the other has not begun yet.

    Samples of the other stream belong to the earlier run until it jumps back too.
    """

    def __init__(self):
        # Number of jumps of the first stream minus those of the second.
        self._lead = 0
        # Whether the last jump of each stream was counted.
        self._counted = [False, False]

    @property
    def first_is_ahead(self):
        """Return whether the first stream is in a new run and the second is not."""
        return self._lead > 0

    @property
    def same_run(self):
        """Return whether both streams are in the same run."""
        return self._lead == 0

    def first_jumps(self, t_ns, second_ns):
        """Register a jump of the first stream to t_ns; second_ns: last stamp of the second."""
        # A second stream that has not passed t_ns does not have to jump back.
        self._counted[0] = self._lead < 0 or second_ns is not None and second_ns > t_ns
        self._lead += self._counted[0]

    def second_jumps(self, t_ns, first_ns):
        """Register a jump of the second stream to t_ns; first_ns: last stamp of the first."""
        self._counted[1] = self._lead > 0 or first_ns is not None and first_ns > t_ns
        self._lead -= self._counted[1]

    def first_returns(self):
        """Undo the last jump of the first stream, which was a stray sample."""
        self._lead -= self._counted[0]
        self._counted[0] = False

    def second_returns(self):
        """Undo the last jump of the second stream, which was a stray sample."""
        self._lead += self._counted[1]
        self._counted[1] = False
