"""
Mean drift due to late gyros over the rates of motion 2, and over the direction of rocking.

Both follow from <R (w x T w)>, T = diag(tau), R = C_nb (docs/theory/prediction.md). The rotation
of the Earth in w is neglected, 1e-4 of the largest drift.
"""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import from_angles
from ins_sim.core.numerics import elementary
from ins_sim.core.prediction.fourier import fourier_coefficients

# The product has harmonics of gamma up to the third.
GAMMA_SAMPLES = 16
NOTHING = 1e-12
# Number of cells from the middle of the map over the rates to its edge.
CELLS = 45
# Half widths of the map of one resonance and of the cut across it, times the averaging time.
NEAR, ACROSS = 20.0, 40.0
NEAR_POINTS, ACROSS_POINTS = 101, 801
DIRECTION_STEP_DEG = 3.0
ROCKING_SAMPLES = 256


@dataclass(frozen=True, eq=False)
class RatesMap:
    """
    Mean horizontal drift of motion 2 over a time, rad/s.

    Attributes
    ----------
    span_s : averaging time, s
    psi_rates, gamma_rates : (n,) and (m,) middles of the cells, rad/s
    largest : (m, n) largest drift in each cell, rad/s
    lines : numbers k of the resonance lines psi' = k gamma'
    near_psi_rates, near_gamma_rates : (p,) rates of a second map, near those of the settings,
        rad/s
    near : (p, p) drift (not the largest one) at these rates, rad/s; rows by gamma', columns by
        psi'
    detunings : (k,) detunings of psi' from the rate of the settings, rad/s
    across : (k,) drift over the detuning, rad/s
    half_width : detuning at which the drift is half as large, rad/s, or None if it is not in the
        range
    """

    span_s: float
    psi_rates: np.ndarray
    gamma_rates: np.ndarray
    largest: np.ndarray
    lines: tuple[int, ...]
    near_psi_rates: np.ndarray
    near_gamma_rates: np.ndarray
    near: np.ndarray
    detunings: np.ndarray
    across: np.ndarray
    half_width: float | None


@dataclass(frozen=True, eq=False)
class RockingMap:
    """
    Mean drift of motion 1, rad/s.

    Attributes
    ----------
    azimuth_deg : (n,) direction of the rocking axis in the body, from forward to the left, deg
    elevation_deg : (m,) direction of the rocking axis in the body, upwards, deg
    size : (m, n) magnitude of the drift, rad/s
    psi_deg : (k,) psi of a body that rocks about a level axis, deg
    drift : (k, 3) drift over psi for this axis, East, North, Up, rad/s
    """

    azimuth_deg: np.ndarray
    elevation_deg: np.ndarray
    size: np.ndarray
    psi_deg: np.ndarray
    drift: np.ndarray


def delays_s(settings):
    """Return the delays (3,) of the gyros x, y, z of SimulationSettings, s."""
    return np.array(settings.imu_sensor.gyro.delay_us.in_ns()) * 1e-9


class TwoAxisDrift:
    """
    Mean drift of motion 2 as a function of its rates.

    With u = up and e = forward in b, w = psi' u + gamma' e, so that R (w x T w) is Rz(psi) times
    psi'^2 A(gamma) + psi' gamma' B(gamma). Each harmonic k of gamma in it rotates in n at the rate
    psi' + k gamma'; its mean over a time is a sine divided by its angle.

    settings: SimulationSettings with motion two_axis; their duration is the averaging time.
    """

    def __init__(self, settings):
        generator = settings.motion_generator
        motion, tau = generator.motion, delays_s(settings)
        self.span_s = generator.duration_s - settings.strapdown.initial.after_s
        self._start_s = generator.start_s + settings.strapdown.initial.after_s
        self._psi, self._gamma = math.radians(motion.psi_deg), math.radians(motion.gamma_deg)
        gamma = 2.0 * np.pi / GAMMA_SAMPLES * np.arange(GAMMA_SAMPLES)
        q_nb = from_angles(0.0 * gamma, math.radians(motion.theta_deg), gamma)
        zero, one = 0.0 * gamma, 0.0 * gamma + 1.0
        up, forward = quaternion.rotate_back(q_nb, (zero, zero, one)), (one, zero, zero)
        late_up, late_forward = (tuple(t * x for t, x in zip(tau, vector))
                                 for vector in (up, forward))
        mixed = tuple(a + b for a, b in zip(quaternion.cross(up, late_forward),
                                            quaternion.cross(forward, late_up)))
        samples = np.stack([*quaternion.rotate(q_nb, quaternion.cross(up, late_up))[:2],
                            *quaternion.rotate(q_nb, mixed)[:2]], axis=-1)
        re, im, harmonics = fourier_coefficients(samples)
        found = re + 1j * im
        # East + j North.
        both = found[:, [0, 2]] + 1j * found[:, [1, 3]]
        kept = np.abs(both).max(axis=1) > NOTHING * max(np.abs(tau).max(), NOTHING)
        self._terms = list(zip(harmonics[kept].tolist(), both[kept]))

    @property
    def lines(self):
        """Return the numbers k of the lines psi' = k gamma' on which a drift is constant in n."""
        return tuple(-k for k, _ in self._terms if k)

    def mean(self, psi_rate, gamma_rate):
        """
        Return the mean East + j North, rad/s, for arrays of rates, rad/s, of matching shapes.
        """
        middle_s, total = self._start_s + 0.5 * self.span_s, 0.0
        psi, gamma = self._psi + psi_rate * middle_s, self._gamma + gamma_rate * middle_s
        for k, (square, product) in self._terms:
            size = psi_rate * (psi_rate * square + gamma_rate * product)
            turned = 0.5 * self.span_s * (psi_rate + k * gamma_rate)
            total = total + size * np.exp(1j * (psi + k * gamma)) * np.sinc(turned / np.pi)
        return total

    def largest(self, psi_rate, gamma_rate, width):
        """
        Return the largest |mean| in cells of rates, rad/s.

        Each cell is width rad/s of psi' wide. It is evaluated at its middle and at the points in
        it that are nearest to the resonance lines, which are narrower than any cell.
        """
        found = np.abs(self.mean(psi_rate, gamma_rate))
        for k in self.lines:
            nearest = np.clip(k * gamma_rate, psi_rate - 0.5 * width, psi_rate + 0.5 * width)
            found = np.maximum(found, np.abs(self.mean(nearest, gamma_rate)))
        return found


def rates_map(settings):
    """Return the RatesMap of SimulationSettings with motion two_axis."""
    rates, drift = settings.motion_generator.motion.two_axis, TwoAxisDrift(settings)
    psi_0, gamma_0 = rates.psi_rate_rad_s, rates.gamma_rate_rad_s
    most = 1.5 * max(abs(psi_0), 2.0 * abs(gamma_0))
    if not most:
        raise ValueError('motion.two_axis.psi_rate_rad_s and gamma_rate_rad_s are 0 with figure '
                         'rates; expected at least one of them not 0')
    cells = np.arange(-CELLS, CELLS + 1) / CELLS
    psi, gamma = most * cells, 0.5 * most * cells
    near = NEAR / drift.span_s * np.linspace(-1.0, 1.0, NEAR_POINTS)
    detunings = ACROSS / drift.span_s * np.linspace(-1.0, 1.0, ACROSS_POINTS)
    across = np.abs(drift.mean(psi_0 + detunings, gamma_0))
    return RatesMap(
        drift.span_s, psi, gamma, drift.largest(psi[None, :], gamma[:, None], most / CELLS),
        drift.lines, psi_0 + near, gamma_0 + 0.5 * near,
        np.abs(drift.mean(psi_0 + near[None, :], gamma_0 + 0.5 * near[:, None])),
        detunings, across, _half_width(lambda x: abs(drift.mean(psi_0 + x, gamma_0)),
                                       detunings[-1]))


def _half_width(height, far):
    """Return where a height with its maximum at 0 has halved, up to far; None if it has not."""
    half, low, high = 0.5 * height(0.0), 0.0, far
    grid = np.linspace(0.0, far, ACROSS_POINTS)
    below = np.flatnonzero(height(grid) < half)
    if not len(below) or not half or height(grid).max() > 2.0 * half * (1.0 + 1e-2):
        return None
    low, high = grid[below[0] - 1], grid[below[0]]
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if height(middle) < half else (middle, high)
    return low


def rocking_map(settings, psi_deg):
    """
    Return the RockingMap of SimulationSettings with motion rocking about a level axis.

    psi_deg: directions of the runs; the curve covers their range in steps of one degree and
    includes them. With w = kappa' n the mean of R (w x T w) is that of kappa'^2 cos(kappa) times
    R0 (n x T n); all other terms are odd in kappa.
    """
    motion, tau = settings.motion_generator.motion, delays_s(settings)
    rocking = motion.rocking
    w, most = 2.0 * np.pi * rocking.frequency_hz, math.radians(rocking.amplitude_deg)
    sine, cosine = elementary.sincos(2.0 * np.pi / ROCKING_SAMPLES * np.arange(ROCKING_SAMPLES))
    factor = most * most * w * w * np.mean(cosine * cosine * np.cos(most * sine))
    azimuth = np.arange(-180.0, 181.0, DIRECTION_STEP_DEG)
    elevation = np.arange(-90.0, 91.0, DIRECTION_STEP_DEG)
    a, e = np.radians(azimuth)[None, :], np.radians(elevation)[:, None]
    n = np.broadcast_arrays(np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e))
    size = factor * np.linalg.norm(np.stack(_turned(n, tau)), axis=0)
    psi = np.unique([*np.arange(min(psi_deg), max(psi_deg) + 0.5), *psi_deg])
    q_nb = from_angles(np.radians(psi), math.radians(motion.theta_deg),
                       math.radians(motion.gamma_deg))
    axis = [0.0 * psi + float(rocking.axis == name) for name in ('east', 'north', 'up')]
    drift = quaternion.rotate(q_nb, _turned(quaternion.rotate_back(q_nb, axis), tau))
    return RockingMap(azimuth, elevation, size, psi, factor * np.stack(drift, axis=-1))


def _turned(n, tau):
    """Return n x T n for directions n, three arrays."""
    return quaternion.cross(n, tuple(t * x for t, x in zip(tau, n)))
