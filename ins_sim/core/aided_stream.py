"""
The aided navigator on live streams: IMU, truth and fixes, whatever the order they come in.

A sample waits until every fix that is due by it is known, so that a live run gives the numbers of
the offline run.  What is due the settings say: both instruments report every window, and every
instant, valid or not.
"""

from .aided_navigator import AidedNavigator, GNSS, METER
from .errors import level_errors
from .instants import period_ns
from .matching import MatchedStreams


class FixSchedule:
    """Which fixes are due; settings: AidedNavigatorSettings."""

    def __init__(self, settings, sources):
        window_ns = settings.window.cycles * period_ns(settings.rate_hz)
        periods = {METER: (window_ns, window_ns, settings.window.latency_ms),
                   GNSS: (period_ns(settings.gnss.rate_hz), 0, settings.gnss.latency_ms)}
        self._periods = {source: periods[source] for source in sources}
        self._next = {}
        self.silent = set()

    def missing(self, t_ns):
        """Return the sources whose fix is due by the sample t_ns and has not come."""
        late = []
        for source, (period_ns_, lead_ns, latency_ms) in self._periods.items():
            # a window is reported that was seen from its start
            next_ns = self._next.setdefault(source, -(-t_ns // period_ns_) * period_ns_ + lead_ns)
            if source not in self.silent and next_ns + round(1e6 * latency_ms) <= t_ns:
                late.append(source)
        return late

    def came(self, source, fix):
        """Take note of a fix, valid or not."""
        self.silent.discard(source)
        if source in self._periods:
            self._next[source] = max(fix.t_ns + self._periods[source][0],
                                     self._next.get(source, fix.t_ns))


class AidedStream(MatchedStreams):
    """
    An AidedNavigator on live streams; outputs are (t_ns, solution, errors, sigmas).

    errors as of errors.level_errors; sigmas as of the filter, or None.  ``taken`` collects what
    became of the fixes; the owner empties it.
    """

    def begin(self):
        """Forget the solution, and the fixes that wait."""
        self.navigator = AidedNavigator(self._settings)
        self._schedule = FixSchedule(self._settings, self.navigator.sources)
        self.taken = []

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self.navigator.navigates

    @property
    def awaited(self):
        """Return the sources that the oldest sample waits for."""
        return self._schedule.missing(self._imu[0][0]) if self._imu else []

    def go_on_without(self, source):
        """Wait no longer for a source until it delivers again; return the outputs."""
        self._schedule.silent.add(source)
        return self.match()

    def push_fix(self, source, fix):
        """Take a fix of METER or GNSS; return the outputs."""
        self._schedule.came(source, fix)
        self.navigator.take(source, fix)
        return self.match()

    def held(self, t_ns):
        """Return whether a fix is due that has not come."""
        return bool(self._schedule.missing(t_ns))

    def advance(self, t_ns, omega, f, truth):
        """Take matched samples; return the outputs."""
        taken = self.navigator.step(t_ns, omega, f, truth)
        if taken is None:
            return []
        self.taken.extend(taken)
        solution = self.navigator.solution
        return [(t_ns, solution, level_errors(solution, truth), self.navigator.filter.sigmas())]
