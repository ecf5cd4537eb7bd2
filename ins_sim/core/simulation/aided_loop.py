"""Loop of the aided navigator over blocks; samples without a fix are processed together."""

from bisect import bisect_left

import numpy as np

from ins_sim.core.aiding import segment
from ins_sim.core.aiding.navigator import DivergedSolution
from ins_sim.core.navigation.errors import level_errors
from ins_sim.core.navigation.loop import NavigationLoop
from ins_sim.core.streams.faults import is_regular
from ins_sim.core.timeseries.histories import AidedErrors, NavStates

NONE = (np.nan,) * 3
UNKNOWN = (NONE,) * 3


class AidedLoop(NavigationLoop):
    """A NavigationLoop that passes fixes to the navigator before the sample of their arrival."""

    # Fixes that have not arrived yet: (arrival_ns, source, fix), in the order of arrival.
    waiting = ()
    # Function of the AidedNavigator whose result is stored at each output instant, or None.
    note = None
    # Whether a solution has diverged and was restarted.
    diverged = False

    def recover(self, fault):
        """Prepare for the sample at a StreamFault; return whether the loop continues."""
        self.diverged = self.diverged or isinstance(fault, DivergedSolution)
        return super().recover(fault)

    def step(self, t_ns, *sample):
        """Pass the arrived fixes and a sample to the navigator; return its output."""
        self.navigator.take_arrived(self.waiting, t_ns)
        return super().step(t_ns, *sample)

    def run_block(self, block):
        """Process an AidedBlock; return a list of JudgedFix."""
        found, first, count = [], 0, len(block.samples.t_ns)
        while first < count:
            stop = self._run_quiet(block, first)
            if stop > first:
                self._last_ns = block.samples.t_ns[stop - 1]
            else:
                stop = first + 1
                for _, judged, _ in self.run([block.sample(first)]):
                    found += judged
                    block.write(first)
                    block.put_out(first, stop)
            first = stop
        return found

    def _run_quiet(self, block, first):
        """Process consecutive samples at which no fix arrives; return their end."""
        if not self.navigator.takes_segments:
            return first
        stop = block.even_until(first, self._last_ns)
        if self.waiting:
            stop = bisect_left(block.samples.t_ns, self.waiting[0][0], first, stop)
        return self.navigator.run(block.samples, first, stop, block.out, block.put_out)


class AidedBlock:
    """
    ImuSamples, the Truth at their stamps, and the outputs of a loop at these samples.

    loop: the AidedLoop that will step through the block.
    """

    def __init__(self, imu, truth, loop):
        self._imu, self._truth, self._loop = imu, truth, loop
        self.samples = segment.samples_of(imu.t_ns, imu.omega, imu.f, truth.height,
                                          truth.v_n[:, 2])
        self.out = np.empty(segment.ROW * len(imu))
        self._uneven = (np.flatnonzero(~is_regular(np.diff(imu.t_ns), loop.dt_ns)) + 1).tolist()
        self._due, self._due_since = [], None
        self._kept, self._said, self._notes = [], [], []

    def sample(self, k):
        """Return the arguments of AidedNavigator.step for a sample."""
        truth = self._truth
        t_ns, omega, f, _, _ = self.samples.sample(k)
        return t_ns, omega, f, (float(truth.lat[k]), float(truth.lon[k]), float(truth.height[k]),
                                tuple(truth.v_n[k].tolist()), tuple(truth.q_nb[k].tolist()))

    def even_until(self, first, last_ns):
        """Return the end of the samples, from first on, that follow last_ns without a gap."""
        t_ns = self.samples.t_ns
        if not is_regular(t_ns[first] - last_ns, self._loop.dt_ns):
            return first
        k = bisect_left(self._uneven, first + 1)
        return self._uneven[k] if k < len(self._uneven) else len(t_ns)

    def write(self, k):
        """Store the solution of the navigator as that of sample k."""
        lat, lon, height, v, q_nb = self._loop.navigator.solution
        self.out[segment.ROW * k:segment.ROW * (k + 1)] = (lat, lon, height, *v, *q_nb)

    def put_out(self, first, stop):
        """Output the due ones among some samples, with the present state of the filter."""
        decimation = self._loop.decimation
        if self._due_since != decimation.first_ns:
            self._due = np.flatnonzero(decimation.due(self._imu.t_ns)).tolist()
            self._due_since = decimation.first_ns
        due = self._due[bisect_left(self._due, first):bisect_left(self._due, stop)]
        if due:
            navigator, note = self._loop.navigator, self._loop.note
            filter_ = navigator.filter
            said = (*(filter_.sigmas() or UNKNOWN)[::-1], filter_.estimates,
                    filter_.estimate_sigmas() or NONE)
            self._kept += due
            self._said += [said] * len(due)
            if note is not None:
                self._notes += [note(navigator)] * len(due)

    def records(self):
        """Return Truth, NavStates, AidedErrors and notes of the output samples, or None."""
        if not self._kept:
            return None
        truth = self._truth[self._kept]
        rows = self.out.reshape(-1, segment.ROW)[self._kept]
        states = NavStates(truth.t_ns, rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3:6],
                           rows[:, 6:10])
        errors = level_errors(_columns(states), _columns(truth))
        return truth, states, AidedErrors(
            truth.t_ns, *(np.stack(e, axis=-1) for e in errors),
            *map(np.array, zip(*self._said))), self._notes


def _columns(record):
    """Return lat, lon, height, v_n and q_nb of a record, each component an array."""
    return record.lat, record.lon, record.height, record.v_n.T, record.q_nb.T
