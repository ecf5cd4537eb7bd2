"""
Parity test of the four gyro channels: detects that one of them has failed.

The parity has unit gain for every channel that it sees, so its standard deviation is that of one
channel. The limit for its mean over a window has two parts. The first is five standard deviations
of noise, biases, scale factors, misalignment and force-dependent drifts at the present rate and
specific force. The second is the effect of the motion itself: one gyro senses the common axis as y
and the other as z, and the two differ by the cross-coupling of angular acceleration and by the
product of rates (docs/theory/tuned_gyro.md, Parity test).
"""

import math

import numpy as np

from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import magnitude
from ins_sim.core.numerics.units import DEG_H, STANDARD_GRAVITY
from ..imu.triad_model import temperature_off, triad_model

SIGMAS = 5.0
# Bound of the rounding error of the parity at rates of some rad/s, rad/s.
ROUNDING = 1e-12
# Frequencies at which the cross-coupling is evaluated, rad/s.
BAND = elementary.exp(elementary.log(10.0) * np.linspace(-2.0, 2.0, 41))


def _size(*terms):
    """Return the root of the sum of squares of the terms."""
    total = 0.0
    for term in terms:
        total += term * term
    return math.sqrt(total)


def _most(*rows):
    """Return the largest root sum square over the axes; each row holds one term by axis."""
    return max(_size(*column) for column in zip(*rows))


def _length(v):
    """Return the length of a vector of floats or arrays."""
    x, y, z = v
    return elementary.sqrt(x * x + y * y + z * z)


def terms(last, omega, f, parity):
    """
    Return the five terms that a window sums.

    They are the parity, the size of the rate, its square, the size of the specific force, and the
    size of the change of the rate. Arguments are floats or arrays.

    Parameters
    ----------
    last, omega : rates of the reading before and of this one, rad/s
    f : specific force, m/s^2
    parity : rad/s
    """
    w = _length(omega)
    change = omega[0] - last[0], omega[1] - last[1], omega[2] - last[2]
    return parity, w, w * w, _length(f), _length(change)


def add(sums, more):
    """Return the sums of two sets of five terms."""
    a, b, c, d, e = sums
    f, g, h, i, j = more
    return a + f, b + g, c + h, d + i, e + j


class ParityTest:
    """
    The mean parity of each window and its limit.

    Parameters
    ----------
    settings : ImuSensorSettings with tuned gyros
    instrument : PairInstrument of these settings

    Attributes
    ----------
    count : number of readings in a window
    mean, threshold : mean parity of the last window and its limit, rad/s; 0 and infinity before
        the first window ends
    exceeded : whether the mean is beyond the limit
    """

    def __init__(self, settings, instrument):
        self.expect(settings, instrument)
        self.reset()

    def expect(self, settings, instrument):
        """Compute the expected spread of the parity for these settings."""
        gyro, errors = settings.gyro, settings.gyro.dtg.errors
        model = triad_model(gyro.errors, instrument.dt_s, 'gyro.errors')
        self._fixed = gyro.dtg.parity.threshold_deg_h * DEG_H
        self.count = max(1, round(gyro.dtg.parity.window_s / instrument.dt_s))
        self._dt_s, self._temperature = instrument.dt_s, settings.temperature
        p = instrument.pair.gyros[0].parameters
        offset = max(map(abs, errors.pickoff_offset_urad)) * 1e-6 * _size(
            p.stiffness(p.speed_hz), p.rotating_damping_n_m_s * p.omega) / (
                p.input_inertia * p.omega)
        shaken = max(map(abs, errors.vibration_2n_deg_s))
        shaken = math.radians(shaken) * abs(p.vibration_2n_factor) if shaken else 0.0
        self._bias = _size(
            _most(model.bias, model.turn_on_sigma, model.gauss_markov_sigma, model.flicker,
                  [60.0 * k for k in model.walk]), offset, shaken)
        axes = _size(*model.misalignment, *model.misalignment_sigma, *model.non_orthogonality)
        speeds = 1e-6 * max(map(abs, (*errors.speed_ppm, *errors.hunting_ppm)))
        self._scale = _size(_most(model.scale, model.scale_sigma, model.asymmetry), axes, speeds)
        self._cubic = max(map(abs, model.cubic))
        self._warm = max(map(abs, model.temperature_bias)), max(map(abs, model.temperature_scale))
        per_g = DEG_H / STANDARD_GRAVITY
        self._by_force = _size(
            _most(model.g_linear), per_g * _most(
                errors.mass_unbalance_deg_h_g, errors.quadrature_unbalance_deg_h_g,
                errors.spin_axis_deg_h_g))
        self._by_force_2 = _size(_most(model.g_quadratic), per_g / STANDARD_GRAVITY * _most(
            errors.anisoelastic_deg_h_g2))
        self._white = instrument.parity_variance(self.count)
        crosses = [rotor.space.axis_responses(BAND)[1] for rotor in instrument.pair.gyros]
        self._coupling_s = max(float((magnitude(cross) / BAND).max()) for cross in crosses)
        self._product_s = abs(errors.spin_rate_product) * abs(
            p.input_inertia - p.transverse_inertia) / (p.input_inertia * p.omega)

    def reset(self):
        """Begin a new first window."""
        self.mean, self.threshold, self.exceeded = 0.0, math.inf, False
        self._last = None
        self._sums = (0,) + (0.0,) * 5

    def push(self, t_ns, omega, f, parity):
        """
        Process one reading and return whether it completes a window.

        Parameters
        ----------
        t_ns : motion time, ns
        omega : rates, rad/s
        f : specific force, m/s^2
        parity : rad/s
        """
        (n, *sums), last = self._sums, self._last or omega
        self._last = omega
        n, sums = n + 1, add(sums, terms(last, omega, f, parity))
        self._sums = n, *sums
        if n < self.count:
            return False
        self.mean, self.threshold = sums[0] / n, self._limit(t_ns * 1e-9, *sums[1:])
        self.exceeded = abs(self.mean) > self.threshold
        self._sums = (0,) + (0.0,) * 5
        return True

    def windows(self, imu):
        """
        Return the windows of a run, (n, 3): mean, threshold, and 1 if it is exceeded.

        Parameters
        ----------
        imu : ImuSamples with parity; the first window begins at its first reading
        """
        last = np.concatenate([imu.omega[:1], imu.omega[:-1]])
        columns = terms(last.T, imu.omega.T, imu.f.T, imu.parity)
        whole, sums = len(imu) // self.count, (0.0,) * 5
        rows = [v[:whole * self.count].reshape(whole, self.count).T for v in columns]
        for sample in zip(*rows):
            sums = add(sums, sample)
        ends = imu.t_ns[self.count - 1::self.count].tolist()
        limits = np.array([self._limit(t_ns * 1e-9, *row) for t_ns, row in zip(
            ends, np.column_stack(sums[1:]).tolist())])
        mean = sums[0] / self.count
        return np.column_stack((mean, limits, np.abs(mean) > limits))

    def _limit(self, t_s, w, w_2, force, change):
        """Return the threshold of a window ending at t_s, from the sums of its ``terms``."""
        if self._fixed:
            return self._fixed
        n = self.count
        w, w_2, force = w / n, w_2 / n, force / n
        warm = abs(temperature_off(self._temperature, t_s))
        spread = _size(
            math.sqrt(self._white), self._bias, self._warm[0] * warm,
            (self._scale + self._warm[1] * warm + self._cubic * w_2) * w,
            (self._by_force + self._by_force_2 * force) * force)
        moved = self._coupling_s * change / (n * self._dt_s) + self._product_s * w_2
        return ROUNDING + SIGMAS * spread + moved

    def row(self, parity):
        """Return parity, mean, threshold (0 before the first) as published with a reading."""
        return parity, self.mean, self.threshold if math.isfinite(self.threshold) else 0.0


def parity_rows(settings, instrument, imu):
    """Return ``ParityTest.row`` for each reading of a run, (n, 3); imu: ImuSamples with parity."""
    test = ParityTest(settings, instrument)
    found = np.zeros((len(imu), 3))
    found[:, 0] = imu.parity
    # The reading that completes a window already carries the values of that window.
    windows = np.repeat(test.windows(imu)[:, :2], test.count, axis=0)
    found[test.count - 1:, 1:] = windows[:len(found) - test.count + 1]
    return found


def parity_windows(settings, instrument, imu):
    """
    Return the windows of a run, (n, 4): end (s), mean, threshold (rad/s), and 1 if exceeded.

    imu: ImuSamples with parity.
    """
    test = ParityTest(settings, instrument)
    return np.column_stack((imu.t_ns[test.count - 1::test.count] * 1e-9, test.windows(imu)))
