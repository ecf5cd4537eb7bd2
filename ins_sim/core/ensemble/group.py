"""A group of at most 16 runs that the strapdown processes together."""

from dataclasses import replace

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation import whole_run
from ins_sim.core.navigation.navigator import CHANNELS, InertialNavigator
from ins_sim.core.navigation.vertical_channel import DAMPED, damping, NO_DAMPING
from ins_sim.core.numerics import compilation
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.sampling import consecutive
from ins_sim.core.sensors.imu.with_errors import with_errors
from . import lanes
from .lanes import LANES
from .sensing import SensedTriad

# Number of errors: attitude (rad), velocity (m/s) and position (m), each East, North, Up.
ERRORS = 9
# Number of samples processed together; their readings in 16 runs take 0.8 MB.
PIECE = 1024


class Group:
    """
    Runs with the same truth and the same ideal readings.

    Parameters
    ----------
    settings : SimulationSettings
    runs : numbers of the runs, at most 16
    initial : function (number of a run) -> its Initial errors, or None for those of the settings
    """

    def __init__(self, settings, runs, initial=None):
        strapdown = settings.strapdown
        self.runs = tuple(runs)
        self._dt_ns = period_ns(strapdown.rate_hz)
        instruments = [with_errors(settings.with_run(run).imu_sensor) for run in self.runs]
        self._gyro = _sensed([i and i.gyro for i in instruments], 0)
        self._accelerometer = _sensed([i and i.accelerometer for i in instruments], 3)
        self._spin = ellipsoid.rotation_rate(strapdown.earth.rotation)
        self._gravity = ellipsoid.GRAVITY_TERMS[strapdown.earth.gravity]
        self._channel = CHANNELS[strapdown.vertical.channel]
        self._damping = NO_DAMPING
        if self._channel == DAMPED:
            self._damping = damping(strapdown.vertical.time_constant_s)
        self._integrated = strapdown.input == 'integrated'
        self._navigators = [InertialNavigator(
            replace(strapdown, initial=replace(
                strapdown.initial if initial is None else initial(run), after_s=0.0)))
            for run in self.runs]
        self._state = self._start_ns = self._last_ns = None
        self._lost = np.zeros(LANES, dtype=bool)

    @property
    def diverged(self):
        """Return the numbers of the runs that have diverged."""
        return tuple(run for run, lost in zip(self.runs, self._lost) if lost)

    def wait(self, imu):
        """Process ideal samples from before the strapdown starts, so that lags settle."""
        for part in _pieces(imu.t_ns // self._dt_ns):
            self._sense(imu[part])

    def advance(self, imu, t_ns, truth, picked):
        """
        Process samples and return the errors (m, runs, ERRORS) at the picked ones.

        The first sample of all starts the strapdown. Errors of a diverged run are NaN.

        Parameters
        ----------
        imu : ImuSamples of the ideal instrument
        t_ns : instants of the samples, ns
        truth : Truth at these instants
        picked : (m,) indices of samples
        """
        solved = [self._advance(imu[part], t_ns[part], truth[part],
                                picked[(picked >= part.start) & (picked < part.stop)] - part.start)
                  for part in _pieces(imu.t_ns // self._dt_ns)]
        return self._judged(t_ns[picked], np.concatenate(solved), truth[picked])[..., 4:]

    def _advance(self, imu, t_ns, truth, picked):
        readings = self._sense(imu)
        solved = np.empty((len(picked), whole_run.SOLVED, LANES))
        begun = 0
        if self._state is None:
            self._start(t_ns, readings, truth)
            begun = 1
            if len(picked) and picked[0] == 0:
                solved[0] = self._solved()
        if len(t_ns) > begun:
            later = picked >= begun
            found = np.empty((np.count_nonzero(later), whole_run.SOLVED, LANES))
            marks = np.append(picked[later] - begun, -1)
            inputs = (self._state, self._spin, self._start_ns, self._last_ns, self._channel,
                      self._damping, self._gravity, self._integrated, t_ns[begun:],
                      readings[begun:], truth.height[begun:],
                      np.ascontiguousarray(truth.v_n[begun:, 2]), marks)
            state = compilation.run(lanes.advance, LANES * (len(t_ns) - begun), inputs, found)
            self._state = np.reshape(state, (lanes.NUMBERS, LANES))
            solved[later] = found
        self._last_ns = int(t_ns[-1])
        solved[:, :, self._lost] = np.nan
        self._set_aside()
        return solved

    def _sense(self, imu):
        """Return the readings (n, 6, LANES); unused lanes get those of the first run."""
        readings = np.empty((len(imu), 6, LANES))
        t_s, first = imu.t_ns * 1e-9, int(imu.t_ns[0]) // self._dt_ns
        for triad, values, rows in ((self._gyro, imu.omega, readings[:, 0:3]),
                                    (self._accelerometer, imu.f, readings[:, 3:6])):
            if triad is None:
                rows[:] = values[:, :, None]
            else:
                triad.read(first, values, imu.f, t_s, readings)
                rows[:, :, len(self.runs):] = rows[:, :, 0:1]
        return readings

    def _start(self, t_ns, readings, truth):
        self._start_ns = self._last_ns = int(t_ns[0])
        state = np.zeros((lanes.NUMBERS, LANES))
        for lane, navigator in enumerate(self._navigators):
            omega, f = readings[0, 0:3, lane], readings[0, 3:6, lane]
            navigator.step(self._start_ns, tuple(omega.tolist()), tuple(f.tolist()), truth.one(0))
            q, place, (alpha, nu), _ = navigator.carry
            state[:lanes.CARRIED, lane] = *place, *q, *alpha, *nu
        state[:, len(self.runs):] = state[:, 0:1]
        self._state, self._navigators = state, None

    def _set_aside(self):
        """Mark diverged runs; their lanes continue as copies of a run that has not diverged."""
        off = ~np.isfinite(self._state[:lanes.CARRIED]).all(axis=0)
        self._lost |= off
        if off.any() and not self._lost.all():
            self._state[:, off] = self._state[:, np.flatnonzero(~self._lost)[0], None]

    def _solved(self):
        """Return the SOLVED rows of the state."""
        return np.concatenate([self._state[0:6], self._state[lanes.PLACES:lanes.PLACES + 4]])

    def _judged(self, t_ns, solved, truth):
        count = len(self.runs)
        rows = np.ascontiguousarray(np.moveaxis(solved, 2, 1)[:, :count]).reshape(
            -1, whole_run.SOLVED)
        judged = np.empty((len(rows), whole_run.JUDGED))
        if len(rows):
            t_s = (t_ns - self._start_ns) * 1e-9
            every = [np.repeat(a, count, axis=0)
                     for a in (t_s, truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)]
            with np.errstate(invalid='ignore'):
                whole_run.judge_arrays(self._spin, every[0], rows, *every[1:], judged)
        return judged.reshape(len(t_ns), count, whole_run.JUDGED)

    def final(self, truth):
        """
        Return the solutions at the last sample and their errors, NaN for diverged runs.

        truth: Truth at that sample. Solutions (runs, SOLVED): lat, lon, height, v_n, q_nb.
        """
        solved = self._solved()
        solved[:, self._lost] = np.nan
        judged = self._judged(np.array([self._last_ns]), solved[None], truth)[0]
        place = solved[:6].T[:len(self.runs)]
        return np.concatenate([place, judged[:, :4]], axis=1), judged[:, 4:]


def _sensed(triads, column):
    """Return the SensedTriad of TriadErrors, or None if all of them are perfect."""
    if all(triad is None or triad.perfect for triad in triads):
        return None
    return SensedTriad(triads, column)


def _pieces(index):
    """
    Return slices of samples with consecutive indices.

    Slices end where blocks of random numbers do, so that few blocks are computed twice.
    """
    pieces = []
    for run in consecutive(index):
        first = run.start
        while first < run.stop:
            end = min(run.stop, first + PIECE - int(index[first]) % PIECE)
            pieces.append(slice(first, end))
            first = end
    return pieces
