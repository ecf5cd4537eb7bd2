"""A group of at most 16 runs, which go through the strapdown side by side."""

from dataclasses import replace

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation import whole_run
from ins_sim.core.navigation.navigator import CHANNELS, InertialNavigator
from ins_sim.core.navigation.vertical_channel import DAMPED, damping, NO_DAMPING
from ins_sim.core.numerics import compilation
from . import lanes
from .lanes import LANES

# Errors of a run: attitude, rad, velocity, m/s, and position, m, each East, North, Up.
ERRORS = 9
# Samples that are taken at once: their readings, of 16 runs, take 0.8 MB.
PIECE = 1024


class Group:
    """
    Runs with the same truth and ideal readings.

    settings: SimulationSettings; runs: their numbers, at most 16; initial: function of the number
    of a run that returns its Initial errors, or None for those of the settings; instruments: of
    each run what makes its readings of ImuSamples, or None.
    """

    def __init__(self, settings, runs, initial, instruments):
        strapdown = settings.strapdown
        self.runs, self._instruments = tuple(runs), instruments
        self._spin = ellipsoid.rotation_rate(strapdown.earth.rotation)
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
        """Take ideal samples before the start of the strapdown."""
        for instrument in self._instruments:
            if instrument is not None:
                instrument.advance(imu)

    def advance(self, imu, t_ns, truth, picked):
        """
        Take samples, the first of which starts the strapdown; return the errors at the picked ones.

        imu: ImuSamples of the ideal instrument; t_ns: their instants; truth: Truth then; picked:
        numbers of samples.  Errors (m, runs, ERRORS), NaN of a run that has diverged.
        """
        solved = [self._advance(imu[part], t_ns[part], truth[part],
                                picked[(picked >= part.start) & (picked < part.stop)] - part.start)
                  for part in _pieces(len(t_ns))]
        return self._judged(t_ns[picked], np.concatenate(solved), truth[picked])

    def _advance(self, imu, t_ns, truth, picked):
        readings = self._sense(imu)
        solved = np.empty((len(picked), whole_run.SOLVED, LANES))
        begun = 0
        if self._state is None:
            self._start(t_ns, readings, truth)
            begun = 1
            if len(picked) and picked[0] == 0:
                solved[0] = np.concatenate([self._state[0:6], self._state[19:23]])
        if len(t_ns) > begun:
            later = picked >= begun
            found = np.empty((int(later.sum()), whole_run.SOLVED, LANES))
            marks = np.append(picked[later] - begun, -1)
            inputs = (self._state, self._spin, self._start_ns, self._last_ns, self._channel,
                      self._damping, self._integrated, t_ns[begun:], readings[begun:],
                      truth.height[begun:], np.ascontiguousarray(truth.v_n[begun:, 2]), marks)
            state = compilation.run(lanes.advance, LANES * (len(t_ns) - begun), inputs, found)
            self._state = np.reshape(state, (lanes.NUMBERS, LANES))
            solved[later] = found
        self._last_ns = int(t_ns[-1])
        solved[:, :, self._lost] = np.nan
        self._set_aside()
        return solved

    def _sense(self, imu):
        """Return the readings (n, 6, LANES); lanes without a run have those of the first."""
        readings = np.empty((len(imu), 6, LANES))
        for lane in reversed(range(LANES)):
            instrument = self._instruments[lane if lane < len(self.runs) else 0]
            if lane >= len(self.runs) and instrument is not None:
                continue
            own = imu if instrument is None else instrument.advance(imu)
            readings[:, 0:3, lane], readings[:, 3:6, lane] = own.omega, own.f
        readings[:, :, len(self.runs):] = readings[:, :, 0:1]
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
        """Mark runs that have diverged; their lanes go on as copies of one that has not."""
        off = ~np.isfinite(self._state[:lanes.CARRIED]).all(axis=0)
        self._lost |= off
        if off.any() and not self._lost.all():
            self._state[:, off] = self._state[:, np.flatnonzero(~self._lost)[0], None]

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
        return judged[:, 4:].reshape(len(t_ns), count, ERRORS)

    def final(self, truth):
        """
        Return the solutions at the last sample and their errors, NaN of the lost.

        truth: Truth then.  Solutions (runs, SOLVED): lat, lon, height, v_n, q_ib.
        """
        solved = np.concatenate([self._state[0:6], self._state[19:23]])
        solved[:, self._lost] = np.nan
        errors = self._judged(np.array([self._last_ns]), solved[None], truth)
        return solved.T[:len(self.runs)], errors[0]


def _pieces(count):
    return [slice(first, min(first + PIECE, count)) for first in range(0, count, PIECE)]
