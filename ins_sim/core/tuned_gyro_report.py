"""What a tuned gyro is good for: roots, bandwidth, margin, and the steps that RK4 allows."""

from dataclasses import dataclass
import math

import numpy as np

from .tuned_gyro import state_space

# The grid of the searches, refined by bisection to the precision of the floats.
GRID = 4000


def bisect(holds, inside, outside):
    """Return where a condition that holds inside stops to hold, between the two floats."""
    for _ in range(100):
        middle = 0.5 * (inside + outside)
        if middle in (inside, outside):
            break
        if holds(middle):
            inside = middle
        else:
            outside = middle
    return inside


def rk4_amplification(z):
    """Return the factor of one RK4 step, z = root x step (floats or arrays)."""
    return 1.0 + z * (1.0 + z * (0.5 + z * (1.0 / 6.0 + z / 24.0)))


def rk4_window(roots):
    """
    Return the steps (low, high), s, between which RK4 decays; None where it never does.

    low is 0 for a stable instrument; a slightly unstable one is damped by RK4 itself when the step
    is long enough, as 1 - (w h)^6 / 144.
    """
    roots = np.array(roots)
    fastest = np.abs(roots).max()

    def decays(h):
        return (np.abs(rk4_amplification(np.multiply.outer(h, roots))) < 1.0).all(axis=-1)

    # RK4 is stable nowhere in the left half plane beyond |z| = 3
    steps = np.linspace(0.0, 3.0, GRID + 1)[1:] / fastest
    inside = decays(steps)
    if not inside.any():
        return None
    first = int(inside.argmax())
    last = first + int(np.append(inside[first:], False).argmin())
    if first:
        low = bisect(decays, steps[first], steps[first - 1])
    else:
        low = 0.0 if (roots.real < 0.0).all() else bisect(decays, steps[0], 0.0)
    return float(low), float(bisect(decays, steps[last - 1], steps[last]))


@dataclass(frozen=True)
class TunedGyroReport:
    """
    Figures of an instrument; the frequencies are those of the direct response of an axis.

    roots: 1/s, least stable first.  time_constant_s: T = H / c, the lag at low frequency of the
    open loop (None in closed loop).  bandwidth_hz: at -3 dB.  peak, peak_hz: largest gain below
    it.  margin: 1 - A c^2 / (H c f + k2 f^2) in open loop, stable above 0 (None in closed loop).
    decay_1_s: of the slowest root, stable above 0.  rk4_window_s: steps that RK4 allows, or None.
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
        """Every root decays."""
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
        found.append('RK4 decays for no step' if window is None else
                     f'RK4 decays for steps of {1e3 * window[0]:.4g} to {1e3 * window[1]:.4g} ms')
        return found


def report(parameters, speed_hz=None):
    """Return the TunedGyroReport of TunedGyroParameters, at the nominal speed unless given."""
    p, space = parameters, state_space(parameters, speed_hz)

    def gain(hz):
        return np.abs(space.axis_responses(2.0 * math.pi * hz)[0])

    # one decade below the slowest root to twice the fastest
    sizes = np.abs(space.roots) / (2.0 * math.pi)
    grid = np.geomspace(0.1 * sizes.min(), 2.0 * sizes.max(), GRID)
    gains = gain(grid)
    below = np.flatnonzero(gains < math.sqrt(0.5))
    end = int(below[0]) if len(below) else GRID - 1
    bandwidth = bisect(lambda hz: gain(hz) >= math.sqrt(0.5), grid[max(end - 1, 0)], grid[end])
    top = int(gains[:end + 1].argmax())
    if 0 < top < end:
        left, right = grid[top - 1], grid[top + 1]
        peak_hz = bisect(lambda hz: gain(hz * (1.0 + 1e-5)) > gain(hz), left, right)
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


def pickoff_gain(rotor, dt_s):
    """
    Return the variance of mean readings over that of pick-off noise, (rad/s)^2/rad^2.

    rotor: TunedGyro; the noise is white from one interval dt_s, s, to the next and constant within
    it.  Stationary solution of the discrete Lyapunov equation of the state and the last noise, by
    Smith's doubling, to which the scale of the states does not matter.
    """
    table, added = rotor.matrices
    n = len(added) - 1
    # columns: state at the start of the interval, noise in it, its jump
    x, read = np.eye(n, n + 2, dtype=complex), np.zeros(n + 2, dtype=complex)
    steps = round(dt_s / rotor.dt_s)
    for k in range(steps):
        push = np.zeros((n + 1, n + 2), dtype=complex)
        push[:, n] = added[:, 1]
        if k == 0:
            push[:, n + 1] = added[:, 2]
        push += table[:, :n] @ x
        x = push[:n]
        read += push[n] / steps
    carry = np.zeros((n + 1, n + 1), dtype=complex)
    carry[:n, :n], carry[:n, n] = x[:, :n], -x[:, n + 1]
    drive = np.append(x[:, n] + x[:, n + 1], 1.0)
    out = np.append(read[:n], -read[n + 1])
    spread, power = np.outer(drive, drive.conj()), carry
    while power.any():
        spread = spread + power @ spread @ power.conj().T
        power = power @ power
    return float((out @ spread @ out.conj()).real + abs(read[n] + read[n + 1]) ** 2)
