"""
The aided navigator: a strapdown, and a filter that processes fixes on time or late.

A late fix is processed at its own instant: the navigator restores the snapshot before it, applies
the fix, and advances again over the samples since then.
"""

from bisect import insort
from collections import deque, namedtuple
from dataclasses import replace
import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.vertical_channel import FREE, FROM_TRUTH
from ins_sim.core.numerics.instants import period_ns, seconds
from ins_sim.core.numerics.located import located
from ins_sim.core.numerics.noise import indexed_noise
from ins_sim.core.streams.faults import StreamFault
from ins_sim.settings.aided_navigator import FILTERS
from .corrected_strapdown import CorrectedStrapdown
from .filters.base import INVALID_FIX, refused_fix
from .fix_checks import check_ahead, check_gnss, check_velocity

SNAPSHOT_NS = 1_000_000_000
METER, GNSS = 'velocity_meter', 'gnss'

# A fix that was processed: its source, its instant (ns of motion time) and the FixOutcome.
JudgedFix = namedtuple('JudgedFix', 'source t_ns outcome')
_Entry = namedtuple('_Entry', 'source fix')
_Snapshot = namedtuple('_Snapshot', 't_ns ins filter window_start_ns')


def filter_class(name):
    """Return the class of a filter of the table `settings.aided_navigator.FILTERS`."""
    return located(FILTERS[name].location, f'filter {name}')


class AidedNavigator:
    """
    Strapdown and filter of one IMU.

    Samples are given by ``step``, fixes by ``take`` in any order; a fix is processed at the
    sample that reaches its ``arrival_ns``.

    Parameters
    ----------
    settings : AidedNavigatorSettings
    run : int
        Number of the realization in an ensemble; each draws other initial errors.

    Attributes
    ----------
    filter : AidingFilter or None
        None until the solution starts.
    sources : tuple of str
        The instruments that aid: METER, GNSS.
    """

    def __init__(self, settings, run=0):
        self._settings, self._run = settings, run
        self._dt_ns = period_ns(settings.rate_hz)
        self._window_ns = settings.window.cycles * self._dt_ns
        self._buffer_ns = round(settings.buffer_s * 1e9)
        self._after_ns = round(settings.initial.after_s * 1e9)
        self._filter_class, entry = filter_class(settings.filter), FILTERS[settings.filter]
        used = {METER: settings.meter_model.use and entry.takes_velocity,
                GNSS: settings.gnss_model.use and entry.takes_gnss}
        self.sources = tuple(source for source, use in used.items() if use)
        self._altimeter = settings.vertical.channel == 'altimeter'
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self._first_ns = self._ins = self.filter = None
        self._pending, self._samples, self._log = [], deque(), []
        self._snapshots = deque()

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._ins is not None

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb at the last sample."""
        return self._ins.solution

    def step(self, t_ns, omega, f, truth):
        """
        Take the reading that ends at t_ns; return a list of JudgedFix, or None before the start.

        omega, f: tuples, rad/s and m/s^2; truth: (lat, lon, height, v_n, q_nb), which starts the
        solution, with the initial errors, and then is the altimeter.
        """
        vertical = (truth[2], truth[3][2]) if self._altimeter else ()
        if self._ins is None:
            if self._first_ns is None:
                self._first_ns = t_ns
            if t_ns < self._first_ns + self._after_ns:
                return None
            self._start(t_ns, omega, f, truth)
        else:
            self._samples.append((t_ns, omega, f, vertical))
            self._advance(*self._samples[-1])
            # a sum is finite only if all of it is
            if not math.isfinite(sum(self._ins.v) + self._ins.lat + self._ins.height):
                raise StreamFault(f'the solution at {seconds(t_ns)} is no number any more; '
                                  'expected finite readings', restart=True)
        self._keep()
        return self._due()

    def take(self, source, fix):
        """
        Keep a fix until the samples reach its arrival_ns.

        source: METER or GNSS.  Raises StreamFault, in one sentence, for a fix that cannot be
        one: from the future, with another window, without a positive variance, NaN.
        """
        if source == METER:
            check_velocity(fix, self._settings.window.cycles, self._dt_ns)
        else:
            check_gnss(fix)
        if self._ins is not None:
            check_ahead(source, fix.t_ns, self._ins.t_ns, self._dt_ns + self._buffer_ns)
        insort(self._pending, _Entry(source, fix), key=_arrival)

    def take_arrived(self, waiting, t_ns):
        """
        Take the fixes that have arrived by t_ns out of a list, as ``take`` does.

        waiting: (arrival_ns, source, fix) in the order of arrival.  A fix that is refused has left
        the list too.
        """
        while waiting and waiting[0][0] <= t_ns:
            _, source, fix = waiting.pop(0)
            self.take(source, fix)

    def _start(self, t_ns, omega, f, truth):
        lat, lon, height, v, q_nb = truth
        draw = indexed_noise(self._settings.seed, self._run, 'aided.initial', 7).normal(0)
        initial = self._settings.initial
        tilt, azimuth = 1e-3 * initial.tilt_sigma_mrad, 1e-3 * initial.azimuth_sigma_mrad
        error = quaternion.exponential((tilt * draw[4], tilt * draw[5], azimuth * draw[6]))
        place = lat, lon, height, v, quaternion.multiply(error, q_nb)
        channel = FROM_TRUTH if self._altimeter else FREE
        self._ins = CorrectedStrapdown(t_ns, omega, f, self._dt_ns * 1e-9, place, self._spin,
                                       self._settings.input == 'integrated', channel)
        p, s = initial.position_sigma_m, initial.velocity_sigma_m_s
        self._ins.correct(position=(-p * draw[0], -p * draw[1], 0.0),
                          velocity=(-s * draw[2], -s * draw[3], 0.0))
        self.filter = self._filter_class(self._settings, self._ins)
        self._window_start_ns = t_ns

    def _advance(self, t_ns, omega, f, vertical):
        ins, filter_ = self._ins, self.filter
        if ins.t_ns // self._window_ns != self._window_start_ns // self._window_ns:
            # Not at the end of the window, so that the fix of that instant still finds its sums.
            filter_.begin_window(ins)
            self._window_start_ns = ins.t_ns
        before, last_ns = (ins.q_nb, ins.v_b, ins.v), ins.t_ns
        u = ins.take(t_ns, omega, f, vertical)
        filter_.step(ins, before, u, (t_ns - last_ns) * 1e-9)

    def _keep(self):
        """Take a snapshot now and then; forget what is older than the buffer."""
        self._snapshot()
        oldest_ns = self._ins.t_ns - self._buffer_ns
        while len(self._snapshots) > 1 and self._snapshots[1].t_ns <= oldest_ns:
            self._snapshots.popleft()
        start_ns = self._snapshots[0].t_ns
        while self._samples and self._samples[0][0] <= start_ns:
            self._samples.popleft()
        while self._log and self._log[0].fix.t_ns <= start_ns - self._dt_ns:
            self._log.pop(0)

    def _snapshot(self):
        """Take a snapshot, before the fixes of this instant, unless the last one is young."""
        ins = self._ins
        if not self._snapshots or ins.t_ns - self._snapshots[-1].t_ns >= SNAPSHOT_NS:
            self._snapshots.append(_Snapshot(ins.t_ns, ins.copy(), self.filter.copy(),
                                             self._window_start_ns))

    def _due(self):
        """Process the fixes that have arrived by now; return a list of JudgedFix."""
        judged = []
        while self._pending and self._pending[0].fix.arrival_ns <= self._ins.t_ns:
            entry = self._pending.pop(0)
            outcome = self._unfit(entry) or self._insert(entry)
            self._check()
            judged.append(JudgedFix(entry.source, entry.fix.t_ns, outcome))
        return judged

    def _unfit(self, entry):
        """Return the FixOutcome of a fix that must not reach the filter, or None."""
        fix = entry.fix
        if not fix.valid:
            return refused_fix(f'{INVALID_FIX}: {fix.status}')
        if entry.source not in self.sources:
            return refused_fix(f'{entry.source} is not used')
        if fix.t_ns < self._snapshots[0].t_ns:
            late = (self._ins.t_ns - fix.t_ns) * 1e-9
            return refused_fix(f'the fix is {late:.3f} s old; expected at most buffer_s, '
                               f'{self._settings.buffer_s:g} s, and none before the start')
        if any(_instant(other) == _instant(entry) for other in reversed(self._log)
               if other.fix.t_ns >= fix.t_ns):
            return refused_fix(f'the fix at {seconds(fix.t_ns)} has come before')
        return None

    def _insert(self, entry):
        insort(self._log, entry, key=_instant)
        if entry.fix.t_ns > self._ins.t_ns - self._dt_ns and self._log[-1] is entry:
            return self._apply(entry)
        return self._replay(entry)

    def _replay(self, wanted):
        """Restore the snapshot before a fix, and advance again; return the FixOutcome."""
        now_ns, found = self._ins.t_ns, None
        while self._snapshots[-1].t_ns > wanted.fix.t_ns:
            self._snapshots.pop()
        start = self._snapshots[-1]
        self._ins, self.filter = start.ins.copy(), start.filter.copy()
        self._window_start_ns = start.window_start_ns
        log = deque(e for e in self._log if e.fix.t_ns > start.t_ns - self._dt_ns)
        samples = deque(s for s in self._samples if s[0] > start.t_ns)
        while True:
            while log and log[0].fix.t_ns <= self._ins.t_ns:
                entry = log.popleft()
                outcome = self._apply(entry)
                found = outcome if entry is wanted else found
            if not samples:
                return found
            self._advance(*samples.popleft())
            if self._ins.t_ns < now_ns:
                self._snapshot()

    def _apply(self, entry):
        fix, ins = entry.fix, self._ins
        if entry.source == GNSS:
            return self.filter.update_gnss(ins, fix, ins.rate_to_earth,
                                           self._settings.gnss_model.lever_arm_m)
        if self._window_start_ns > fix.start_ns or ins.t_ns != fix.end_ns:
            return refused_fix('the solution does not cover its window')
        forward, left = fix.velocity
        known = self._settings.meter_model.bias_x_m_s / fix.cycles
        return self.filter.update_velocity(ins, replace(fix, velocity=(forward - known, left)))

    def _check(self):
        """Raise StreamFault if the covariance is no longer positive definite."""
        if not self.filter.healthy:
            raise StreamFault(f'the covariance of filter {self._settings.filter} at '
                              f'{seconds(self._ins.t_ns)} is not positive definite; expected '
                              'errors that the model can follow', restart=True)


def _instant(entry):
    return entry.fix.t_ns, entry.source


def _arrival(entry):
    return entry.fix.arrival_ns, entry.source, entry.fix.t_ns
