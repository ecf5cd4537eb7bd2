"""
Mode surrogate of the velocity meter: the window mean with the errors of the real instrument.

Its coefficients are those of the simulated signals at 250 m/s (docs/theory/velocity_meter.md,
Surrogate).
"""

import math

from ins_sim.core.numerics.elementary import atan2
from ins_sim.core.numerics.noise import indexed_noise
from ins_sim.core.timeseries.fixes import VALID
from .blocks import in_order
from .reading import Reading, secant

# what a fix without errors carries: to weigh it the navigator divides by its variance, and its
# window is the mean of a motion that the strapdown knows no better
LEAST_SIGMA_M_S = 1e-3


def velocity_sigmas(surrogate, cycles, beta):
    """
    Return the standard deviations of V_x1 and V_z1 over N cycles, m/s.

    surrogate: settings; beta: sideslip, rad.  sigma_x/sqrt(N) sqrt(1 + (slip_x beta)^2), and
    sqrt(sigma_z^2 + (slip_z beta)^2)/sqrt(N).
    """
    root, x, z = math.sqrt(cycles), surrogate.slip_x * beta, surrogate.slip_z_m_s * beta
    sigma_z = surrogate.sigma_z_m_s
    return (surrogate.sigma_x_m_s * math.sqrt(1.0 + x * x) / root,
            math.sqrt(sigma_z * sigma_z + z * z) / root)


def reported_sigmas(surrogate, cycles, beta):
    """Return the sigmas that a fix carries: those of ``velocity_sigmas``, but never zero."""
    return tuple(max(sigma, LEAST_SIGMA_M_S)
                 for sigma in velocity_sigmas(surrogate, cycles, beta))


class SurrogateWindows:
    """
    Sums and readings of windows by trapezoids over the instants of their cycles.

    settings: VelocityMeterSettings.
    """

    def __init__(self, settings):
        self._surrogate, self._cycles = settings.surrogate, settings.window.cycles
        beam = settings.beam
        self._scale_x = 1.0 + self._surrogate.k_x
        ratio = beam.sigma_theta_z_rad / beam.sigma_theta_x_rad
        self._scale_z = (1.0 + self._surrogate.k_z) * (ratio * ratio)
        self._normals = indexed_noise(settings.seed, settings.run,
                                      'velocity_meter.surrogate', 2)

    def add(self, total, index, v_last, v):
        """
        Return the sum with the cycle that ends at index periods.

        total: the sum so far or None; v_last, v: (V_x1, V_y1, V_z1) at its ends, m/s.
        """
        x, y, z = total or (0.0, 0.0, 0.0)
        return (x + 0.5 * (v_last[0] + v[0]), y + 0.5 * (v_last[1] + v[1]),
                z + 0.5 * (v_last[2] + v[2]))

    def add_cycles(self, total, v):
        """Return the sum with cycles, as ``add`` gives it; v (3, n + 1): at their ends, m/s."""
        return in_order(total or (0.0, 0.0, 0.0), 0.5 * (v[:, :-1] + v[:, 1:]))

    def whole(self, total, index, cycles):
        """
        Return the sum over cycles, with the sum of their noise; the last ends at index periods.

        Every cycle has noise of its own. Long windows therefore average the noise of the short
        ones, and windows that overlap share the noise of the cycles that they share.
        """
        noise = self._normals.normals(index - cycles + 1, cycles)
        return (*total, *in_order((0.0, 0.0), noise.T))

    def joined(self, first, then):
        """Return the sum of two ``whole`` ones."""
        return tuple(a + b for a, b in zip(first, then))

    def read(self, total, index, tan_alpha):
        """
        Return the Reading of the window that ends at index periods.

        total: as of ``whole``; tan_alpha: tangent of what is taken for the angle of attack.  A
        wrong one scales both components by (cos taken / cos true)^2, as with signals.
        """
        v_x, v_y, v_z = (part / self._cycles for part in total[:3])
        ratio = secant(v_y / v_x) / secant(tan_alpha)
        scale = ratio * ratio
        sigma_x, sigma_z = velocity_sigmas(self._surrogate, self._cycles, atan2(v_z, v_x))
        n_x, n_z = (x / math.sqrt(self._cycles) for x in total[3:])
        return Reading(VALID, self._scale_x * scale * v_x
                       + self._surrogate.bias_x_m_s / self._cycles + sigma_x * n_x,
                       self._scale_z * scale * v_z + sigma_z * n_z)
