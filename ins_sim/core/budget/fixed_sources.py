"""What errs in the same way in every run, source by source: its means over the steps."""

from dataclasses import replace
import math

import numpy as np

from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.prediction.late_turns import is_long, late_force, late_turns
from ins_sim.core.sensors.imu.triad_errors import TriadErrors
from ins_sim.core.sensors.imu.triad_model import KEYS, triad_model
from .sources import ACCELEROMETER, ErrorSource, FIXED_WORDS, GYRO, triad_source

LAG = 'bandwidth_hz'


class FixedSource:
    """A source and, by TimeLanes, its means (steps, 3, n) in n."""

    def __init__(self, source, means):
        self.source, self.means = source, means


def fixed_sources(settings, motion):
    """Return the FixedSources of the instruments of SimulationSettings along a motion."""
    sensor, found = settings.imu_sensor, []
    for triad, errors, delays in (
            (ACCELEROMETER, sensor.accelerometer.errors, sensor.accelerometer.delay_us),
            (GYRO, sensor.gyro.errors, sensor.gyro.delay_us)):
        for key, (coefficient, _) in KEYS[type(errors)].items():
            if coefficient not in FIXED_WORDS or not any(getattr(errors, key)):
                continue
            source = triad_source(errors, triad, key, FIXED_WORDS[coefficient], True,
                                  coefficient == LAG)
            means = (_Lag(errors, triad, sensor) if coefficient == LAG else
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
    """Errors that follow the input at once, those of one parameter."""

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
    Errors of lags, to second order in their time constants.

    What a lag has not put out yet of the integral of its input u is tau u - u'/w^2, w = 2 pi f,
    with tau = 1/w of first order and sqrt(2)/w of a Butterworth lag of second order.
    """

    def __init__(self, errors, triad, sensor):
        model = triad_model(errors, period_ns(sensor.rate_hz) * 1e-9)
        per_w = np.array([1.0 / (2.0 * math.pi * f) if f else 0.0 for f in model.bandwidth_hz])
        self._tau = per_w if model.order == 1 else math.sqrt(2.0) * per_w
        self._square, self._triad = per_w * per_w, triad

    def __call__(self, lanes):
        value = (lanes.truth.f_ib_b if self._triad == ACCELEROMETER else
                 lanes.truth.omega_ib_b)
        return lanes.late_means_in_n(self._tau * value - self._square * lanes.slopes(value))


class _Delay:
    """Errors of late channels, as ``core.prediction`` has them."""

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
