"""Propagate a budget through a run in blocks of intervals."""

import math

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.error_dynamics import GROWING
from ins_sim.core.navigation.vertical_channel import damping
from ins_sim.core.numerics.fixed_order import length, product
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.triad_model import triad_model
from .accumulation import level_turn, NoiseErrors, START_AXES, start_columns
from .fixed_sources import fixed_sources
from .interval_responses import interval_responses
from .sources import (ACCELEROMETER, CONSTANTS, GYRO, processes, random_sources, start_errors,
                      start_sources)
from .time_lanes import TimeLanes

# Largest step, s; largest rotation in a step, rad; smallest number of steps in a period of the
# motion and in a time constant of a damped vertical channel.
STEP_S, STEP_RAD, PER_PERIOD = 0.05, 0.1, 20
# Largest interval, s, and largest total number of steps processed together.
INTERVAL_S, STEPS_AT_ONCE = 10.0, 100_000
# Number of instants at which the motion is searched for its fastest rotation.
LOOKS = 1000
# Columns of errors with a single value per run: unit initial errors, and the constant errors of
# accelerometers and gyros.
START, OF_TRIAD, FIXED = slice(0, 9), (slice(9, 18), slice(18, 27)), slice(27, None)


def navigation_start_s(settings):
    """Return the motion time at which the strapdown of SimulationSettings starts, s."""
    return settings.motion_generator.start_s + settings.strapdown.initial.after_s


def navigation_span_s(settings):
    """Return how long the strapdown navigates, s; ValueError if the run ends before its start."""
    after_s, duration_s = (settings.strapdown.initial.after_s,
                           settings.motion_generator.duration_s)
    if not duration_s - after_s > 0.0:
        raise ValueError(f'initial.after_s is {after_s:g} s; expected less than duration_s, '
                         f'{duration_s:g} s')
    return duration_s - after_s


class Propagation:
    """
    The propagation of the errors of SimulationSettings along a motion.

    t_s : instants since the start of the navigation, s, from 0 on

    Attributes
    ----------
    random, fixed : ErrorSources
    covariances, by_axis, means, lat : lists by instant, entries as in LinearBudget
    beyond : (2,) see LinearBudget

    """

    def __init__(self, settings, motion, t_s):
        self._settings, self._motion, self.t_s = settings, motion, t_s
        sensor, strapdown = settings.imu_sensor, settings.strapdown
        self._start_s = navigation_start_s(settings)
        self._rotation, vertical = strapdown.earth.rotation, strapdown.vertical
        self._held = vertical.channel == 'truth'
        self._damping = (damping(vertical.time_constant_s)[:2] if vertical.channel == 'damped'
                         else (0.0, 0.0))
        errors = sensor.accelerometer.errors, sensor.gyro.errors
        dt_s = period_ns(sensor.rate_hz) * 1e-9
        # Raises ValueError for values that no instrument can have.
        models = [triad_model(e, dt_s, e.NAME) for e in errors]
        self._most = [[s or math.inf for s in model.saturation] for model in models]
        self.random = [*random_sources(errors[GYRO], errors[ACCELEROMETER]),
                       *start_sources(strapdown.initial)]
        self._drivers = fixed_sources(settings, motion)
        self._given = start_errors(strapdown.initial)
        self.fixed = [*(driver.source for driver in self._drivers), *self._given]
        self._processes = [processes(self.random, triad, errors[triad])
                           for triad in (ACCELEROMETER, GYRO)]
        self._noise = [NoiseErrors(markov, self._start_s) for markov, _ in self._processes]
        self.covariances, self.by_axis, self.means, self.lat = [], [], [], []
        self.beyond, self._columns = np.zeros(2), None

    def blocks(self):
        """Propagate in blocks of intervals; yield the time at the end of each block."""
        edges, kept = self._edges()
        truth = self._motion.at(_nanoseconds(self._start_s + edges))
        self._keep_first(truth)
        steps = max(1, math.ceil(np.diff(edges).max() / self._step_s() - 1e-9))
        lanes_at_once = max(1, STEPS_AT_ONCE // steps)
        for first in range(0, len(edges) - 1, lanes_at_once):
            part = edges[first:first + lanes_at_once + 1]
            lanes = TimeLanes(self._motion, self._start_s + part, steps, self._rotation)
            self._judge_range(lanes, self.t_s[-1])
            responses = interval_responses(
                lanes, ellipsoid.rotation_rate(self._rotation), self._held, self._damping,
                self._processes, self._fixed_means(lanes))
            for lane, length_s in enumerate(np.diff(part).tolist()):
                self._advance(responses, lane, length_s)
                k = first + lane + 1
                if kept[k]:
                    self._keep(float(truth.lat[k]), float(truth.height[k]))
            yield float(part[-1])

    def _edges(self):
        """Return the ends of the intervals, s, and whether they are instants of the budget."""
        edges, kept = [self.t_s[:1]], [True]
        for start, end in zip(self.t_s[:-1].tolist(), self.t_s[1:].tolist()):
            parts = math.ceil((end - start) / INTERVAL_S - 1e-9)
            edges.append(start + (end - start) * np.arange(1, parts + 1) / parts)
            kept += [False] * (parts - 1) + [True]
        return np.concatenate(edges), kept

    def _step_s(self):
        """Return the largest step, s."""
        t_ns = _nanoseconds(self._start_s + self.t_s[-1] * np.arange(LOOKS + 1) / LOOKS)
        fastest = float(length(self._motion.at(t_ns).omega_ib_b).max())
        step_s = min(STEP_S, STEP_RAD / max(fastest, 1e-9))
        if self._motion.period_s:
            step_s = min(step_s, self._motion.period_s / PER_PERIOD)
        if self._damping[0]:
            step_s = min(step_s, 3.0 / self._damping[0] / PER_PERIOD)
        return step_s

    def _judge_range(self, lanes, span_s):
        truth, width = lanes.truth, len(lanes.h)
        for triad, values in ((ACCELEROMETER, truth.f_ib_b), (GYRO, truth.omega_ib_b)):
            over = (np.abs(values) > self._most[triad]).any(axis=1).reshape(-1, width)
            part = np.count_nonzero(over, axis=0) / len(over)
            self.beyond[triad] += float(np.add.accumulate(
                part * lanes.h * lanes.steps)[-1]) / span_s

    def _fixed_means(self, lanes):
        """Return the means (steps, 6, f, n) of the errors that are the same in every run."""
        found = np.zeros((lanes.steps, 6, len(self._drivers), len(lanes.h)))
        for k, driver in enumerate(self._drivers):
            rows = slice(0, 3) if driver.source.triad == ACCELEROMETER else slice(3, 6)
            found[:, rows, k] = driver.means(lanes)
        return found

    def _keep_first(self, truth):
        lat, height = float(truth.lat[0]), float(truth.height[0])
        self._columns = np.zeros((GROWING, FIXED.start + len(self._drivers)))
        self._columns[:, START] = start_columns(lat, height, self._held)
        self._keep(lat, height)

    def _advance(self, responses, lane, length_s):
        transition = responses.transition[..., lane]
        added = np.zeros_like(self._columns)
        for triad in (ACCELEROMETER, GYRO):
            added[:, OF_TRIAD[triad]] = responses.constants[triad][..., lane]
            self._noise[triad].advance(transition, responses.noise[triad],
                                       responses.constants[triad][:, 0:3, lane], length_s, lane)
        added[:, FIXED] = responses.fixed[..., lane]
        self._columns = product(transition, self._columns) + added

    def _keep(self, lat, height):
        """Store the covariances and means of all sources at an instant."""
        turn = level_turn(lat, height)
        columns = product(turn, self._columns)
        covariances = np.zeros((len(self.random), GROWING, GROWING))
        by_axis = np.zeros((len(self.random), 3, GROWING))
        for k, source in enumerate(self.random):
            for axis, p in enumerate(self._by_axis(source, columns, turn)):
                covariances[k] += p
                by_axis[k, axis] = p.diagonal()
        given = [_combined(columns, START_AXES[source.kind], source.si) for source in self._given]
        self.covariances.append(covariances)
        self.by_axis.append(by_axis)
        self.means.append(np.concatenate([columns[:, FIXED].T,
                                          np.reshape(given, (-1, GROWING))]))
        self.lat.append(lat)

    def _by_axis(self, source, columns, turn):
        """Yield the covariance for each axis of a random source, or for a source of the start."""
        if source.triad is None:
            x = columns[:, list(START_AXES[source.kind])] * source.si[0]
            yield product(x, x.T)
            return
        noise, (_, walks) = self._noise[source.triad], self._processes[source.triad]
        if source.kind in CONSTANTS:
            first = OF_TRIAD[source.triad].start + 3 * CONSTANTS.index(source.kind)
            for axis, value in enumerate(source.si):
                x = columns[:, first + axis] * value
                yield np.multiply.outer(x, x)
            return
        p = np.zeros((GROWING, GROWING, 3))
        if source.kind == 'white':
            p = noise.white
        for walk, per_s in walks:
            if walk is source:
                p = p + noise.walk * per_s
        if source in noise.sources:
            p = p + noise.markov[noise.sources.index(source)]
        for axis, value in enumerate(source.si):
            yield _turned(turn, p[..., axis]) * (value * value)


def _combined(columns, axes, values):
    """Return the sum of the initial-error columns times values, (9,)."""
    found = np.zeros(GROWING)
    for axis, value in zip(axes, values):
        found += columns[:, axis] * value
    return found


def _turned(turn, p):
    return product(product(turn, p), turn.T)


def _nanoseconds(t_s):
    return np.round(t_s * 1e9).astype(np.int64)
