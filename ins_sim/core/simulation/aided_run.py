"""The aided navigator offline: readings of the IMU and fixes of the instruments in blocks."""

from bisect import bisect_right
from dataclasses import dataclass

import numpy as np

from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, METER
from ins_sim.core.navigation.errors import level_errors
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.streams.faults import check_interval, StreamFault
from ins_sim.core.timeseries.histories import AidedErrors, NavStates, Truth

NONE = (np.nan,) * 3
UNKNOWN = (NONE,) * 3


@dataclass(frozen=True)
class AidedResult:
    """
    One aided run: truth, solution and errors at the output instants.

    judged: a JudgedFix for every fix, in the order of arrival; faults: a sentence for each fault;
    velocity_fixes, gnss_fixes: what the instruments reported, where ``simulate_aided`` asked them.
    """

    truth: Truth
    states: NavStates
    errors: AidedErrors
    judged: tuple
    faults: tuple = ()
    velocity_fixes: tuple = ()
    gnss_fixes: tuple = ()


class Reported:
    """Fixes that are known already, in the order of their instants, an instrument of ``aid``."""

    def __init__(self, fixes):
        self._fixes, self._next = fixes, 0

    def fixes(self, truth):
        """Return the fixes up to the last instant of a Truth record that were not returned yet."""
        first, self._next = self._next, bisect_right(
            self._fixes, int(truth.t_ns[-1]), lo=self._next, key=lambda fix: fix.t_ns)
        return self._fixes[first:self._next]


def with_truth(motion, blocks):
    """Yield pairs of ImuSamples and the Truth at their stamps."""
    for imu in blocks:
        yield imu, motion.at(imu.t_ns)


def aid(settings, blocks, meter=None, gnss=None, run=0):
    """
    Return the AidedResult of AidedNavigatorSettings over the blocks of ``with_truth``.

    meter, gnss: the instruments, anything with fixes(Truth) -> list of fixes in the order of
    arrival, or None; run: of the ensemble.  Faults are handled as on_fault says: the solution
    starts anew from the truth, or ValueError is raised.  Raises ValueError where there is no
    output.
    """
    chain = _Chain(settings, run)
    sources = [(source, instrument) for source, instrument in ((METER, meter), (GNSS, gnss))
               if instrument is not None]
    for imu, truth in blocks:
        chain.block(imu, truth, [(fix.arrival_ns, source, fix) for source, instrument in sources
                                 for fix in instrument.fixes(truth)])
    return chain.finish()


class _Chain:
    def __init__(self, settings, run):
        self._settings, self._run = settings, run
        self._dt_ns = period_ns(settings.rate_hz)
        self._nav = AidedNavigator(settings, run)
        self._last_ns = self._first_ns = None
        self._truth, self._solutions, self._errors = [], [], []
        self._judged, self._faults, self._t_ns = [], [], []
        self._waiting = []

    def block(self, imu, truth, fixes):
        """Step through a block; fixes: (arrival_ns, source, fix)."""
        # one that is on its way from an earlier block may arrive behind one of this
        self._waiting = sorted(self._waiting + fixes, key=lambda entry: entry[:2])
        columns = zip(imu.t_ns.tolist(), map(tuple, imu.omega.tolist()),
                      map(tuple, imu.f.tolist()), truth.lat.tolist(), truth.lon.tolist(),
                      truth.height.tolist(), truth.v_n.tolist(), truth.q_nb.tolist())
        kept = []
        for k, (t_ns, omega, f, *now) in enumerate(columns):
            if self._step(t_ns, omega, f, now):
                kept.append(k)
        if kept:
            self._truth.append(truth[kept])

    def _step(self, t_ns, omega, f, truth):
        """Take one sample; return whether its instant is put out."""
        try:
            if self._last_ns is not None:
                check_interval('imu', t_ns, self._last_ns, self._dt_ns)
        except StreamFault as fault:
            self._fault(fault)
        self._last_ns = t_ns
        while self._waiting and self._waiting[0][0] <= t_ns:
            _, source, fix = self._waiting.pop(0)
            try:
                self._nav.take(source, fix)
            except StreamFault as fault:
                self._fault(fault)
        try:
            judged = self._nav.step(t_ns, omega, f, truth)
        except StreamFault as fault:
            self._fault(fault)
            judged = self._nav.step(t_ns, omega, f, truth)
        if judged is None:
            return False
        self._judged.extend(judged)
        if self._first_ns is None:
            self._first_ns = t_ns
        steps = (t_ns - self._first_ns + self._dt_ns // 2) // self._dt_ns
        if steps % self._settings.output_every:
            return False
        solution, filter_ = self._nav.solution, self._nav.filter
        self._t_ns.append(t_ns)
        self._solutions.append(solution)
        self._errors.append((*level_errors(solution, truth), *(filter_.sigmas() or UNKNOWN)[::-1],
                             filter_.estimates, filter_.estimate_sigmas() or NONE))
        return True

    def _fault(self, fault):
        if self._settings.on_fault == 'stop':
            raise ValueError(str(fault))
        self._faults.append(str(fault))
        if fault.restart:
            self._nav = AidedNavigator(self._settings, self._run)

    def finish(self):
        """Return the AidedResult."""
        if not self._truth:
            raise ValueError('the run has no navigation output; expected duration_s longer than '
                             'initial.after_s')
        t_ns = np.array(self._t_ns, dtype=np.int64)
        return AidedResult(Truth.concatenate(self._truth),
                           NavStates(t_ns, *map(np.array, zip(*self._solutions))),
                           AidedErrors(t_ns, *map(np.array, zip(*self._errors))),
                           tuple(self._judged), tuple(self._faults))
