"""A strapdown and its filter, advanced together over one sample or many."""

from bisect import bisect_left
import copy
import math

from .filters.base import AidingFilter


class FilteredStrapdown:
    """
    A CorrectedStrapdown, an AidingFilter and the start of the open window; a copy is a snapshot.

    window_ns, step_ns: length of the windows of the velocity meter, and from end to end; of those
    that overlap no filter has sums, and each step counts as one.  takes_segments: whether the
    filter can take many samples at once, because it does not follow every one itself.
    """

    def __init__(self, ins, filter_, window_ns, step_ns):
        self.ins, self.filter, self._step_ns = ins, filter_, step_ns
        self._start_ns = ins.t_ns if step_ns < window_ns else None
        self._open_window()
        self.takes_segments = type(filter_).step is AidingFilter.step

    def _open_window(self):
        self._window_start_ns = t_ns = self.ins.t_ns
        self._window_end_ns = (t_ns // self._step_ns + 1) * self._step_ns

    def copy(self):
        """Return a snapshot."""
        snapshot = copy.copy(self)
        snapshot.ins, snapshot.filter = self.ins.copy(), self.filter.copy()
        return snapshot

    @property
    def covers_from_ns(self):
        """Return the earliest start of a window that may end now."""
        return self._window_start_ns if self._start_ns is None else self._start_ns

    @property
    def is_finite(self):
        """Return whether the solution is a number: a sum is finite only if all of it is."""
        lat, _, height, v_e, v_n, v_u, *_ = self.ins.carry[1]
        return math.isfinite(v_e + v_n + v_u + lat + height)

    def cut(self, samples, first, stop, event_ns):
        """
        Return the end of the Samples from first on that need no work until the last one.

        event_ns: when there is work at the latest; stop: the end at the latest.
        """
        if not self.takes_segments:
            return first + 1
        end_ns = self._window_end_ns
        if self.ins.carry[0] >= end_ns:
            # It is over: the samples are of the next one.
            end_ns += self._step_ns
        event_ns = min(event_ns, end_ns)
        left = self.filter.samples_left()
        if left is not None:
            stop = min(stop, first + left)
        return min(stop, bisect_left(samples.t_ns, event_ns, first, stop) + 1)

    def begin_window(self):
        """
        Begin the window of the next sample, if it is another one.

        Not at the end of the window, so that the fix of that instant still finds its sums.
        """
        if self.ins.carry[0] >= self._window_end_ns:
            self.filter.begin_window(self.ins)
            self._open_window()

    def fly(self, samples, first, stop, out=None):
        """Advance over samples as ``cut`` returns them, up to the work at the last one."""
        ins, filter_ = self.ins, self.filter
        ins.carry, filter_.sums = samples.fly(ins.constants, ins.biases, ins.carry, filter_.sums,
                                              samples.columns, first, stop, out)

    def pause(self):
        """Let the filter do its work at the last sample."""
        if self.filter.samples_left() == 0:
            self.filter.pause(self.ins)

    def advance(self, samples, first, stop):
        """Advance over samples as ``cut`` returns them."""
        self.begin_window()
        if self.takes_segments:
            self.fly(samples, first, stop)
            self.pause()
            return
        t_ns, omega, f, height, up = samples.sample(first)
        ins = self.ins
        before, last_ns = (ins.q_nb, ins.v_b, ins.v), ins.t_ns
        delta_v = ins.take(t_ns, omega, f, height, up)
        self.filter.step(ins, before, delta_v, (t_ns - last_ns) * 1e-9)
