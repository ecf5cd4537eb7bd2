"""Figures of merit of a tuned gyro: roots, bandwidth, stability margin, and stable RK4 steps."""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import magnitude
from .stability import bisect_condition, GRID, rk4_window
from .state_space import state_space


@dataclass(frozen=True)
class TunedGyroReport:
    """
    Figures of merit of a tuned gyro; see `tuned_gyro_report`.

    Bandwidth and peak are those of the response of an axis to its own rate.

    Attributes
    ----------
    roots : characteristic roots, 1/s, least stable first
    time_constant_s : T = H / c, the open-loop lag at low frequency, s; None in closed loop
    bandwidth_hz : frequency at -3 dB
    peak, peak_hz : largest gain below the bandwidth, and its frequency
    margin : 1 - A c^2 / (H c f + k2 f^2), positive if stable; None in closed loop
    decay_1_s : decay rate of the slowest root, 1/s, positive if stable
    rk4_window_s : shortest and longest step for which RK4 is stable, s, or None
    """

    roots: tuple
    time_constant_s: float | None
    bandwidth_hz: float
    peak: float
    peak_hz: float
    margin: float | None
    decay_1_s: float
    rk4_window_s: tuple | None

    @property
    def stable(self):
        """Whether every root decays."""
        return self.decay_1_s > 0.0

    def lines(self):
        """Return the report as lines of text."""
        found = ['roots ' + ', '.join(f'{s.real:.6g}{s.imag:+.6g}j' for s in self.roots) + ' 1/s: '
                 + ('stable' if self.stable else 'UNSTABLE')]
        if self.time_constant_s is not None:
            found.append(f'time constant {self.time_constant_s:.6g} s')
            found.append(f'stability margin {self.margin:.4g} (stable above 0)')
        found.append(f'-3 dB at {self.bandwidth_hz:.5g} Hz')
        found.append(f'peak {self.peak:.5g} at {self.peak_hz:.4g} Hz')
        window = self.rk4_window_s
        found.append('RK4 is stable for no step' if window is None else
                     f'RK4 is stable for steps of {1e3 * window[0]:.4g} to '
                     f'{1e3 * window[1]:.4g} ms')
        return found


def tuned_gyro_report(parameters, speed_hz=None):
    """
    Return the TunedGyroReport of a rotor.

    Parameters
    ----------
    parameters : TunedGyroParameters
    speed_hz : speed of the rotor; None for the nominal one
    """
    p, space = parameters, state_space(parameters, speed_hz)

    def gain(hz):
        return magnitude(space.axis_responses(2.0 * math.pi * hz)[0])

    # Search from one decade below the slowest root to twice the fastest.
    sizes = magnitude(np.array(space.roots)) / (2.0 * math.pi)
    low, high = elementary.log(0.1 * sizes.min()), elementary.log(2.0 * sizes.max())
    grid = elementary.exp(np.linspace(low, high, GRID))
    gains = gain(grid)
    below = np.flatnonzero(gains < math.sqrt(0.5))
    end = int(below[0]) if len(below) else GRID - 1
    bandwidth = bisect_condition(lambda hz: gain(hz) >= math.sqrt(0.5), grid[max(end - 1, 0)],
                                 grid[end])
    top = int(gains[:end + 1].argmax())
    if 0 < top < end:
        left, right = grid[top - 1], grid[top + 1]
        peak_hz = bisect_condition(lambda hz: gain(hz * (1.0 + 1e-5)) > gain(hz), left, right)
        peak_hz = float(np.clip(peak_hz, left, right))
        peak = float(gain(peak_hz))
    else:
        peak, peak_hz = float(gain(0.0)) if p.loop == 'open' else 1.0, 0.0
    lag = margin = None
    if p.loop == 'open':
        omega = 2.0 * math.pi * (p.speed_hz if speed_hz is None else speed_hz)
        c = p.rotating_damping_n_m_s * omega + p.cross_feedback_n_m_rad
        h, f = p.axial_inertia * omega, p.damping
        lag = h / c
        holding = h * c * f + p.stiffness(speed_hz) * f * f
        margin = (1.0 - p.transverse_inertia * c * c / holding if holding > 0.0 else -math.inf)
    roots = space.roots
    return TunedGyroReport(roots, lag, float(bandwidth), peak, peak_hz, margin, -roots[0].real,
                           rk4_window(roots))
