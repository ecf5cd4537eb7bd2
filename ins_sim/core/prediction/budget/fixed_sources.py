"""Errors that are the same in every run, by source: their means over the steps."""

from dataclasses import replace
import math

import numpy as np

from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.sensors.imu.triad_errors import discrete_lag, TriadErrors
from ins_sim.core.sensors.imu.triad_model import KEYS, triad_model
from ..late_turns import is_long, late_force, late_turns
from .sources import ACCELEROMETER, ErrorSource, FIXED_WORDS, GYRO, triad_source

LAG = 'bandwidth_hz'


class FixedSource:
    """A source and a function of TimeLanes that returns its means (steps, 3, n) in n."""

    def __init__(self, source, means):
        self.source, self.means = source, means


def fixed_sources(settings, motion):
    """Return the FixedSources of the instruments in SimulationSettings along a motion."""
    sensor, found = settings.imu_sensor, []
    for triad, errors, delays in (
            (ACCELEROMETER, sensor.accelerometer.errors, sensor.accelerometer.delay_us),
            (GYRO, sensor.gyro.errors, sensor.gyro.delay_us)):
        for key, (coefficient, _) in KEYS[type(errors)].items():
            if coefficient not in FIXED_WORDS or not any(getattr(errors, key)):
                continue
            source = triad_source(errors, triad, key, FIXED_WORDS[coefficient], True,
                                  coefficient == LAG)
            means = (_Lag(errors, triad, settings, motion) if coefficient == LAG else
                     _Immediate(errors, key, triad, sensor.temperature))
            found.append(FixedSource(source, means))
        values = delays.x, delays.y, delays.z
        if any(values):
            name = 'accelerometer' if triad == ACCELEROMETER else 'gyro'
            source = ErrorSource(f'{name}.delay_us', f'{name} delays', 'us', values,
                                 tuple(1e-6 * v for v in values), True, triad, 'delay')
            found.append(FixedSource(source, _Delay(settings, motion, triad)))
    return found


class _Immediate:
    """Errors that follow the input without lag, caused by one parameter."""

    def __init__(self, errors, key, triad, temperature):
        alone = replace(type(errors)(), **{key: getattr(errors, key)})
        self._triad = triad
        self._errors = TriadErrors(alone, 0, 0, '', 1.0, temperature)

    def __call__(self, lanes):
        force = lanes.truth.f_ib_b
        value = force if self._triad == ACCELEROMETER else lanes.truth.omega_ib_b
        return lanes.means_in_n(lanes.columns(
            self._errors.immediate(value, force, lanes.t_s.ravel())))


class _Lag:
    """
    Errors caused by lags, to second order in their time constants.

    With w = 2 pi f, the output falls short of the integral of the input u by x/w for a first-order
    lag, and by sqrt(2) x/w + x'/w^2 for a Butterworth lag (``discrete_lag``). The lag is driven by
    the mean of the input over each sampling period, so that after a steady rise of u its state x
    is u - L u', where L exceeds 1/w by about half a period, and x' = v u'. At the first sample the
    lag is settled: x is the first reading and x' = 0.
    """

    def __init__(self, errors, triad, settings, motion):
        dt_s = period_ns(settings.imu_sensor.rate_hz) * 1e-9
        self._first_ns = round(1e9 * settings.motion_generator.start_s)
        self._settled = _first_reading(settings.imu_sensor, motion, self._first_ns)[triad]
        model = triad_model(errors, dt_s, errors.NAME)
        first, second = np.zeros(3), np.zeros(3)
        for axis, frequency in enumerate(model.bandwidth_hz):
            if frequency:
                a, b, c, d, _, _ = discrete_lag(frequency, model.order, dt_s)
                behind = dt_s / (1.0 - a - b * c / (1.0 - d))
                per_w = 1.0 / (2.0 * math.pi * frequency)
                first[axis] = per_w if model.order == 1 else math.sqrt(2.0) * per_w
                second[axis] = (first[axis] * (behind - 0.5 * dt_s)
                                + per_w * per_w * c * behind / (1.0 - d))
        self._first, self._second, self._triad = first, second, triad

    def __call__(self, lanes):
        value = (lanes.truth.f_ib_b if self._triad == ACCELEROMETER else
                 lanes.truth.omega_ib_b)
        behind = self._first * value - self._second * lanes.slopes(value)
        behind[lanes.truth.t_ns == self._first_ns] = self._first * self._settled
        return lanes.late_means_in_n(behind)


def _first_reading(sensor, motion, first_ns):
    """Return the first mean specific force and rate, (3,); instant values on streamed truth."""
    if sensor.source == 'motion':
        imu = MotionImu(sensor, motion, first_ns).advance(1)
        return imu.f[0], imu.omega[0]
    truth = motion.at(np.array([first_ns], dtype=np.int64))
    return truth.f_ib_b[0], truth.omega_ib_b[0]


class _Delay:
    """Errors caused by delayed channels, computed as in ``core.prediction``."""

    def __init__(self, settings, motion, triad):
        sensor = settings.imu_sensor
        self._motion, self._triad = motion, triad
        self._tau_ns = (sensor.accelerometer if triad == ACCELEROMETER else
                        sensor.gyro).delay_us.in_ns()
        self._held_ns = None
        if sensor.history == 'frozen':
            self._held_ns = round(1e9 * settings.motion_generator.start_s)
        self._turns = late_turns(settings, motion)

    def __call__(self, lanes):
        truth = lanes.truth
        if self._triad == GYRO:
            return lanes.late_means_in_n(self._turns.at(truth))
        if is_long(self._tau_ns):
            return lanes.means_in_n(lanes.columns(late_force(
                self._motion, truth.t_ns, self._tau_ns, self._held_ns)))
        return lanes.late_means_in_n(np.array(self._tau_ns) * 1e-9 * truth.f_ib_b)
