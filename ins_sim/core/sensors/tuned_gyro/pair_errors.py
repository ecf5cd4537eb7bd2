"""
Disturbances of the rotors of a pair of tuned gyros and of their pick-offs.

A moment is expressed as the equivalent rate d, a complex number y + j z in case axes. The terms
are (docs/theory/tuned_gyro.md, Errors of the rotors):

    specific force a        d_y = m_y a_y + q_y a_z + a_s (s_y + c_y a_y), d_z likewise
    product of rates        d = kappa (B - A)/(B Omega) u_s u
    hunting e(t)            d = e (u - 2 K_t theta_0/(j B Omega)), since dk2 = -2 K_t e
    vibration at 2 Omega    d = (2 Jek - Jk)/(8 B) (1 + dJ/g) U exp(-j phase)

with dJ = Jek - Jk/2 and g = Jr - 2 Jer. Offset and noise of the pick-off pass through the rotor
and its loop: an offset theta_0 reads (k2 - j fe Omega) theta_0/(j B Omega), and a jump of the
pick-off error is read as an angle of J/B times the jump. The acceleration of the case,
(A/(B Omega)) u' on the other axis, is part of the rotor's own equation.
"""

import math

import numpy as np

from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.noise import indexed_noise
from ins_sim.core.numerics.units import DEG_H, STANDARD_GRAVITY
from .pair import spins

URAD = 1e-6
NONE = (0.0, 0.0, 0.0, 0.0)


def moments_by_force(rows, moments, along, spin):
    """
    Return moments plus the effect of specific force, for y and z of the first and second gyro.

    The functions below take floats or arrays alike.

    Parameters
    ----------
    rows : coefficients m, q, s, c of each channel
    moments : moments of the four channels, rad/s
    along : specific force along y, z of both cases, m/s^2
    spin : specific force along both spin axes, m/s^2
    """
    r1, r2, r3, r4 = rows
    y1, z1, y2, z2 = along
    a, b, c, d = moments
    return (a + _by_force(r1, y1, z1, spin[0]), b + _by_force(r2, z1, y1, spin[0]),
            c + _by_force(r3, y2, z2, spin[1]), d + _by_force(r4, z2, y2, spin[1]))


def _by_force(row, own, other, spin):
    m, q, s, c = row
    return m * own + q * other + spin * (s + c * own)


def moments_by_hunting(detuning, moments, speeds, cases, tilts):
    """
    Return moments plus the effect of the hunting of the rotor speed.

    Parameters
    ----------
    detuning : real and imaginary part of 2 j K_t/(B Omega), 1/s
    moments : moments of the four channels, rad/s
    speeds : relative errors of both rotor speeds
    cases : rates along y, z of both cases at mid-step, rad/s
    tilts : errors of the four pick-offs, rad
    """
    p, q = detuning
    a, b, c, d = moments
    u1, v1, u2, v2 = cases
    n1, o1, n2, o2 = tilts
    e, f = speeds
    return (a + e * (u1 + (p * n1 - q * o1)), b + e * (v1 + (p * o1 + q * n1)),
            c + f * (u2 + (p * n2 - q * o2)), d + f * (v2 + (p * o2 + q * n2)))


def moments_by_product(third, moments, cases, spin):
    """
    Return moments plus the mean products of rates over a step, by Simpson's rule.

    Parameters
    ----------
    third : a sixth of the factor kappa (B - A)/(B Omega)
    moments : moments of the four channels, rad/s
    cases : rates along y, z of both cases at start, middle and end of the step, rad/s
    spin : rates along both spin axes at the same instants, rad/s
    """
    start, middle, end = cases
    (s, t), (m, n), (e, f) = spin
    a, b, c, d = moments
    return (a + third * (start[0] * s + 4.0 * (middle[0] * m) + end[0] * e),
            b + third * (start[1] * s + 4.0 * (middle[1] * m) + end[1] * e),
            c + third * (start[2] * t + 4.0 * (middle[2] * n) + end[2] * f),
            d + third * (start[3] * t + 4.0 * (middle[3] * n) + end[3] * f))


class RotorErrors:
    """
    The disturbances of both gyros, one sampling period after the other.

    The noise of the pick-offs is a function of (seed, run, index). Raises ValueError for a rotor
    whose response to vibration at twice the speed is not defined.

    Parameters
    ----------
    errors : TunedGyroErrors
    pair : GyroPair
    seed, run : of the random streams
    dt_s : sampling period, s
    """

    def __init__(self, errors, pair, seed, run, dt_s):
        self._pair, self._dt_s = pair, dt_s
        per_g, per_g2 = DEG_H / STANDARD_GRAVITY, DEG_H / (STANDARD_GRAVITY * STANDARD_GRAVITY)
        self._by_force = tuple(
            (m * per_g, q * per_g, s * per_g, c * per_g2) for m, q, s, c in zip(
                errors.mass_unbalance_deg_h_g, errors.quadrature_unbalance_deg_h_g,
                errors.spin_axis_deg_h_g, errors.anisoelastic_deg_h_g2))
        self._forced = any(map(any, self._by_force))
        self._offsets = tuple(URAD * v for v in errors.pickoff_offset_urad)
        self._densities = tuple(URAD * n for n in errors.pickoff_noise_urad_sqrt_s)
        self._normals = None
        if any(self._densities):
            self._normals = indexed_noise(seed, run, 'gyro.dtg.pickoff', 4)
        scale = 1.0 / math.sqrt(dt_s)
        self._spreads = tuple(scale * d for d in self._densities)
        self._constant = tuple(part for each in zip(
            pair.gyros, errors.vibration_2n_deg_s, errors.vibration_2n_phase_deg)
            for part in _vibration(*each))
        p = pair.gyros[0].parameters
        per_moment = 1.0 / (p.input_inertia * p.omega)
        self.product_s = errors.spin_rate_product * (
            p.input_inertia - p.transverse_inertia) * per_moment
        hunting = 2.0 * math.pi * errors.hunting_hz
        half = 0.5 * hunting * dt_s
        # Factor from the amplitude of the wave to that of its mean over an interval.
        mean = elementary.sin(half) / half if half else 1.0
        self._hunting = tuple(1e-6 * a * mean for a in errors.hunting_ppm)
        self._hunting_rad_s = hunting if any(self._hunting) else 0.0
        # k2 at zero speed is the stiffness K_t of the hinges.
        self._detuning = 0.0, 2.0 * p.stiffness(0.0) * per_moment
        self._tilts = self._offsets
        self._sample = self._constant, self._offsets, NONE, (0.0, 0.0)

    def settle(self, w):
        """Set the rotors to the steady state at body rate w and the present offsets, no force."""
        self._tilts = self._offsets
        values = zip(*(zip(four[::2], four[1::2]) for four in (
            self._pair.into_cases(w), self._constant, self._offsets)))
        for rotor, three in zip(self._pair.gyros, values):
            rotor.settle(*(complex(*value) for value in three))

    def begin(self, t_ns, force):
        """Begin the sampling period ending at t_ns with this mean specific force in b, m/s^2."""
        tilts, speeds = self._offsets, (0.0, 0.0)
        if self._normals is not None:
            normals = self._normals.normal(t_ns // round(self._dt_s * 1e9))
            tilts = tuple([o + s * n for o, s, n in zip(tilts, self._spreads, normals)])
        if self._hunting_rad_s:
            speeds = self._speeds(t_ns)
        jumps = tuple([new - old for new, old in zip(tilts, self._tilts)])
        self._tilts = tilts
        self._sample = self._forced_moments(force), tilts, jumps, speeds

    def step(self, w_start, w_mid, w_end):
        """Return the disturbances of both gyros (d of ``rotor_step``) for one rotor step."""
        moments, tilts, jumps, speeds = self._sample
        self._sample = moments, tilts, NONE, speeds
        a, b, c, d = self._moments(moments, tilts, speeds, w_start, w_mid, w_end)
        n1, o1, n2, o2 = tilts
        j1, k1, j2, k2 = jumps
        return (a, b, n1, o1, j1, k1), (c, d, n2, o2, j2, k2)

    def block(self, t_ns, force, w_start, w_mid, w_end):
        """
        Return the disturbances of both gyros, (m, 6) each, for the m rotor steps of n periods.

        Parameters
        ----------
        t_ns : (n,) ends of the sampling periods, ns
        force : mean specific force of the periods, three columns (n,), m/s^2
        w_start, w_mid, w_end : body rates of the steps, three columns (m,), rad/s; m is a
            multiple of n
        """
        count, steps = len(t_ns), len(w_start[0]) // len(t_ns)
        tilts, speeds = [np.full(count, v) for v in self._offsets], (0.0, 0.0)
        if self._normals is not None:
            first = int(t_ns[0]) // round(self._dt_s * 1e9)
            normals = self._normals.normals(first, count).T
            tilts = [o + s * n for o, s, n in zip(tilts, self._spreads, normals)]
        if self._hunting_rad_s:
            speeds = [np.repeat(v, steps) for v in self._speeds(t_ns)]
        found = np.zeros((2, count * steps, 6))
        for k, (new, old) in enumerate(zip(tilts, self._tilts)):
            found[k // 2, ::steps, 4 + k % 2] = np.diff(new, prepend=old)
        self._tilts = tuple(float(v[-1]) for v in tilts)
        tilts = [np.repeat(v, steps) for v in tilts]
        moments = [np.repeat(np.broadcast_to(v, count), steps)
                   for v in self._forced_moments(force)]
        moments = self._moments(moments, tilts, speeds, w_start, w_mid, w_end)
        for k, (moment, tilt) in enumerate(zip(moments, tilts)):
            found[k // 2, :, k % 2], found[k // 2, :, 2 + k % 2] = moment, tilt
        return found

    def _forced_moments(self, force):
        if not self._forced:
            return self._constant
        return moments_by_force(self._by_force, self._constant, self._pair.into_cases(force),
                                spins(force))

    def _speeds(self, t_ns):
        """Return the relative errors of both rotor speeds."""
        wave = elementary.sin(self._hunting_rad_s * (t_ns * 1e-9 - 0.5 * self._dt_s))
        return self._hunting[0] * wave, self._hunting[1] * wave

    def _moments(self, moments, tilts, speeds, w_start, w_mid, w_end):
        """Return the moments of one step (or many): those of its period plus rate effects."""
        into_cases = self._pair.into_cases
        if self._hunting_rad_s:
            moments = moments_by_hunting(self._detuning, moments, speeds, into_cases(w_mid), tilts)
        if self.product_s:
            rates = w_start, w_mid, w_end
            moments = moments_by_product(self.product_s / 6.0, moments,
                                         [into_cases(w) for w in rates],
                                         [spins(w) for w in rates])
        return moments

    def noise_variances(self):
        """Return the variances of the channel means due to pick-off noise, (rad/s)^2."""
        if self._normals is None:
            return (0.0,) * 4
        from .stability import pickoff_gain
        gains = [pickoff_gain(rotor, self._dt_s) for rotor in self._pair.gyros]
        return tuple(gain * d * d / self._dt_s
                     for d, gain in zip(self._densities, np.repeat(gains, 2).tolist()))


def _vibration(rotor, amplitude_deg_s, phase_deg):
    """Return the moments y and z due to a vibration at twice the rotor speed, rad/s."""
    if not amplitude_deg_s:
        return 0.0, 0.0
    size = math.radians(amplitude_deg_s) * rotor.parameters.vibration_2n_factor
    s, c = elementary.sincos(math.radians(phase_deg))
    return size * c, -size * s
