"""Motions on one spot, as on a test bench, in closed form."""

import math

import numpy as np

from ins_sim.core.attitude import angles as attitude_angles
from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import taylor
from .motion import Motion

TWO_PI = 2.0 * math.pi
LEVEL_AXES = {'east': 0, 'north': 1, 'up': 2}
BODY_AXES = {'x': 0, 'y': 1, 'z': 2}


class _Place:
    """The datum, and small excursions about it."""

    def __init__(self, datum):
        self.lat, self.lon = math.radians(datum.latitude_deg), math.radians(datum.longitude_deg)
        self.height = datum.height_m

    def coordinates(self, t, excursion):
        """Return lat, lon, height of E, N, U (Series or None)."""
        if excursion is None:
            return t.constant(self.lat), t.constant(self.lon), t.constant(self.height)
        return ellipsoid.moved(self.lat, self.lon, self.height, excursion)


def _base(motion, t):
    return attitude_angles.from_angles(*(t.constant(math.radians(a)) for a in (
        motion.psi_deg, motion.theta_deg, motion.gamma_deg)))


def _static(motion):
    return (lambda t: _base(motion, t)), None


def _rocking(motion):
    """Motion 1: kappa0 sin(w t) about a level axis (from the left) or a body axis."""
    s = motion.rocking
    w, amplitude = TWO_PI * s.frequency_hz, math.radians(s.amplitude_deg)

    def orientation(t):
        angle = taylor.sin(t * w) * amplitude
        base = _base(motion, t)
        if s.axis in LEVEL_AXES:
            return quaternion.multiply(attitude_angles.about_axis(LEVEL_AXES[s.axis], angle), base)
        return quaternion.multiply(base, attitude_angles.about_axis(BODY_AXES[s.axis], angle))

    return orientation, 1.0 / s.frequency_hz if s.frequency_hz else None


def _two_axis(motion):
    """Motion 2: psi and gamma run uniformly, theta stands."""
    s = motion.two_axis
    psi_rate = s.psi_rate_rad_s + s.detuning_rad_s

    def orientation(t):
        return attitude_angles.from_angles(t * psi_rate + math.radians(motion.psi_deg),
                                           t.constant(math.radians(motion.theta_deg)),
                                           t * s.gamma_rate_rad_s + math.radians(motion.gamma_deg))

    return orientation, _common_period(psi_rate, s.gamma_rate_rad_s)


def _common_period(*rates):
    """Return the common period of uniform rotations if it is at most 64 turns, else None."""
    rates = [abs(r) for r in rates if r]
    if not rates:
        return None
    slowest = min(rates)
    for turns in range(1, 65):
        ratios = [r * turns / slowest for r in rates]
        if all(abs(x - round(x)) < 1e-12 * x for x in ratios):
            return turns * TWO_PI / slowest
    return None


def _coning(motion):
    """The axis k of the body describes a cone: rotation vector A (cos w t, sin w t) across k."""
    s = motion.coning
    k = BODY_AXES[s.axis]
    half, w = 0.5 * math.radians(s.half_angle_deg), TWO_PI * s.frequency_hz

    def orientation(t):
        sw, cw = taylor.sincos(t * w)
        q = [None, None, None, t.constant(math.cos(half))]
        q[k] = t.constant(0.0)
        q[(k + 1) % 3], q[(k + 2) % 3] = cw * math.sin(half), sw * math.sin(half)
        return quaternion.multiply(_base(motion, t), q)

    return orientation, 1.0 / s.frequency_hz if s.frequency_hz else None


def _sculling(motion):
    """Rocking about the vertical; ``_vibration`` is the other half."""
    s = motion.sculling

    def orientation(t):
        angle = taylor.sin(t * (TWO_PI * s.frequency_hz)) * math.radians(s.amplitude_deg)
        return quaternion.multiply(attitude_angles.about_axis(2, angle), _base(motion, t))

    return orientation, 1.0 / s.frequency_hz


def _vibration(motion):
    s = motion.sculling
    w = TWO_PI * s.frequency_hz
    reach = -s.acceleration_m_s2 / (w * w)
    psi, phase = math.radians(motion.psi_deg), math.radians(s.phase_deg)

    def path(t):
        forward = taylor.sin(t * w + phase) * reach
        return forward * -math.sin(psi), forward * math.cos(psi), forward * 0.0

    return path


def _no_path(motion):
    return lambda t: None


def _sines(t, amplitudes, rates, phases):
    return [taylor.sin(t * w + p) * a for a, w, p in zip(amplitudes, rates, phases)]


def _sinusoids(motion):
    s = motion.sinusoids
    mean = np.radians((motion.psi_deg, motion.theta_deg, motion.gamma_deg)).tolist()
    amplitudes, phases = np.radians(s.angle_deg).tolist(), np.radians(s.angle_phase_deg).tolist()
    rates = [TWO_PI * f for f in s.angle_hz]

    def orientation(t):
        swings = _sines(t, amplitudes, rates, phases)
        return attitude_angles.from_angles(*(x + m for x, m in zip(swings, mean)))

    return orientation, _common_period(*(w for w, a in zip(rates, amplitudes) if a))


def _sway(motion):
    s = motion.sinusoids
    rates = [TWO_PI * f for f in s.position_hz]
    phases = np.radians(s.position_phase_deg).tolist()
    return lambda t: _sines(t, s.position_m, rates, phases)


def _harmonics(motion):
    s = motion.harmonics
    w = TWO_PI / s.period_s
    angles = []
    for name in ('psi', 'theta', 'gamma'):
        amplitudes = np.radians(getattr(s, f'{name}_deg')).tolist()
        phases = np.radians(getattr(s, f'{name}_phase_deg')).tolist()
        if len(amplitudes) != len(phases):
            raise ValueError(f'motion.harmonics.{name}_phase_deg has {len(phases)} entries; '
                             f'expected {len(amplitudes)}, one for each of '
                             f'motion.harmonics.{name}_deg')
        angles.append((math.radians(getattr(motion, f'{name}_deg')), amplitudes, phases))

    def orientation(t):
        sums = []
        for mean, amplitudes, phases in angles:
            rates = [w * (k + 1) for k in range(len(amplitudes))]
            sums.append(sum(_sines(t, amplitudes, rates, phases), t.constant(mean)))
        return attitude_angles.from_angles(*sums)

    return orientation, s.period_s


_ATTITUDES = {'rocking': _rocking, 'two_axis': _two_axis, 'coning': _coning,
              'sculling': _sculling, 'sinusoids': _sinusoids, 'harmonics': _harmonics}
_PATHS = {'sculling': _vibration, 'sinusoids': _sway}


def bench_motion(motion, datum, earth):
    """
    Return the bench motion of MotionSettings at a Datum; earth: Earth.

    Raises ValueError on settings that no motion can have.
    """
    orientation, period_s = _ATTITUDES.get(motion.kind, _static)(motion)
    path = _PATHS.get(motion.kind, _no_path)(motion)
    place = _Place(datum)

    def pose(t):
        return *place.coordinates(t, path(t)), orientation(t)

    return Motion(pose, 2, earth.rotation, period_s)
