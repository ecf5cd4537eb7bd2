"""A strapdown and its filter, advanced together over one sample or many."""

from bisect import bisect_left
import copy
import math

from .filters.base import AidingFilter


class FilteredStrapdown:
    """
    A CorrectedStrapdown, an AidingFilter and the start of the open window; a copy is a snapshot.

    For overlapping windows the filters have no sums over the window; each step is then treated as
    a window.

    Parameters
    ----------
    ins : CorrectedStrapdown
    filter_ : AidingFilter
    window_ns : length of the windows of the velocity meter, ns
    step_ns : distance between the ends of the windows, ns

    Attributes
    ----------
    ins, filter : as given
    takes_segments : whether several samples can be processed in one call, because the filter does
        not override ``step``
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
        """Return whether the solution is finite; a sum is finite only if all terms are."""
        lat, _, height, v_e, v_n, v_u, *_ = self.ins.carry[1]
        return math.isfinite(v_e + v_n + v_u + lat + height)

    def cut(self, samples, first, stop, event_ns):
        """
        Return the end of the samples, from first on, that can be processed in one call.

        Only the last of them may need work by the filter or the navigator.

        event_ns: latest instant at which work is due; stop: latest end.
        """
        if not self.takes_segments:
            return first + 1
        end_ns = self._window_end_ns
        if self.ins.carry[0] >= end_ns:
            # That window is over: the samples belong to the next one.
            end_ns += self._step_ns
        event_ns = min(event_ns, end_ns)
        left = self.filter.samples_left()
        if left is not None:
            stop = min(stop, first + left)
        return min(stop, bisect_left(samples.t_ns, event_ns, first, stop) + 1)

    def begin_window(self):
        """
        Begin a window if the next sample belongs to a new one.

        This is not done at the end of the window, so that the fix of that instant still finds its
        sums.
        """
        if self.ins.carry[0] >= self._window_end_ns:
            self.filter.begin_window(self.ins)
            self._open_window()

    def fly(self, samples, first, stop, out=None):
        """Advance over samples as ``cut`` returns them, except for the work at the last one."""
        ins, filter_ = self.ins, self.filter
        ins.carry, filter_.sums = samples.fly(ins.constants, ins.biases, ins.carry, filter_.sums,
                                              samples.columns, first, stop, out)

    def pause(self):
        """Call the filter's ``pause`` if it is due at the last sample."""
        if self.filter.samples_left() == 0:
            self.filter.pause(self.ins)

    def advance(self, samples, first, stop):
        """Advance over samples as ``cut`` returns them, including the filter's own work."""
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
