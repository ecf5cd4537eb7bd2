"""Phase margin of a loop whose navigator is corrected by sliding windows (latency budget)."""

import math
from typing import NamedTuple

import numpy as np

from ins_sim.core.numerics.units import DEG
from .linear_loop import Aiding, window_mean
from .linear_plant import after_period, lateral_loop

# Number of frequencies at which the gain is evaluated.
POINTS = 20001


class PhaseMargin(NamedTuple):
    """
    Phase margin of a loop.

    crossover: frequency at which the gain is one, rad/s; margin: phase margin there, rad; delay_s:
    additional latency that reduces the margin to zero, s. Margin and delay are negative if the
    loop is unstable without additional latency.
    """

    crossover: float
    margin: float
    delay_s: float


def aided_margin(loop, aiding, k_z=0.0):
    """
    Return the phase margin of a lateral loop, opened at the command.

    A correction in every control period is assumed. Navigators with contiguous windows are slower
    than the loop; for them ``margin.phase_margin``, with exact navigation, is a good approximation
    (docs/theory/closed_loop.md).

    Parameters
    ----------
    loop : LateralLoop
    aiding : linear_loop.Aiding
        Of kind ``conventional`` with sliding windows.
    k_z : float
        Lateral scale factor error of the meter.

    Returns
    -------
    PhaseMargin or None
        If the gain is one at several frequencies, the margin with the smallest ``delay_s``; None
        if it is one nowhere.
    """
    omega = np.geomspace(1e-4, 1.0, POINTS) * math.pi / loop.period_s
    found = _returned(loop, aiding, k_z, np.exp(1j * omega * loop.period_s))
    angle = np.unwrap(np.angle(found))
    # At low frequencies the loop is a double integrator with a phase of -180 deg.
    angle -= 2.0 * math.pi * round((angle[0] + math.pi) / (2.0 * math.pi))
    size = np.log(np.abs(found))
    margins = []
    for k in np.flatnonzero(size[:-1] * size[1:] <= 0.0).tolist():
        part = size[k] / (size[k] - size[k + 1])
        crossover = float(omega[k] + part * (omega[k + 1] - omega[k]))
        margin = float(math.pi + angle[k] + part * (angle[k + 1] - angle[k]))
        margins.append(PhaseMargin(crossover, margin, margin / crossover))
    return min(margins, key=lambda m: m.delay_s, default=None)


def aided_margin_sentence(generator, navigator):
    """
    Return the warning that the latency makes the loop unstable, or None.

    None also for filters other than ``conventional`` on sliding windows, and if the control
    period differs from the cycle of the meter.

    Parameters
    ----------
    generator : MotionGeneratorSettings
    navigator : AidedNavigatorSettings
    """
    window, rate_hz = navigator.window, navigator.rate_hz
    if navigator.filter != 'conventional' or not (window.slides and navigator.meter_model.use):
        return None
    loop = lateral_loop(generator)
    if loop is None or generator.motion.guided.control_rate_hz != rate_hz:
        return None
    margin = aided_margin(loop, Aiding('conventional', window.cycles, window.step_cycles,
                                       navigator.gain_per_s * window.step_cycles / rate_hz))
    if margin is None or margin.margin > 0.0:
        return None
    return (f'guidance.latency_s is {generator.guidance.latency_s:g} s, which with filter '
            f'conventional and gain_per_s {navigator.gain_per_s:g} leaves the loop a phase margin '
            f'of {margin.margin / DEG:.1f} deg; expected more than 0, as with '
            f'{max(0.0, generator.guidance.latency_s + margin.delay_s):.2g} s or less: it is '
            'unstable whatever the meter reads')


def _returned(loop, aiding, k_z, q):
    """Return the open-loop response to a command at q, with the sign of the feedback reversed."""
    step = after_period(loop)
    a, b = np.zeros((4, 4)), np.zeros(4)
    a[:3], b[:3], b[3] = step[:, :4], step[:, 4], 1.0
    x = np.linalg.solve(q[:, None, None] * np.eye(4) - a,
                        np.broadcast_to(b[:, None], (len(q), 4, 1)))[..., 0]
    z, v, beta = x[:, 0], x[:, 1], x[:, 2]
    gain = aiding.gain / aiding.step
    read = (1.0 + k_z) * 0.5 * (1.0 + 1.0 / q) * window_mean(q, aiding.cycles)
    error = -gain * loop.speed * beta * (1.0 - read) / (1.0 - (1.0 - gain) / q)
    z, v = z + loop.period_s * error / (q - 1.0), v + error
    return -(loop.k1 * z + loop.k2 * v) * q ** -loop.latency
