"""
Mode ``surrogate`` of the velocity meter: the window mean plus the errors of the instrument.

The default coefficients were found from simulated signals at 250 m/s
(docs/theory/velocity_meter.md, Surrogate).
"""

import math

from ins_sim.core.numerics.elementary import atan2
from ins_sim.core.numerics.noise import indexed_noise
from ins_sim.core.timeseries.fixes import VALID
from .blocks import in_order
from .reading import Reading, secant

# Smallest sigma of a fix without errors: the navigator divides by the variance, and the mean
# motion over the window is known to the strapdown no better than this.
LEAST_SIGMA_M_S = 1e-3


def velocity_sigmas(surrogate, cycles, beta):
    """
    Return the standard deviations of V_x1 and V_z1 over N cycles, m/s.

    They are sigma_x/sqrt(N) sqrt(1 + (slip_x beta)^2) for V_x1 and
    sqrt(sigma_z^2 + (slip_z beta)^2)/sqrt(N) for V_z1 (docs/theory/velocity_meter.md, Surrogate).

    Parameters
    ----------
    surrogate : settings
    cycles : N
    beta : sideslip, rad
    """
    root, x, z = math.sqrt(cycles), surrogate.slip_x * beta, surrogate.slip_z_m_s * beta
    sigma_z = surrogate.sigma_z_m_s
    return (surrogate.sigma_x_m_s * math.sqrt(1.0 + x * x) / root,
            math.sqrt(sigma_z * sigma_z + z * z) / root)


def reported_sigmas(surrogate, cycles, beta):
    """Return the sigmas reported with a fix: those of ``velocity_sigmas``, but never zero."""
    return tuple(max(sigma, LEAST_SIGMA_M_S)
                 for sigma in velocity_sigmas(surrogate, cycles, beta))


class SurrogateWindows:
    """
    Sums and readings of windows; velocities are averaged by the trapezoidal rule over cycles.

    Parameters
    ----------
    settings : VelocityMeterSettings
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
        Return the sum including the cycle that ends at ``index`` periods.

        Parameters
        ----------
        total : sum so far, or None
        index : end of the cycle, periods
        v_last, v : V_x1, V_y1, V_z1 at the start and end of the cycle, m/s
        """
        x, y, z = total or (0.0, 0.0, 0.0)
        return (x + 0.5 * (v_last[0] + v[0]), y + 0.5 * (v_last[1] + v[1]),
                z + 0.5 * (v_last[2] + v[2]))

    def add_cycles(self, total, v):
        """Return the sum including n cycles; v (3, n + 1): velocities at their ends, m/s."""
        return in_order(total or (0.0, 0.0, 0.0), 0.5 * (v[:, :-1] + v[:, 1:]))

    def whole(self, total, index, cycles):
        """
        Return the sum over cycles with the sum of their noise appended.

        The last cycle ends at ``index`` periods. Every cycle has its own noise: long windows
        average the noise of short ones, and overlapping windows share that of their common cycles.
        """
        noise = self._normals.normals(index - cycles + 1, cycles)
        return (*total, *in_order((0.0, 0.0), noise.T))

    def joined(self, first, then):
        """Return the sum of two results of ``whole``."""
        return tuple(a + b for a, b in zip(first, then))

    def read(self, total, index, tan_alpha):
        """
        Return the Reading of the window that ends at ``index`` periods.

        Parameters
        ----------
        total : as ``whole`` returns it
        index : end of the window, periods
        tan_alpha : tangent of the assumed angle of attack; a wrong one scales both components by
            (cos assumed / cos true)^2, as in mode signal
        """
        v_x, v_y, v_z = (part / self._cycles for part in total[:3])
        ratio = secant(v_y / v_x) / secant(tan_alpha)
        scale = ratio * ratio
        sigma_x, sigma_z = velocity_sigmas(self._surrogate, self._cycles, atan2(v_z, v_x))
        n_x, n_z = (x / math.sqrt(self._cycles) for x in total[3:])
        return Reading(VALID, self._scale_x * scale * v_x
                       + self._surrogate.bias_x_m_s / self._cycles + sigma_x * n_x,
                       self._scale_z * scale * v_z + sigma_z * n_z)
