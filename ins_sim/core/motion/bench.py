"""Motions at a fixed position, as on a test bench, in closed form."""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import from_angles
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import elementary, taylor
from ins_sim.core.numerics.compilation import run
from . import bench_attitudes as attitudes
from .motion import check_latitude, Motion
from .truth import translation, truth_of

TWO_PI = 2.0 * math.pi
UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
LEVEL_AXES = {'east': UNIT[0], 'north': UNIT[1], 'up': UNIT[2]}
BODY_AXES = {'x': 0, 'y': 1, 'z': 2}


class BenchMotion(Motion):
    """
    A motion at a fixed position, with an optional small excursion about it.

    Parameters
    ----------
    attitude : a function of ``bench_attitudes``
    constants : the constants of that function
    datum : Datum of the place
    excursion : function from the Series of time to the displacement east, north, up (m), or None
    earth : Earth
    period_s : see Motion
    """

    def __init__(self, attitude, constants, datum, excursion, earth, period_s):
        self._attitude, self._constants = attitude, constants
        self._spot = (math.radians(datum.latitude_deg), math.radians(datum.longitude_deg),
                      datum.height_m)
        self._excursion = excursion

        def pose(t):
            return *self._path(t), attitude(constants, t)

        super().__init__(pose, 2, earth.rotation, period_s, self._path, earth.gravity)
        self._still = None
        if excursion is None:
            # The position is fixed: velocity, rate and specific force in n are constant.
            found = translation(*self._path(taylor.Series.time(np.zeros(1), 2)), earth.rotation,
                                earth.gravity)
            self._still = tuple(tuple(float(x[0]) for x in vector) for vector in found)

    def _path(self, t):
        if self._excursion is None:
            return tuple(t.constant(x) for x in self._spot)
        return ellipsoid.moved(*self._spot, self._excursion(t))

    def at(self, t_ns):
        """Return the Truth at motion times t_ns (n,) int64."""
        if self._still is None:
            return super().at(t_ns)
        t = taylor.Series.time(np.asarray(t_ns) * 1e-9, 1)
        return truth_of(t_ns, self._spot, *self._still, self._attitude(self._constants, t))

    def attitude_at(self, t_ns):
        """Return latitude and longitude (floats if the position is fixed) and q_nb (n, 4)."""
        t = np.asarray(t_ns) * 1e-9
        q_nb = np.empty((len(t), 4))
        run(attitudes.ROWS[self._attitude], len(t), (self._constants, t), q_nb, self._rows)
        if self._excursion is None:
            return *self._spot[:2], q_nb
        lat, lon, _ = self._path(taylor.Series.time(t, 0))
        check_latitude(t_ns, lat.value)
        return lat.value, lon.value, q_nb

    def _rows(self, constants, t, out):
        for k, component in enumerate(self._attitude(constants, t)):
            out[:, k] = component

    def force_at(self, t_ns):
        """Return latitude, longitude and specific force in n; floats if the position is fixed."""
        if self._still is None:
            return super().force_at(t_ns)
        return *self._spot[:2], self._still[2]

    def body_force_at(self, t_ns):
        """Return the specific force in b, three arrays (n,), m/s^2."""
        if self._still is None:
            return super().body_force_at(t_ns)
        return quaternion.rotate_back(self.attitude_at(t_ns)[2].T, self._still[2])


def _base(motion):
    return from_angles(*(math.radians(a) for a in (motion.psi_deg, motion.theta_deg,
                                                   motion.gamma_deg)))


def _static(motion):
    return attitudes.static, _base(motion), None


def _rocking(motion):
    """Motion 1: kappa0 sin(w t) about a level axis (from the left) or a body axis."""
    s = motion.rocking
    w, amplitude = TWO_PI * s.frequency_hz, math.radians(s.amplitude_deg)
    period_s = 1.0 / s.frequency_hz if s.frequency_hz else None
    if s.axis in LEVEL_AXES:
        return (attitudes.rocking_left, (_base(motion), LEVEL_AXES[s.axis], amplitude, w),
                period_s)
    return (attitudes.rocking_right, (_base(motion), UNIT[BODY_AXES[s.axis]], amplitude, w),
            period_s)


def _two_axis(motion):
    """Motion 2: psi and gamma change at constant rates, theta is constant."""
    s = motion.two_axis
    psi_rate = s.psi_rate_rad_s + s.detuning_rad_s
    constants = (psi_rate, math.radians(motion.psi_deg), math.radians(motion.theta_deg),
                 s.gamma_rate_rad_s, math.radians(motion.gamma_deg))
    return attitudes.two_axis, constants, _common_period(psi_rate, s.gamma_rate_rad_s)


def _common_period(*rates):
    """Return the common period of constant-rate rotations if it is at most 64 turns, else None."""
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
    """Coning: the body axis k describes a cone; rotation vector A (cos w t, sin w t) across k."""
    s = motion.coning
    k = BODY_AXES[s.axis]
    sine, cosine = elementary.sincos(0.5 * math.radians(s.half_angle_deg))
    constants = (_base(motion), UNIT[(k + 1) % 3], UNIT[(k + 2) % 3], sine, cosine,
                 TWO_PI * s.frequency_hz)
    return attitudes.coning, constants, 1.0 / s.frequency_hz if s.frequency_hz else None


def _sculling(motion):
    """Rocking about the vertical; ``_vibration`` is the translational part of sculling."""
    s = motion.sculling
    constants = (_base(motion), LEVEL_AXES['up'], math.radians(s.amplitude_deg),
                 TWO_PI * s.frequency_hz)
    return attitudes.rocking_left, constants, 1.0 / s.frequency_hz


def _vibration(motion):
    s = motion.sculling
    w = TWO_PI * s.frequency_hz
    reach = -s.acceleration_m_s2 / (w * w)
    phase = math.radians(s.phase_deg)
    sin_psi, cos_psi = elementary.sincos(math.radians(motion.psi_deg))

    def path(t):
        forward = attitudes.wave(reach, w, phase, t)
        return forward * -sin_psi, forward * cos_psi, forward * 0.0

    return path


def _no_path(motion):
    return None


def _sinusoids(motion):
    s = motion.sinusoids
    means = (motion.psi_deg, motion.theta_deg, motion.gamma_deg)
    rates = [TWO_PI * f for f in s.angle_hz]
    constants = tuple((math.radians(mean), math.radians(a), w, math.radians(phase))
                      for mean, a, w, phase in zip(means, s.angle_deg, rates, s.angle_phase_deg))
    period_s = _common_period(*(w for w, a in zip(rates, s.angle_deg) if a))
    return attitudes.sinusoids, constants, period_s


def _sway(motion):
    s = motion.sinusoids
    waves = [(a, TWO_PI * f, math.radians(phase))
             for a, f, phase in zip(s.position_m, s.position_hz, s.position_phase_deg)]
    return lambda t: [attitudes.wave(*wave, t) for wave in waves]


def _harmonics(motion):
    s = motion.harmonics
    angles = []
    for name in ('psi', 'theta', 'gamma'):
        amplitudes, phases = getattr(s, f'{name}_deg'), getattr(s, f'{name}_phase_deg')
        if len(amplitudes) != len(phases):
            raise ValueError(f'motion.harmonics.{name}_phase_deg has {len(phases)} entries; '
                             f'expected {len(amplitudes)}, one for each of '
                             f'motion.harmonics.{name}_deg')
        # At least one entry, so that the compiler can infer the type of the entries.
        angles.append((math.radians(getattr(motion, f'{name}_deg')),
                       tuple(map(math.radians, amplitudes)) or (0.0,),
                       tuple(map(math.radians, phases)) or (0.0,)))
    return attitudes.harmonics, (TWO_PI / s.period_s, *angles), s.period_s


_ATTITUDES = {'rocking': _rocking, 'two_axis': _two_axis, 'coning': _coning,
              'sculling': _sculling, 'sinusoids': _sinusoids, 'harmonics': _harmonics}
_PATHS = {'sculling': _vibration, 'sinusoids': _sway}


def bench_motion(motion, datum, earth):
    """
    Return the bench motion of MotionSettings at a Datum; earth: Earth.

    Raises ValueError for settings that describe no valid motion.
    """
    attitude, constants, period_s = _ATTITUDES.get(motion.kind, _static)(motion)
    excursion = _PATHS.get(motion.kind, _no_path)(motion)
    return BenchMotion(attitude, constants, datum, excursion, earth, period_s)
