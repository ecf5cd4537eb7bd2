"""
Disturbances of the rotors of a pair of tuned gyros and of their pick-offs.

A moment is given as the equivalent rate d, complex in the case, y + j z (docs/theory.md,
"Dynamically tuned gyro", Errors of the rotors):

    by specific force a    d_y = m_y a_y + q_y a_z + a_s (s_y + c_y a_y), d_z likewise
    product of rates       d = kappa (B - A)/(B Omega) u_s u
    hunting e(t)           d = e (u - 2 K_t theta_0/(j B Omega)), as dk2 = -2 K_t e
    vibration at 2 Omega   d = (2 Jek - Jk)/(8 B) (1 + dJ/g) U exp(-j phase)

with dJ = Jek - Jk/2, g = Jr - 2 Jer.  Offset and noise of the pick-off go through the rotor and
its loop, so that an offset theta_0 reads (k2 - j fe Omega) theta_0/(j B Omega), and a jump of it
an angle of J/B times the jump.  The acceleration of the case, (A/(B Omega)) u' on the other axis,
is in the rotor's own equation.
"""

import cmath
import math

import numpy as np

from ins_sim.core.numerics.noise import indexed_noise
from ins_sim.core.numerics.units import DEG_H, STANDARD_GRAVITY

URAD = 1e-6


class RotorErrors:
    """
    The disturbances of both gyros, sampling period by sampling period.

    errors: TunedGyroErrors; pair: GyroPair; dt_s: sampling period, s.  The noise of the
    pick-offs is a function of (seed, index).  Raises ValueError for a rotor of which the vibration
    is not defined.
    """

    def __init__(self, errors, pair, seed, dt_s):
        self._pair, self._dt_s = pair, dt_s
        per_g, per_g2 = DEG_H / STANDARD_GRAVITY, DEG_H / STANDARD_GRAVITY ** 2
        self._by_force = tuple(
            (m * per_g, q * per_g, s * per_g, c * per_g2) for m, q, s, c in zip(
                errors.mass_unbalance_deg_h_g, errors.quadrature_unbalance_deg_h_g,
                errors.spin_axis_deg_h_g, errors.anisoelastic_deg_h_g2))
        self._forced = any(map(any, self._by_force))
        self._offsets = _complex(errors.pickoff_offset_urad, URAD)
        self._densities = tuple(URAD * n for n in errors.pickoff_noise_urad_sqrt_s)
        self._normals = None
        if any(self._densities):
            self._normals = indexed_noise(seed, 0, 'gyro.dtg.pickoff', 4)
        self._constant = tuple(
            math.radians(u) * rotor.parameters.vibration_2n_factor
            * cmath.exp(-1j * math.radians(phase)) if u else 0.0j
            for rotor, u, phase in zip(pair.gyros, errors.vibration_2n_deg_s,
                                       errors.vibration_2n_phase_deg))
        p = pair.gyros[0].parameters
        per_moment = 1.0 / (p.input_inertia * p.omega)
        self.product_s = errors.spin_rate_product * (
            p.input_inertia - p.transverse_inertia) * per_moment
        hunting = 2.0 * math.pi * errors.hunting_hz
        self._hunting = tuple(1e-6 * a * np.sinc(errors.hunting_hz * dt_s).item()
                              for a in errors.hunting_ppm)
        self._hunting_rad_s = hunting if any(self._hunting) else 0.0
        # the stiffness of the hinges is what k2 is at a rotor that stands still
        self._detuning = 2j * p.stiffness(0.0) * per_moment
        self._tilts = self._offsets
        self._sample = (self._constant, self._offsets, (0.0, 0.0), (0.0, 0.0))

    def settle(self, w):
        """Let the rotors be settled at the body rate w and at the present offsets, no force."""
        self._tilts = self._offsets
        for rotor, u, moment, tilt in zip(self._pair.gyros, self._pair.into_cases(w),
                                          self._constant, self._offsets):
            rotor.settle(u, moment, tilt)

    def begin(self, t_ns, force):
        """Take the sampling period that ends at motion time t_ns; force: its mean, in b, m/s^2."""
        dt_s = self._dt_s
        moments = self._constant
        if self._forced:
            along, spins = self._pair.into_cases(force), self._pair.spins(force)
            rows = self._by_force
            moments = (moments[0] + _by_force(rows[0], rows[1], spins[0], along[0]),
                       moments[1] + _by_force(rows[2], rows[3], spins[1], along[1]))
        tilts = self._offsets
        if self._normals is not None:
            index, scale = t_ns // round(dt_s * 1e9), 1.0 / math.sqrt(dt_s)
            n = [scale * d * v for d, v in zip(self._densities, self._normals.normal(index))]
            tilts = tilts[0] + complex(n[0], n[1]), tilts[1] + complex(n[2], n[3])
        jumps = tilts[0] - self._tilts[0], tilts[1] - self._tilts[1]
        speeds = (0.0, 0.0)
        if self._hunting_rad_s:
            wave = math.sin(self._hunting_rad_s * (t_ns * 1e-9 - 0.5 * dt_s))
            speeds = self._hunting[0] * wave, self._hunting[1] * wave
        self._tilts = tilts
        self._sample = moments, tilts, jumps, speeds

    def step(self, w_start, w_mid, w_end):
        """Return (moment, tilt, jump) of both gyros for one step of the rotors."""
        moments, tilts, jumps, speeds = self._sample
        self._sample = moments, tilts, (0.0, 0.0), speeds
        if self.product_s or self._hunting_rad_s:
            cases = self._pair.into_cases(w_mid)
            moments = [d + e * (u + self._detuning * n)
                       for d, e, u, n in zip(moments, speeds, cases, tilts)]
            if self.product_s:
                nodes = [(self._pair.into_cases(w), self._pair.spins(w))
                         for w in (w_start, w_mid, w_end)]
                third = self.product_s / 6.0
                for k in range(2):
                    a, b, c = [u[k] * spins[k] for u, spins in nodes]
                    moments[k] += third * (a + 4.0 * b + c)
        return tuple(zip(moments, tilts, jumps))

    def noise_variances(self):
        """Return the variances of the means of the four channels by the noise of the pick-offs."""
        if self._normals is None:
            return (0.0,) * 4
        from .stability import pickoff_gain
        gains = [pickoff_gain(rotor, self._dt_s) for rotor in self._pair.gyros]
        return tuple(gain * d * d / self._dt_s
                     for d, gain in zip(self._densities, np.repeat(gains, 2).tolist()))


def _complex(four, unit):
    return complex(four[0], four[1]) * unit, complex(four[2], four[3]) * unit


def _by_force(row_y, row_z, spin, a):
    (m, q, s, c), (n, p, t, e), y, z = row_y, row_z, a.real, a.imag
    return complex(m * y + q * z + spin * (s + c * y), n * z + p * y + spin * (t + e * z))
