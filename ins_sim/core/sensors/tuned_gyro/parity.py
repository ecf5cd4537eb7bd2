"""
Parity test of the four gyro channels: detect that one of them has failed.

The parity has unit gain for every channel that it sees, so that its spread is that of one
channel. The limit for its mean over a window is five standard deviations of noise, biases, scale
factors, misalignment and drifts due to specific force, at the present rate and force, plus the
effect of the motion itself: the two gyros see an axis as y and as z, and differ by the
cross-coupling of angular acceleration and by the product of rates (docs/theory.md, "Dynamically
tuned gyro", Parity test).
"""

import math

import numpy as np

from ins_sim.core.numerics.units import DEG_H, STANDARD_GRAVITY
from ..imu.triad_model import temperature_off, triad_model

SIGMAS = 5.0
# what rounding may leave of rates of some rad/s, rad/s
ROUNDING = 1e-12
# where the cross-coupling is looked for, rad/s
BAND = np.geomspace(1e-2, 1e2, 41)


def _most(*rows):
    """Return the largest over the axes of the root of the sum of squares of terms by axis."""
    return max(math.hypot(*column) for column in zip(*rows))


class ParityTest:
    """
    Window by window, the mean parity and what it may be.

    settings: ImuSensorSettings with tuned gyros; instrument: their PairInstrument.  After each
    window ``mean`` and ``threshold``, rad/s, are those of the last one, and ``exceeded`` says
    whether the one is beyond the other; before the first they are 0, infinite and False.
    """

    def __init__(self, settings, instrument):
        gyro, errors = settings.gyro, settings.gyro.dtg.errors
        model = triad_model(gyro.errors, instrument.dt_s, 'gyro.errors')
        self._fixed = gyro.dtg.parity.threshold_deg_h * DEG_H
        self._count = max(1, round(gyro.dtg.parity.window_s / instrument.dt_s))
        self._dt_s, self._temperature = instrument.dt_s, settings.temperature
        p = instrument.pair.gyros[0].parameters
        offset = max(map(abs, errors.pickoff_offset_urad)) * 1e-6 * abs(complex(
            p.stiffness(p.speed_hz), p.rotating_damping_n_m_s * p.omega)) / (
                p.input_inertia * p.omega)
        shaken = max(map(abs, errors.vibration_2n_deg_s))
        shaken = math.radians(shaken) * abs(p.vibration_2n_factor) if shaken else 0.0
        self._bias = math.hypot(
            _most(model.bias, model.turn_on_sigma, model.gauss_markov_sigma, model.flicker,
                  [60.0 * k for k in model.walk]), offset, shaken)
        axes = math.hypot(*model.misalignment, *model.misalignment_sigma,
                          *model.non_orthogonality)
        speeds = 1e-6 * max(map(abs, (*errors.speed_ppm, *errors.hunting_ppm)))
        self._scale = math.hypot(_most(model.scale, model.scale_sigma, model.asymmetry), axes,
                                 speeds)
        self._cubic = max(map(abs, model.cubic))
        self._warm = max(map(abs, model.temperature_bias)), max(map(abs, model.temperature_scale))
        per_g = DEG_H / STANDARD_GRAVITY
        self._by_force = math.hypot(
            _most(model.g_linear), per_g * _most(
                errors.mass_unbalance_deg_h_g, errors.quadrature_unbalance_deg_h_g,
                errors.spin_axis_deg_h_g))
        self._by_force_2 = math.hypot(_most(model.g_quadratic), per_g / STANDARD_GRAVITY * _most(
            errors.anisoelastic_deg_h_g2))
        self._white = instrument.parity_variance(self._count)
        self._coupling_s = max(float((np.abs(rotor.space.axis_responses(BAND)[1]) / BAND).max())
                               for rotor in instrument.pair.gyros)
        self._product_s = abs(errors.spin_rate_product) * abs(
            p.input_inertia - p.transverse_inertia) / (p.input_inertia * p.omega)
        self.reset()

    def reset(self):
        """Begin anew."""
        self.mean, self.threshold, self.exceeded = 0.0, math.inf, False
        self._last = None
        self._sums = (0,) + (0.0,) * 5

    def push(self, t_ns, omega, f, parity):
        """
        Take a reading: rates, rad/s, specific force, m/s^2, and parity, rad/s.

        Return whether it completes a window.
        """
        last = self._last or omega
        self._last = omega
        turn = math.hypot(omega[0] - last[0], omega[1] - last[1], omega[2] - last[2])
        w, force = math.hypot(*omega), math.hypot(*f)
        n, total, w_1, w_2, force_1, change = self._sums
        n += 1
        self._sums = n, total + parity, w_1 + w, w_2 + w * w, force_1 + force, change + turn
        if n < self._count:
            return False
        self._judge(t_ns * 1e-9)
        self._sums = (0,) + (0.0,) * 5
        return True

    def _judge(self, t_s):
        n, total, w, w_2, force, change = self._sums
        w, w_2, force = w / n, w_2 / n, force / n
        self.mean = total / n
        self.threshold = self._fixed
        if not self._fixed:
            warm = abs(temperature_off(self._temperature, t_s))
            spread = math.hypot(
                math.sqrt(self._white), self._bias, self._warm[0] * warm,
                (self._scale + self._warm[1] * warm + self._cubic * w_2) * w,
                (self._by_force + self._by_force_2 * force) * force)
            moved = self._coupling_s * change / (n * self._dt_s) + self._product_s * w_2
            self.threshold = ROUNDING + SIGMAS * spread + moved
        self.exceeded = abs(self.mean) > self.threshold

    def row(self, parity):
        """Return what a reading is published with: parity, mean, threshold (0 = none yet)."""
        return parity, self.mean, self.threshold if math.isfinite(self.threshold) else 0.0


def parity_rows(settings, instrument, imu):
    """Return ``ParityTest.row`` of each reading of a run, (n, 3); imu: ImuSamples with parity."""
    test, found = ParityTest(settings, instrument), []
    for sample in zip(imu.t_ns.tolist(), imu.omega.tolist(), imu.f.tolist(), imu.parity.tolist()):
        test.push(*sample)
        found.append(test.row(sample[3]))
    return np.array(found)


def parity_windows(settings, instrument, imu):
    """
    Return the windows of a run, (n, 4): end, s, mean, threshold, rad/s, and 1 where it exceeds.

    imu: ImuSamples with parity.
    """
    test, rows = ParityTest(settings, instrument), []
    for t_ns, *sample in zip(imu.t_ns.tolist(), imu.omega.tolist(), imu.f.tolist(),
                             imu.parity.tolist()):
        if test.push(t_ns, *sample):
            rows.append((t_ns * 1e-9, test.mean, test.threshold, test.exceeded))
    return np.array(rows, dtype=float).reshape(-1, 4)
