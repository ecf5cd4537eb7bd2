"""Latency margin of a loop whose navigator is corrected by sliding windows."""

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
    Crossover frequency (rad/s), phase margin there (rad), and additional latency it allows (s).

    Margin and latency are negative for an unstable loop.
    """

    crossover: float
    margin: float
    delay_s: float


def aided_margin(loop, aiding, k_z=0.0):
    """
    Return the PhaseMargin of a LateralLoop opened at the command, or None if the gain is never 1.

    A correction every control period is assumed. Navigators with contiguous windows are slower
    than the loop; for them the margin with exact navigation, ``margin.phase_margin``, is a good
    approximation. If the gain is one at several frequencies, the one with the smallest latency
    margin is returned.

    Parameters
    ----------
    loop : LateralLoop
    aiding : Aiding of kind conventional with sliding windows
    k_z : lateral scale error of the meter

    """
    omega = np.geomspace(1e-4, 1.0, POINTS) * math.pi / loop.period_s
    found = _returned(loop, aiding, k_z, np.exp(1j * omega * loop.period_s))
    angle = np.unwrap(np.angle(found))
    # At low frequencies the loop is a double integration with -180 deg.
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

    Only filter conventional with sliding windows is examined, and only if the control instants
    are cycles of the meter; otherwise None is returned.

    generator: MotionGeneratorSettings; navigator: AidedNavigatorSettings.
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
            f'{max(0.0, generator.guidance.latency_s + margin.delay_s):.2g} s or less: the loop '
            'is unstable whatever the meter measures')


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
