"""
The aided navigator on live streams: IMU, truth and fixes, in whatever order they arrive.

A sample waits until every fix that is due by then has arrived, so that a live run gives the same
numbers as the offline run. The settings tell which fixes are due: both instruments report every
window or instant, valid or not.
"""

from bisect import insort
from collections import defaultdict
import math

from ins_sim.core.navigation.errors import level_errors
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.streams.matching import MatchedStreams, TRUTH_LENGTH
from ins_sim.core.streams.restarts import LastStamps, RestartDetector
from .fix_checks import check_ahead, check_gnss, check_velocity
from .navigator import AidedNavigator, GNSS, METER

# Longer than the IMU can lag behind the instruments in lock-step or on a busy machine.
AHEAD_NS = 60_000_000_000


class FixSchedule:
    """Knows which fixes are due; settings: AidedNavigatorSettings; sources: those waited for."""

    def __init__(self, settings, sources):
        window, dt_ns = settings.window, period_ns(settings.rate_hz)
        gnss_ns = period_ns(settings.gnss.rate_hz)
        # For each source: period; time from the first sample to the first fix at most; latency.
        periods = {METER: (window.step_cycles * dt_ns, window.cycles * dt_ns,
                           round(1e6 * window.latency_ms)),
                   GNSS: (gnss_ns, 0, round(1e6 * settings.gnss.latency_ms))}
        self._periods = {source: periods[source] for source in sources}
        # Compares the run of the samples (the first stream) with that of each source (the second).
        self.forget()
        self.begin()

    def forget(self):
        """Forget all fixes that have arrived."""
        self._newest, self._runs = {}, defaultdict(RestartDetector)
        self._stamps = defaultdict(LastStamps)
        self.silent = set()

    def begin(self):
        """Count from the next sample on; the fixes that have arrived remain known."""
        self._first = {}

    def missing(self, t_ns):
        """Return the sources whose fix is due by the sample t_ns and has not arrived."""
        late = []
        for source, (step_ns, lead_ns, latency_ns) in self._periods.items():
            # Only a window that was seen from its start is reported.
            first_ns = self._first.setdefault(source, -(-t_ns // step_ns) * step_ns + lead_ns)
            due_ns = (t_ns - latency_ns) // step_ns * step_ns
            if due_ns >= first_ns and source not in self.silent and (
                    not self._runs[source].same_run
                    or self._newest.get(source, -math.inf) < due_ns):
                late.append(source)
        return late

    def of_the_past(self, source, t_ns):
        """Return whether a fix belongs to a run before that of the samples."""
        return self._runs[source].first_is_ahead and t_ns > self._newest[source]

    def came(self, source, t_ns, sample_ns):
        """
        Register a fix, valid or not; return False if it repeats the last one.

        sample_ns: instant of the newest sample, or None.
        """
        self.silent.discard(source)
        newest_ns, runs = self._newest.get(source), self._runs[source]
        self._newest[source] = t_ns
        # The instant equals that of the last fix: a repetition, unless the samples have begun a
        # new run, to which this fix then belongs.
        if t_ns == newest_ns and not runs.first_is_ahead:
            return False
        stamps = self._stamps[source]
        if newest_ns is not None and t_ns <= newest_ns and not stamps.was_ahead(t_ns):
            runs.second_jumps(t_ns, sample_ns)
        if stamps.take(t_ns):
            runs.second_returns()
        return True

    def jump_back(self, t_ns):
        """Follow the samples back to t_ns; return the sources that have yet to jump back."""
        for source, newest_ns in self._newest.items():
            self._runs[source].first_jumps(t_ns, newest_ns)
        return {source for source, runs in self._runs.items() if runs.first_is_ahead}

    def return_back(self):
        """Register that the jump back of the samples was a single stray sample."""
        for runs in self._runs.values():
            runs.first_returns()

    def give_up(self, source):
        """Stop waiting for a source until it delivers again."""
        self.silent.add(source)
        self._runs.pop(source, None)


class AidedStream(MatchedStreams):
    """
    An AidedNavigator on live streams; outputs are (t_ns, solution, errors, sigmas).

    errors: see errors.level_errors; sigmas: those of the filter, or None.  ``judged`` collects a
    JudgedFix for every fix that was processed; the owner empties it.
    """

    def __init__(self, settings, truth_length=TRUTH_LENGTH):
        self.judged, self._fixes = [], []
        self._schedule = FixSchedule(settings, AidedNavigator(settings).sources)
        super().__init__(settings, truth_length)

    def begin(self):
        """Discard the solution. The fixes that have arrived are kept."""
        self.navigator = AidedNavigator(self._settings)
        self._schedule.begin()

    def rejoin(self):
        """Start anew, as if all streams began now."""
        self._schedule.forget()
        self._fixes = []
        super().rejoin()

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self.navigator.navigates

    @property
    def awaited(self):
        """Return the sources that the oldest sample waits for."""
        return self._schedule.missing(self._imu[0][0]) if self._imu else []

    @property
    def silent(self):
        """Return the sources that are no longer waited for."""
        return sorted(self._schedule.silent)

    def go_on_without(self, source):
        """Stop waiting for a source until it delivers again; return the outputs."""
        self._schedule.give_up(source)
        return self.match()

    def go_on(self):
        """Stop waiting for the sources that the oldest sample needs; return the outputs."""
        outputs = []
        for source in self.awaited:
            self.faults.append(StreamFault(
                f'no fix of {source} while {len(self._imu)} IMU readings arrived; expected '
                'one within topics.depth readings: continuing without it until it delivers '
                'again', False))
            outputs += self.go_on_without(source)
        return outputs

    def push_imu(self, t_ns, omega, f):
        """Process the IMU sample with stamp t_ns (motion time)."""
        if self._imu_stamps.was_of_the_past(t_ns):
            self._schedule.return_back()
        elif self._last_ns is not None and t_ns < self._last_ns and \
                not self._imu_stamps.was_ahead(t_ns):
            behind = self._schedule.jump_back(t_ns)
            self._fixes = [entry for entry in self._fixes if entry[1] not in behind]
        return super().push_imu(t_ns, omega, f)

    def push_fix(self, source, fix):
        """
        Process a fix of METER or GNSS, on time or late; return the outputs.

        A repeated fix is ignored. A fix that jumps back in time begins a new history of its
        source. Raises StreamFault for an impossible fix; it is dropped, and no sample waits for
        it: call match() to continue.
        """
        if self._schedule.of_the_past(source, fix.t_ns):
            return []
        if self._last_ns is not None:
            # Check before the fix is registered as the newest of its source.
            check_ahead(source, fix.t_ns, self._last_ns, AHEAD_NS)
        if not self._schedule.came(source, fix.t_ns, self._last_ns):
            return []
        self._fixes = [entry for entry in self._fixes
                       if entry[1] != source or entry[2].t_ns < fix.t_ns]
        if source == METER and fix.cycles != self._settings.window.cycles:
            # A source with other windows never delivers the fixes that the schedule expects.
            self._schedule.silent.add(source)
        if source == METER:
            check_velocity(fix, self._settings.window, self._dt_ns)
        else:
            check_gnss(fix)
        insort(self._fixes, (fix.arrival_ns, source, fix), key=lambda entry: entry[:2])
        # Keep a minute of motion time or more: without readings no fix would ever be removed.
        del self._fixes[:-self._truth.maxlen]
        return self.match()

    def held(self, t_ns):
        """Return whether a fix is due that has not arrived."""
        return bool(self._schedule.missing(t_ns))

    def advance(self, t_ns, omega, f, truth):
        """Process matched samples and the fixes that have arrived by then; return the outputs."""
        self.navigator.take_arrived(self._fixes, t_ns)
        judged = self.navigator.step(t_ns, omega, f, truth)
        if judged is None:
            return []
        self.judged.extend(judged)
        solution = self.navigator.solution
        return [(t_ns, solution, level_errors(solution, truth), self.navigator.filter.sigmas())]
