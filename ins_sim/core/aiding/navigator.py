"""
The aided navigator: a strapdown, and a filter that processes fixes, including late ones.

A late fix is processed at its own instant: the navigator restores the snapshot before it, applies
the fix, and advances again over the samples since then.
"""

from bisect import bisect_left, insort
from collections import namedtuple
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
from . import segment
from .corrected_strapdown import CorrectedStrapdown
from .filtered_strapdown import FilteredStrapdown
from .filters.base import INVALID_FIX, refused_fix
from .fix_checks import check_ahead, check_gnss, check_velocity
from .past import FixEntry, FlownSamples, Past

METER, GNSS = 'velocity_meter', 'gnss'


# A processed fix: its source, its instant (ns of motion time) and the FixOutcome.
JudgedFix = namedtuple('JudgedFix', 'source t_ns outcome')


class DivergedSolution(StreamFault):
    """The solution is not finite, or its covariance is not positive definite."""


def filter_class(name):
    """Return the class of a filter of the table `settings.aided_navigator.FILTERS`."""
    return located(FILTERS[name].location, f'filter {name}')


class AidedNavigator:
    """
    Strapdown and filter of one IMU.

    Samples enter through ``step``, fixes through ``take`` in any order; a fix is processed at the
    first sample that reaches its ``arrival_ns``.

    Parameters
    ----------
    settings : AidedNavigatorSettings

    Attributes
    ----------
    sources : tuple of str
        The instruments whose fixes are used: METER, GNSS.
    """

    def __init__(self, settings):
        self._settings = settings
        self._dt_ns = period_ns(settings.rate_hz)
        self._window_ns = settings.window.cycles * self._dt_ns
        self._step_ns = settings.window.step_cycles * self._dt_ns
        self._buffer_ns = round(settings.buffer_s * 1e9)
        self._after_ns = round(settings.initial.after_s * 1e9)
        self._filter_class, entry = filter_class(settings.filter), FILTERS[settings.filter]
        used = {METER: settings.meter_model.use and entry.takes_velocity,
                GNSS: settings.gnss_model.use and entry.takes_gnss}
        self.sources = tuple(source for source, use in used.items() if use)
        self._altimeter = settings.vertical.channel == 'altimeter'
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self._first_ns = self._flight = None
        self._pending, self._past = [], Past(self._buffer_ns, self._dt_ns)

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._flight is not None

    @property
    def filter(self):
        """Return the AidingFilter, or None until the solution starts."""
        return self._flight.filter if self._flight else None

    @property
    def ins(self):
        """Return the CorrectedStrapdown; not to be used before the solution has started."""
        return self._flight.ins

    @property
    def takes_segments(self):
        """Return whether the solution has started and ``run`` can process several samples."""
        return self._flight is not None and self._flight.takes_segments

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb at the last sample."""
        return self.ins.solution

    def step(self, t_ns, omega, f, truth):
        """
        Process the reading whose interval ends at t_ns.

        Parameters
        ----------
        t_ns : instant
        omega, f : tuples of three, rad/s and m/s^2
        truth : (lat, lon, height, v_n, q_nb). It starts the solution, together with the initial
            errors; later only its height and vertical velocity are used, as an altimeter.

        Returns
        -------
        list of JudgedFix, or None before the start

        """
        if self._flight is None:
            if self._first_ns is None:
                self._first_ns = t_ns
            if t_ns < self._first_ns + self._after_ns:
                return None
            self._start(t_ns, omega, f, truth)
        else:
            one = segment.one_sample(t_ns, omega, f, truth[2], truth[3][2])
            self._flight.advance(one, 0, 1)
            self._past.add_samples(one, 0, 1)
            if not self._flight.is_finite:
                raise DivergedSolution(f'the solution at {seconds(t_ns)} is not finite; '
                                       'expected finite readings', restart=True)
        self._keep()
        return self._due()

    def run(self, samples, first, stop, out, put_out):
        """
        Process samples as ``step`` does, up to the first at which a fix arrives; return their end.

        If the solution diverges at some sample, no sample is processed and first is returned;
        ``step``, called sample by sample, then finds this sample.

        Parameters
        ----------
        samples : segment.Samples
        first, stop : int
            Range of samples that may be processed, stop excluded; the solution must have started.
        out : flat array
            The solution at each sample is written into it, see ``segment.fly``.
        put_out : callable
            Called with the range of samples whose solutions have been written, while the filter
            still has its state at these samples.
        """
        flight = self._flight
        if self._pending:
            stop = bisect_left(samples.t_ns, self._pending[0].fix.arrival_ns, first, stop)
        if stop == first:
            return first
        stop = flight.cut(samples, first, stop, self._past.next_ns)
        flight.begin_window()
        before = flight.ins.carry, flight.filter.sums
        flight.fly(samples, first, stop, out)
        if not flight.is_finite:
            flight.ins.carry, flight.filter.sums = before
            return first
        put_out(first, stop - 1)
        flight.pause()
        put_out(stop - 1, stop)
        self._past.add_samples(samples, first, stop)
        self._keep()
        return stop

    def take(self, source, fix):
        """
        Keep a fix until the samples reach its arrival_ns.

        source: METER or GNSS.  Raises StreamFault, with one sentence, for an impossible fix: from
        the future, with another window, without a positive variance, NaN.
        """
        if source == METER:
            check_velocity(fix, self._settings.window, self._dt_ns)
        else:
            check_gnss(fix)
        if self.navigates:
            check_ahead(source, fix.t_ns, self.ins.t_ns, self._dt_ns + self._buffer_ns)
        insort(self._pending, FixEntry(source, fix), key=_arrival)

    def take_arrived(self, waiting, t_ns):
        """
        Move the fixes that have arrived by t_ns from a list to the navigator, as ``take`` does.

        waiting: (arrival_ns, source, fix) in the order of arrival.  A fix that is refused is
        removed from the list as well.
        """
        while waiting and waiting[0][0] <= t_ns:
            _, source, fix = waiting.pop(0)
            self.take(source, fix)

    def _start(self, t_ns, omega, f, truth):
        lat, lon, height, v, q_nb = truth
        settings, initial = self._settings, self._settings.initial
        draw = indexed_noise(settings.seed, settings.run, 'aided.initial', 7).normal(0)
        tilt, azimuth = 1e-3 * initial.tilt_sigma_mrad, 1e-3 * initial.azimuth_sigma_mrad
        error = quaternion.exponential((tilt * draw[4], tilt * draw[5], azimuth * draw[6]))
        place = lat, lon, height, v, quaternion.multiply(error, q_nb)
        channel = FROM_TRUTH if self._altimeter else FREE
        ins = CorrectedStrapdown(t_ns, omega, f, self._dt_ns * 1e-9, place, self._spin,
                                 self._settings.input == 'integrated', channel,
                                 ellipsoid.GRAVITY_TERMS[self._settings.earth.gravity])
        p, s = initial.position_sigma_m, initial.velocity_sigma_m_s
        ins.correct(position=(-p * draw[0], -p * draw[1], 0.0),
                    velocity=(-s * draw[2], -s * draw[3], 0.0))
        self._flight = FilteredStrapdown(ins, self._filter_class(self._settings, ins),
                                         self._window_ns, self._step_ns)

    def _keep(self):
        """Take a snapshot if one is due, before the fixes of this instant are processed."""
        if self.ins.t_ns >= self._past.next_ns:
            self._past.add_snapshot(self._flight)
            self._past.forget(self.ins.t_ns)

    def _due(self):
        """Process the fixes that have arrived by now; return a list of JudgedFix."""
        judged = []
        while self._pending and self._pending[0].fix.arrival_ns <= self.ins.t_ns:
            entry = self._pending.pop(0)
            self._past.forget(self.ins.t_ns)
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
        if fix.t_ns < self._past.start_ns:
            late = (self.ins.t_ns - fix.t_ns) * 1e-9
            return refused_fix(f'the fix is {late:.3f} s old; expected at most buffer_s, '
                               f'{self._settings.buffer_s:g} s, and no fix from before the start')
        if self._past.knows(entry):
            return refused_fix(f'the fix at {seconds(fix.t_ns)} was already received')
        return None

    def _insert(self, entry):
        newest = self._past.add_fix(entry)
        if newest and entry.fix.t_ns > self.ins.t_ns - self._dt_ns:
            return self._apply(entry)
        return self._replay(entry)

    def _replay(self, wanted):
        """Restore the snapshot before a fix, and advance again; return the FixOutcome."""
        now_ns, found = self.ins.t_ns, None
        self._flight, flown, fixes = self._past.go_back(wanted.fix.t_ns)
        flight = self._flight
        while True:
            while fixes and fixes[0].fix.t_ns <= flight.ins.t_ns:
                entry = fixes.popleft()
                outcome = self._apply(entry)
                found = outcome if entry is wanted else found
            if not flown:
                return found
            samples, first, end = flown.popleft()
            event_ns = min(self._past.next_ns, fixes[0].fix.t_ns if fixes else math.inf)
            stop = flight.cut(samples, first, end, event_ns)
            if stop < end:
                flown.appendleft(FlownSamples(samples, stop, end))
            flight.advance(samples, first, stop)
            if self._past.next_ns <= flight.ins.t_ns < now_ns:
                self._past.add_snapshot(flight)

    def _apply(self, entry):
        fix, ins = entry.fix, self.ins
        if entry.source == GNSS:
            return self.filter.update_gnss(ins, fix, ins.rate_to_earth,
                                           self._settings.gnss_model.lever_arm_m)
        if self._flight.covers_from_ns > fix.start_ns or ins.t_ns != fix.end_ns:
            return refused_fix('the solution does not cover the window of the fix')
        forward, left = fix.velocity
        known = self._settings.meter_model.bias_x_m_s / fix.cycles
        return self.filter.update_velocity(ins, replace(fix, velocity=(forward - known, left)))

    def _check(self):
        """Raise DivergedSolution if the covariance is no longer positive definite."""
        if not self.filter.healthy:
            raise DivergedSolution(
                f'the covariance of filter {self._settings.filter} at '
                f'{seconds(self.ins.t_ns)} is not positive definite; expected errors that '
                'agree with the model of the filter', restart=True)


def _arrival(entry):
    return entry.fix.arrival_ns, entry.source, entry.fix.t_ns
