"""Two streams of the same time that both jump back, one before the other; and strays."""


class LastStamps:
    """
    The last two stamps of a stream, by which a stray sample is told from a jump.

    One stamp that is ahead of its time, or of the past, is a stray if the next one goes on where
    the stream was before it: nobody need follow it.
    """

    def __init__(self):
        self._before_ns = self._newest_ns = None

    def was_ahead(self, t_ns):
        """Return whether the newest one was a stray ahead: t_ns lies between the last two."""
        return self._before_ns is not None and self._before_ns < t_ns < self._newest_ns

    def was_of_the_past(self, t_ns):
        """Return whether the newest one was a stray of the past: t_ns is behind the other."""
        return self._before_ns is not None and self._newest_ns < self._before_ns < t_ns

    def take(self, t_ns):
        """Remember a stamp; return whether the newest one was a stray of the past."""
        newest_ns, before_ns = self._newest_ns, self._before_ns
        if before_ns is not None and before_ns < newest_ns < t_ns:
            # as almost always
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
    Which of two streams has begun a new run that the other has still to begin.

    What the other stream brings until then belongs to the run before.
    """

    def __init__(self):
        # How many times the first stream has jumped back more often than the second.
        self._lead = 0
        # Whether the last jump of each has counted.
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
        """Take note that the first is back at t_ns; second_ns: where the second is, or None."""
        # a second that has not passed t_ns need not come back to it
        self._counted[0] = self._lead < 0 or second_ns is not None and second_ns > t_ns
        self._lead += self._counted[0]

    def second_jumps(self, t_ns, first_ns):
        """Take note that the second is back at t_ns; first_ns: where the first is, or None."""
        self._counted[1] = self._lead > 0 or first_ns is not None and first_ns > t_ns
        self._lead -= self._counted[1]

    def first_returns(self):
        """Take note that the last jump of the first was a stray sample."""
        self._lead -= self._counted[0]
        self._counted[0] = False

    def second_returns(self):
        """Take note that the last jump of the second was a stray sample."""
        self._lead += self._counted[1]
        self._counted[1] = False
