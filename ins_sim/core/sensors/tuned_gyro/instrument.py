"""
The two tuned gyros of an IMU with their errors: body rates in, body rates and parity out.

The signal passes through: disturbances of the rotors (moments due to specific force, the product
of rates, hunting, vibration at twice the speed) and of their pick-offs; the rotors; an injected
fault; the read-out of each gyro, with the errors of a triad along (spin axis, y, z) of its case,
where the spin axis serves the misalignment only; and the combination of the four channels. See
docs/theory/tuned_gyro.md, Errors of the rotors and of the read-out (model of IEEE Std 813).
"""

from dataclasses import fields, replace
import math

import numpy as np

from ins_sim.core.numerics.fixed_order import product
from ins_sim.core.numerics.instants import period_ns, seconds
from ins_sim.core.numerics.units import DEG_H
from ins_sim.core.streams.faults import StreamFault
from ins_sim.settings.instrument_errors import GyroErrors
from ins_sim.settings.tuned_gyro import TunedGyroErrors
from ..imu.triad_model import noise_variance, reported_variance, triad_model
from .pair import GyroPair, spins, with_faults
from .rotor import PRESETS, TunedGyroParameters

# Body axes of (spin, y, z) of each case; cyclic, so that rotation vectors keep their meaning.
CASES = ((2, 0, 1), (1, 2, 0))
NAMES = ('gyro.errors.gyro_1', 'gyro.errors.gyro_2')


def rotor_parameters(dtg):
    """
    Return the TunedGyroParameters that TunedGyroPairSettings describe.

    Raises ValueError if the parameters of preset custom are physically impossible.
    """
    if dtg.preset != 'custom':
        return PRESETS[dtg.preset]
    values = {f.name: getattr(dtg.custom, f.name) for f in fields(dtg.custom)}
    values['hinge_stiffness_n_m_rad'] = values['hinge_stiffness_n_m_rad'] or None
    try:
        return TunedGyroParameters(**values)
    except ValueError as error:
        raise ValueError(f'gyro.dtg.custom.{error}') from None


def make_pair(gyro, dt_s):
    """Return the GyroPair of settings.Gyro; of the errors only the rotor speeds are applied."""
    dtg = gyro.dtg
    p = rotor_parameters(dtg)
    pair = GyroPair(p, dt_s, dtg.arrangement, method=dtg.method, hold=dtg.hold,
                    on_unstable=dtg.on_unstable)
    for rotor, ppm in zip(pair.gyros, dtg.errors.speed_ppm):
        if ppm:
            rotor.set_speed(p.speed_hz * (1.0 + 1e-6 * ppm))
    return pair


def case_errors(errors, axes):
    """Return GyroErrors given by body axis as errors along (spin, y, z) of a case."""
    values = {}
    for f in fields(GyroErrors):
        value = getattr(errors, f.name)
        # Non-orthogonality belongs to pairs of axes, with the first axis as reference.
        if isinstance(value, tuple) and f.name != 'non_orthogonality_mrad':
            value = tuple(value[k] for k in axes)
        values[f.name] = value
    return GyroErrors(**values)


def total_of(parts):
    """Return the sum of floats or arrays, added in their order."""
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


def mean_rate(rates):
    """Return the mean of the body rates at the nodes of a period, rad/s, by Simpson's rule."""
    firsts = range(0, len(rates) - 1, 2)
    return tuple([total_of([rates[k][i] + 4.0 * rates[k + 1][i] + rates[k + 2][i]
                            for k in firsts]) / (6.0 * len(firsts)) for i in range(3)])


def _run_away(t_ns):
    return StreamFault(f'the rotors of the gyros have diverged at {seconds(t_ns)}; expected a '
                       'stable gyro', restart=True)


class PairInstrument:
    """
    The tuned gyros of ImuSensorSettings; raises ValueError for impossible settings.

    ``nodes`` are the instants, as fractions of a sampling period, at which ``step`` needs the body
    rate. Random errors are functions of seed, run and instant; rotors, lags, pulses and pick-offs
    carry states from sample to sample.
    """

    def __init__(self, settings):
        self._dt_ns = period_ns(settings.rate_hz)
        self.dt_s = self._dt_ns * 1e-9
        dtg = settings.gyro.dtg
        self._steps = dtg.steps_per_sample
        self.pair = make_pair(settings.gyro, self.dt_s / self._steps)
        self.nodes = tuple(0.5 * k / self._steps for k in range(2 * self._steps + 1))
        self._disturbances = None
        errors = dtg.errors
        perfect = TunedGyroErrors()
        if replace(errors, speed_ppm=(0.0, 0.0), hunting_hz=perfect.hunting_hz) != perfect:
            from .pair_errors import RotorErrors
            self._disturbances = RotorErrors(errors, self.pair, settings.seed, settings.run,
                                             self.dt_s)
        self._read_errors(settings)
        self._schedule_fault(dtg.fault)

    def _read_errors(self, settings):
        """Build the errors of the read-out from the settings."""
        self._read_out = None
        # First by body axis, so that a message about an axis names the axis of the settings.
        self._reported = triad_model(settings.gyro.errors, self.dt_s,
                                     'gyro.errors').reported_sigma
        self._models = tuple(triad_model(case_errors(settings.gyro.errors, axes), self.dt_s,
                                         'gyro.errors') for axes in CASES)
        if settings.gyro.errors != GyroErrors():
            from ..imu.triad_errors import TriadErrors
            self._read_out = tuple(
                TriadErrors(case_errors(settings.gyro.errors, axes), settings.seed, settings.run,
                            name, self.dt_s, settings.temperature)
                for axes, name in zip(CASES, NAMES))

    def change(self, settings):
        """
        Use the biases and the fault of other ImuSensorSettings from the next step on.

        States are kept. A forced fault stays forced unless the times of the fault change too.
        """
        before = self._read_out
        self._read_errors(settings)
        for new, old in zip(self._read_out or (), before or ()):
            new.state = old.state
        on, forced, times = self.pair.faults is not None, not self._scheduled, self._fault_ns
        self._schedule_fault(settings.gyro.dtg.fault)
        if forced and self._fault_ns == times:
            self._scheduled = False
        self._set_fault(on and not self._scheduled and self._fault is not None)

    def _schedule_fault(self, fault):
        self._fault = None
        self._fault_ns = (round(fault.start_s * 1e9), round(fault.end_s * 1e9))
        self._scheduled = fault.start_s >= 0.0
        if fault.channel != 'none':
            self._fault = (fault.channel, fault.bias_deg_h * DEG_H, fault.scale)

    @property
    def has_fault(self):
        """Return whether a fault is set up, by ``gyro.dtg.fault.channel``."""
        return self._fault is not None

    def force_fault(self, on):
        """Switch the fault of the settings on or off now, whatever its schedule says."""
        self._scheduled = False
        self._set_fault(on)

    def _keep_schedule(self, t_ns):
        if self._fault is not None and self._scheduled:
            start, end = self._fault_ns
            self._set_fault(start <= t_ns < end)

    def _set_fault(self, on):
        self.pair.clear_faults()
        if on:
            self.pair.inject(*self._fault)

    def settle(self, w):
        """Set the rotors to the steady state at the constant body rate w, rad/s."""
        self.pair.settle(w)
        if self._disturbances is not None:
            self._disturbances.settle(w)

    def first(self, t_ns, w, force):
        """Return body rates and parity at the instant t_ns for rotors in steady state."""
        self._keep_schedule(t_ns)
        return self._finish(t_ns, self.pair.instant(w), w, force)

    def step(self, t_ns, rates, force):
        """
        Return mean body rates and parity, rad/s, of the interval that ends at t_ns.

        rates: body rates at ``nodes``, rad/s; force: mean specific force in b, m/s^2. Raises
        StreamFault if the rotors diverge, which needs an unstable gyro.
        """
        self._keep_schedule(t_ns)
        channels, disturbances, added = self.pair.channels, self._disturbances, None
        if disturbances is not None:
            disturbances.begin(t_ns, force)
        parts = []
        for k in range(0, 2 * self._steps, 2):
            three = rates[k:k + 3]
            if disturbances is not None:
                added = disturbances.step(*three)
            parts.append(channels(*three, added))
        y = parts[0]
        if self._steps > 1:
            y = tuple([total_of(p) / self._steps for p in zip(*parts)])
        if not all(map(math.isfinite, y)):
            raise _run_away(t_ns)
        return self._finish(t_ns, y, None if self._read_out is None else mean_rate(rates), force)

    def advance(self, t_ns, rates, force):
        """
        Return the rates (n, 3) and parity (n,), rad/s, of the intervals ending at t_ns, and None.

        rates (m, nodes, 3) and force (m, 3) are as in ``step``, and so are the bits of the result,
        for blocks of any length. If the rotors diverge, the third value is a StreamFault and n
        counts the intervals before it; otherwise n is m.
        """
        steps, disturbances, fault = self._steps, (None, None), None
        start, middle, end = (rates[:, k:k + 2 * steps - 1:2].reshape(-1, 3).T for k in range(3))
        if self._disturbances is not None:
            disturbances = self._disturbances.block(t_ns, force.T, start, middle, end)
        y = np.reshape(self.pair.run(start, middle, end, disturbances), (4, -1, steps))
        finite = np.isfinite(y).all(axis=(0, 2))
        if not finite.all():
            count = int(finite.argmin())
            fault = _run_away(int(t_ns[count]))
            t_ns, rates, force, y = t_ns[:count], rates[:count], force[:count], y[:, :count]
        if not len(t_ns):
            return np.empty((0, 3)), np.empty(0), fault
        y = [total_of(c.T) / steps for c in self._faulty(t_ns, y)]
        if self._read_out is not None:
            first, t_s = int(t_ns[0]) // self._dt_ns, t_ns * 1e-9
            inputs = self._read_out_inputs(y, mean_rate(np.moveaxis(rates, 0, -1)), force.T)
            (_, *one), (_, *two) = (
                errors.advance(first, np.column_stack(w), np.column_stack(f), t_s).T
                for errors, (w, f) in zip(self._read_out, inputs))
            y = *one, *two
        omega, parity = self.pair.combine(y)
        return np.column_stack(omega), parity, fault

    def _faulty(self, t_ns, y):
        """Return the channels (n, steps) of a block, with the fault applied while it is on."""
        if self._fault is None or not self._scheduled:
            return with_faults(self.pair.faults, y)
        start, end = self._fault_ns
        on = (start <= t_ns) & (t_ns < end)
        self._set_fault(True)
        faulty = with_faults(self.pair.faults, y)
        self._set_fault(bool(on[-1]))
        return [np.where(on[:, None], a, b) for a, b in zip(faulty, y)]

    def _finish(self, t_ns, y, w, force):
        """Return body rates and parity of the four channels y, after their read-outs."""
        if self._read_out is not None:
            index, t_s = t_ns // self._dt_ns, t_ns * 1e-9
            (_, a, b), (_, c, d) = [
                errors.step(index, *inputs, t_s)
                for errors, inputs in zip(self._read_out, self._read_out_inputs(y, w, force))]
            y = a, b, c, d
        return self.pair.combine(y)

    def _read_out_inputs(self, y, w, force):
        """Return rate and specific force along (spin, y, z) of both cases, floats or arrays."""
        (s, t), (u, v), (f, g, h, i) = spins(w), spins(force), self.pair.into_cases(force)
        return ((s, y[0], y[1]), (u, f, g)), ((t, y[2], y[3]), (v, h, i))

    def channel_variances(self, count=1):
        """
        Return the variances of the mean of count samples of each channel, (rad/s)^2.

        Pulses and pick-off noise are errors of the angle: in a mean only those at its first and
        last instant remain.
        """
        found = []
        for model in self._models:
            found.extend(noise_variance(model, count * self.dt_s)[1:])
        if self._disturbances is not None:
            found = [a + b / (count * count)
                     for a, b in zip(found, self._disturbances.noise_variances())]
        return tuple(found)

    def _through(self, out, count=1):
        """Return the variances of out(combination), propagated from those of the channels."""
        gains = [out(self.pair.combine(row)) for row in np.eye(4).tolist()]
        variances = np.array(self.channel_variances(count))[:, None]
        return product(np.square(gains).T, variances)[:, 0].tolist()

    @property
    def variances(self):
        """Variances to publish with a sample, by body axis, (rad/s)^2."""
        return reported_variance(self._through(lambda read: read[0]), self._reported)

    def parity_variance(self, count=1):
        """Return the noise variance of the mean of count parities, (rad/s)^2."""
        return self._through(lambda read: (read[1],), count)[0]
