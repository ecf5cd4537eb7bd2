"""
Mode ``signal`` of the velocity meter: the field at three antennas and its correlation functions.

A frozen random field, complex and Gaussian, moves past the phase centres r_i with the velocity v
in the plane of motion. Lengths are in units of the correlation length L = lambda/(4 pi
sigma_theta) of each axis, and the field itself decays over the time T_d. Signals i and j with a
time difference t then have the correlation::

    R_ij(t) = exp(-|r_i - r_j - v t|^2/2 - t^2/(2 T_d^2))
            = G_ij exp(-w^2 (t - t_i + t_j)^2/2),   w^2 = |v|^2 + 1/T_d^2,  t_i = r_i.v/w^2
    G_ij = exp(-(p_i - p_j)^2/2 - (t_i - t_j)^2 w^2/(2 |v|^2 T_d^2)),  p_i: component across v

Signal i is therefore a mixture, by a matrix factor of G, of three independent processes with the
same spectrum, advanced by t_i (docs/theory/velocity_meter.md, Signals).

The last bits of Fourier transforms and of products of complex arrays depend on the processor, so
the fixes of this mode are reproducible on one machine only.
"""

import math
from typing import NamedTuple

from numpy import fft
import numpy as np

from ins_sim.core.numerics.elementary import exp, sincos
from ins_sim.core.numerics.noise import indexed_noise
from ins_sim.core.timeseries.fixes import VALID
from .antennas import antenna_geometry
from .reading import PAIRS, read_correlations, Reading, secant

# Standard deviations at which the spectrum is cut off and the delays are separated.
SIGMAS = 5.0
# Added to the diagonal of G, which is singular if one antenna follows in the track of another.
JITTER = 1e-9
LN_10 = 2.302585092994046
# Largest number of modes; a cycle then takes 0.3 s and 100 MB.
MOST_MODES = 1 << 20


def power_of_two(n):
    """Return the smallest power of two that is at least n."""
    return 1 << (n - 1).bit_length()


class Shape(NamedTuple):
    """The field at the antennas: leads t_i, s, (3,), rate w, 1/s, and mixture G, (3, 3)."""

    leads: np.ndarray
    rate: float
    mixture: np.ndarray


class Field:
    """
    The signals of the three antennas in one navigation cycle.

    A signal has ``length`` samples, one per lag: those of the cycle and, for the later antenna of
    a pair, one more for each further lag of the correlator.

    Parameters
    ----------
    settings : VelocityMeterSettings; ValueError if a cycle needs more than MOST_MODES modes
    """

    def __init__(self, settings):
        beam, signal, limits = settings.beam, settings.signal, settings.limits
        self._geometry = antenna_geometry(settings.antennas)
        self._lengths = tuple(beam.wavelength_m / (4.0 * math.pi * sigma) for sigma in
                              (beam.sigma_theta_x_rad, beam.sigma_theta_z_rad))
        self._decay = 1.0 / signal.decay_time_s if signal.decay_time_s else 0.0
        self._noise = exp(-0.05 * LN_10 * signal.snr_db) / math.sqrt(2.0)
        self.lag_s = settings.lag_s
        self.length = settings.samples + signal.lags - 1
        # One period of the synthesis holds the samples and the longest correlation.
        reach = (2.0 * self._geometry.kappa * self._geometry.x0
                 + SIGMAS * max(self._lengths)) / limits.speed_min_m_s
        self._period = power_of_two(self.length + math.ceil(reach / self.lag_s))
        # The fastest measurable motion has the greatest forward speed and 45 deg of sideslip.
        across = math.sqrt(2.0) * limits.speed_max_m_s / min(self._lengths)
        fastest = math.sqrt(across * across + self._decay * self._decay)
        bands = math.ceil(2.0 * SIGMAS * fastest * self.lag_s / (2.0 * math.pi))
        if bands * self._period > MOST_MODES:
            raise ValueError(f'signal.prf_hz is {signal.prf_hz:g} Hz with '
                             f'signal.pulses_per_lag {signal.pulses_per_lag}: a cycle needs '
                             f'{bands * self._period} modes of the field; expected at most '
                             f'{MOST_MODES}')
        modes = np.arange(bands * self._period) - bands * self._period // 2
        self._place = modes[:self._period] % self._period
        self._omega = 2.0 * np.pi / (self._period * self.lag_s) * modes
        self.width = 6 * (len(modes) + self.length)

    def shape(self, speed, v_z, tan_alpha):
        """
        Return the Shape at a velocity.

        Parameters
        ----------
        speed : along the trace of X1 in the plane of motion, m/s
        v_z : velocity along Z1, m/s
        tan_alpha : tangent of the true angle of attack, which shortens X0 to X0 cos(alpha) in the
            plane of motion
        """
        g, (l_x, l_z) = self._geometry, self._lengths
        x0 = g.kappa * g.x0 / secant(tan_alpha)
        centres = np.array(((x0, 0.0), (0.0, g.s2 * g.kappa * g.y0), (-x0, 0.0))) / self._lengths
        u_x, u_z = speed / l_x, v_z / l_z
        along_2 = u_x * u_x + u_z * u_z
        rate_2 = along_2 + self._decay * self._decay
        leads = (centres[:, 0] * u_x + centres[:, 1] * u_z) / rate_2
        across = (centres[:, 1] * u_x - centres[:, 0] * u_z) / math.sqrt(along_2)
        apart, late = across[:, None] - across, leads[:, None] - leads
        lost = (self._decay * self._decay * rate_2 / along_2) * late * late
        return Shape(leads, math.sqrt(rate_2), exp(-0.5 * (apart * apart + lost)))

    def signals(self, normals, speed, v_z, tan_alpha):
        """
        Return the complex amplitudes (3, length) of the signals.

        Parameters
        ----------
        normals : (width,) standard normal numbers
        speed, v_z, tan_alpha : see ``shape``
        """
        leads, rate, mixture = self.shape(speed, v_z, tan_alpha)
        modes = len(self._omega)
        parts = normals[:6 * modes].view(complex).reshape(3, modes)
        spectrum = exp(-0.25 * (self._omega / rate) ** 2)
        spectrum /= math.sqrt(2.0) * math.sqrt(float((spectrum * spectrum).sum()))
        parts = np.linalg.cholesky(mixture + JITTER * np.eye(3)) @ (parts * spectrum)
        sin, cos = sincos(leads[:, None] * self._omega)
        parts *= cos + 1j * sin
        # Modes beyond the band of the samples are aliased into it.
        folded = np.empty((3, self._period), dtype=complex)
        folded[:, self._place] = parts.reshape(3, -1, self._period).sum(axis=1)
        noise = normals[6 * modes:].view(complex).reshape(3, self.length)
        return (fft.ifft(folded, norm='forward')[:, :self.length]
                + self._noise * noise)

    def correlations(self, lags, speed, v_z, tan_alpha, detection):
        """Return the five expected functions without noise, (5, lags), in the order of PAIRS."""
        leads, rate, mixture = self.shape(speed, v_z, tan_alpha)
        t = self.lag_s * np.arange(lags)
        rows = [mixture[i, j] * exp(-0.5 * (rate * (t - leads[i] + leads[j])) ** 2)
                for i, j in PAIRS]
        return np.array(rows) ** 2 if detection == 'power' else np.array(rows)


class Sums(NamedTuple):
    """
    The sums that a window accumulates over its cycles.

    Attributes
    ----------
    products : (5, lags) mean products of values, in the order of PAIRS
    means : (3, lags) means of the values used in these products, by antenna and lag
    power : (3,) mean squared amplitude
    """

    products: np.ndarray
    means: np.ndarray
    power: np.ndarray


class Correlator:
    """
    Two cross-correlation and three autocorrelation functions, averaged over cycles.

    Every lag has as many products as the cycle has samples, because the correlator continues
    beyond the end of the cycle. Powers are correlated after their mean is subtracted, and divided
    by it. The mean is that of the window or that of each cycle; the latter lowers the functions
    by a pedestal of about the correlation time divided by the cycle.
    """

    def __init__(self, settings):
        self._powers = settings.signal.detection == 'power'
        self._by_cycle = settings.signal.normalisation == 'cycle'
        self._lags, self._count = settings.signal.lags, settings.samples
        self._size = power_of_two(self._count + self._lags - 1)
        self._earlier, self._later = (list(side) for side in zip(*PAIRS))

    def sums(self, signals):
        """Return the Sums of one cycle; signals (3, length): complex amplitudes."""
        values = power = signals.real ** 2 + signals.imag ** 2
        forward, back = fft.rfft, fft.irfft
        if not self._powers:
            values, forward, back = signals, fft.fft, fft.ifft
        mean = power.mean(axis=1)
        if self._by_cycle:
            scale = mean if self._powers else np.sqrt(mean)
            values, mean = values / scale[:, None], np.ones(3)
        early = forward(values[:, :self._count], self._size).conj()
        products = early[self._earlier] * forward(values, self._size)[self._later]
        ends = values.cumsum(axis=1)
        starts = np.concatenate((np.zeros((3, 1)), ends), axis=1)[:, :self._lags]
        return Sums(back(products, self._size)[:, :self._lags] / self._count,
                    (ends[:, self._count - 1:] - starts) / self._count, mean)

    def functions(self, total, cycles):
        """Return the real functions (5, lags) from the Sums over this number of cycles."""
        products, means, power = (part / cycles for part in total)
        p, q = power[self._earlier, None], power[self._later, None]
        if not self._powers:
            return abs(products) / np.sqrt(p * q)
        early, late = means[self._earlier, :1], means[self._later]
        return (products - early * q - p * late + p * q) / (p * q)


class SignalWindows:
    """
    Sums and readings of windows by correlation functions.

    Each cycle has its own field. A field that continued from cycle to cycle would correlate
    neighbours only over the delay and a correlation time: 0.4 and 0.2 ms of a cycle of 10 ms at
    250 m/s.

    Parameters
    ----------
    settings : VelocityMeterSettings
    """

    def __init__(self, settings):
        self._cycles, self._limits = settings.window.cycles, settings.limits
        self._geometry, self._lag_s = antenna_geometry(settings.antennas), settings.lag_s
        self._field, self._correlator = Field(settings), Correlator(settings)
        self._normals = indexed_noise(
            settings.seed, settings.run, 'velocity_meter.signal', self._field.width, 1)

    def add(self, total, index, v_last, v):
        """
        Return the Sums including the cycle that ends at ``index`` periods.

        The cycle is simulated at its mean velocity.

        Parameters
        ----------
        total : Sums so far, or None
        index : end of the cycle, periods
        v_last, v : V_x1, V_y1, V_z1 at the start and end of the cycle, m/s
        """
        x, y, z = (0.5 * (a + b) for a, b in zip(v_last, v))
        signals = self._field.signals(self._normals.normal_block(index)[0],
                                      math.sqrt(x * x + y * y), z, -y / x)
        one = self._correlator.sums(signals)
        return one if total is None else self.joined(total, one)

    def whole(self, total, index, cycles):
        """Return the Sums of a part; unlike in mode surrogate nothing is added at its end."""
        return total

    def joined(self, first, then):
        """Return the Sums of two consecutive parts together."""
        return Sums(*(a + b for a, b in zip(first, then)))

    def read(self, total, index, tan_alpha):
        """Return the Reading of a window from its Sums."""
        functions = self._correlator.functions(total, self._cycles)
        reading = read_correlations(functions, self._lag_s, self._geometry, tan_alpha)
        low, high = self._limits.speed_min_m_s, self._limits.speed_max_m_s
        if reading.status == VALID and not low <= reading.v_x <= high:
            return Reading('measured speed outside the limits')
        return reading
