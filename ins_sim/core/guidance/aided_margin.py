"""What latency the loop bears whose navigator is corrected by sliding windows."""

import math
from typing import NamedTuple

import numpy as np

from ins_sim.core.numerics.units import DEG
from .linear_loop import window_mean
from .linear_plant import after_period

# frequencies at which the gain is looked at
POINTS = 20001


class PhaseMargin(NamedTuple):
    """
    Crossover, rad/s, margin there, rad, and the further latency that uses it up, s.

    Negative in a loop that is unstable as it is.
    """

    crossover: float
    margin: float
    delay_s: float

    def __str__(self):
        """Return what a warning says of it."""
        return (f'{self.margin / DEG:.0f} deg at {self.crossover:.2g} rad/s, which '
                f'{max(0.0, self.delay_s):.2g} s use up')


def aided_margin(loop, aiding, k_z=0.0):
    """
    Return the PhaseMargin of a LateralLoop, the loop being opened at the command.

    aiding: an Aiding of kind conventional with windows that slide, as if they did every period.
    The navigators of contiguous windows are slower than the loop: theirs is that of exact
    navigation, ``margin.phase_margin``.  k_z: lateral scale error of the meter.  Of several
    crossovers it is the one with the least latency; None where the gain never is one.
    """
    omega = np.geomspace(1e-4, 1.0, POINTS) * math.pi / loop.period_s
    found = _returned(loop, aiding, k_z, np.exp(1j * omega * loop.period_s))
    angle = np.unwrap(np.angle(found))
    # at low frequencies a double integration, -180 deg
    angle -= 2.0 * math.pi * round((angle[0] + math.pi) / (2.0 * math.pi))
    size = np.log(np.abs(found))
    margins = []
    for k in np.flatnonzero(size[:-1] * size[1:] <= 0.0).tolist():
        part = size[k] / (size[k] - size[k + 1])
        crossover = float(omega[k] + part * (omega[k + 1] - omega[k]))
        margin = float(math.pi + angle[k] + part * (angle[k + 1] - angle[k]))
        margins.append(PhaseMargin(crossover, margin, margin / crossover))
    return min(margins, key=lambda m: m.delay_s, default=None)


def _returned(loop, aiding, k_z, q):
    """Return what comes back of a command at q, with the sign of the feedback reversed."""
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
