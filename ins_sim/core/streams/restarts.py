"""Two streams of the same time that both jump back, one before the other."""


class RestartDetector:
    """
    Which of two streams has begun a new run that the other has still to begin.

    What the other stream brings until then belongs to the run before.
    """

    def __init__(self):
        # How many times the first stream has jumped back more often than the second.
        self._lead = 0

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
        if self._lead < 0 or second_ns is not None and second_ns > t_ns:
            self._lead += 1

    def second_jumps(self, t_ns, first_ns):
        """Take note that the second is back at t_ns; first_ns: where the first is, or None."""
        if self._lead > 0 or first_ns is not None and first_ns > t_ns:
            self._lead -= 1
