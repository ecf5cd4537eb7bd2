"""Phase margin of an autopilot with exact navigation."""

import math

from ins_sim.core.numerics.elementary import atan2

# Number of bisections of the interval that contains the crossover.
HALVINGS = 60


def phase_margin(gains, force, lag_s, delay_s):
    """
    Return the phase margin, rad, of the loop force (k1 + k2 s) e^(-s delay)/(s^2 (lag s + 1)).

    Return None if the gains are zero.

    Parameters
    ----------
    gains : k1 (rad/m) and k2 (rad s/m)
    force : m/s^2 per rad
    lag_s : lag, s
    delay_s : latency plus control period, s, because the command is reached at the end of a period
    """
    k1, k2 = gains
    if k1 == k2 == 0.0:
        return None

    def gain(w):
        lagging = lag_s * w
        return force * math.sqrt(k1 * k1 + k2 * w * k2 * w) / (
            w * w * math.sqrt(1.0 + lagging * lagging))

    low, high = 1e-6, 1e6
    for _ in range(HALVINGS):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if gain(middle) > 1.0 else (low, middle)
    return atan2(k2 * low, k1) - atan2(lag_s * low, 1.0) - low * delay_s
