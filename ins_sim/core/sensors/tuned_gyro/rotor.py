"""
The dynamically tuned gyro: parameters and equations of motion.

Case axes are right-handed: x_c is the spin axis, y_c and z_c are the sensitive axes. Vectors in
the sensitive plane are complex numbers, u = u_y + j u_z. Let theta be the tilt of the rotor in the
case, u the inertial rate of the case, and M the moment of the torquer. With v = theta' + u the
derivative u' does not appear (docs/theory/tuned_gyro.md; Sapegin, Romanov and Bugaiov 2016):

    theta' = v - u,   A v' = -(f - j H) v - (k2 - j c) theta + (f - j (H - B Omega)) u + M

Open loop: M = 0, and the reading is -c theta / (B Omega). Closed loop: M = -[Dc s + dc - j K +
(di - j Ki) / s] theta, and the reading is j M / (B Omega). Read-out and loop gains are electronic
and stay those of the nominal speed, even if the rotor turns at another speed.

Disturbances: a moment on the rotor is expressed as the equivalent rate d, M = j B Omega d. The
pick-off measures theta + n, where n is its offset and noise, for loop and read-out alike.
"""

from dataclasses import dataclass, fields
import math
from types import MappingProxyType

LOOPS = ('open', 'closed')
# Largest relative difference between the nominal speed and the speed the hinges are tuned to.
TUNING_TOLERANCE = 0.01


@dataclass(frozen=True)
class TunedGyroParameters:
    """
    Physical parameters of a tuned gyro, SI; symbols of the equations in brackets.

    Raises ValueError for values that no such instrument can have.

    Attributes
    ----------
    rotor_axial_kg_m2, rotor_equatorial_kg_m2 : inertias of the rotor [Jr, Jer]
    ring_axial_kg_m2, ring_equatorial_kg_m2 : inertias of the ring [Jk, Jek]
    speed_hz : nominal speed of the rotor [Omega / 2 pi]
    rotating_damping_n_m_s : damping that turns with the shaft [fe]
    case_damping_n_m_s : damping by the case [D]
    cross_feedback_n_m_rad : feedback from pick-off to torquer, turned by +j; open loop only [K]
    hinge_stiffness_n_m_rad : mean of the two hinges [(K_alpha + K_beta) / 2]; None for the value
        that tunes the rotor at speed_hz
    loop : open or closed
    natural_rad_s, damping_ratio, nutation_rad_s : natural frequency [w0], damping [zeta] and decay
        of the nutation [Wn] that the closed loop is designed for
    """

    rotor_axial_kg_m2: float
    rotor_equatorial_kg_m2: float
    ring_axial_kg_m2: float
    ring_equatorial_kg_m2: float
    speed_hz: float
    rotating_damping_n_m_s: float = 0.0
    case_damping_n_m_s: float = 0.0
    cross_feedback_n_m_rad: float = 0.0
    hinge_stiffness_n_m_rad: float | None = None
    loop: str = 'open'
    natural_rad_s: float = 2.0 * math.pi * 35.0
    damping_ratio: float = 1.0
    nutation_rad_s: float = 200.0

    def __post_init__(self):
        """Check the parameters for consistency with each other."""
        if self.loop not in LOOPS:
            raise ValueError(f'loop is {self.loop!r}; expected open or closed')
        positive = {'rotor_axial_kg_m2', 'rotor_equatorial_kg_m2', 'speed_hz'}
        if self.loop == 'closed':
            positive |= {'natural_rad_s', 'damping_ratio', 'nutation_rad_s'}
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == 'loop' or value is None and 'hinge' in field.name:
                continue
            if not (isinstance(value, (int, float)) and math.isfinite(value)):
                raise ValueError(f'{field.name} is {value!r}; expected a finite number')
            if value < 0.0 or value == 0.0 and field.name in positive:
                raise ValueError(f'{field.name} is {value:g}; expected a number '
                                 + ('above 0' if field.name in positive else 'not below 0'))
        for part in ('rotor', 'ring'):
            axial = getattr(self, f'{part}_axial_kg_m2')
            equatorial = getattr(self, f'{part}_equatorial_kg_m2')
            if axial > 2.0 * equatorial:
                raise ValueError(f'{part}_axial_kg_m2 is {axial:g}; expected at most twice '
                                 f'{part}_equatorial_kg_m2, {2.0 * equatorial:g}: no rigid body '
                                 'has more')
        self._check_tuning()
        if self.loop == 'closed' and self.cross_feedback_n_m_rad:
            raise ValueError(f'cross_feedback_n_m_rad is {self.cross_feedback_n_m_rad:g} with '
                             'loop closed; expected 0, as the loop sets its own')
        if self.loop == 'open' and self.coupling == 0.0:
            raise ValueError('cross_feedback_n_m_rad and rotating_damping_n_m_s are 0 with loop '
                             'open; expected one above 0, as the reading is proportional to them')

    def _check_tuning(self):
        """Raise ValueError for hinges that tune the rotor to another speed."""
        if self.hinge_stiffness_n_m_rad is None:
            return
        per_speed = self.ring_equatorial_kg_m2 - 0.5 * self.ring_axial_kg_m2
        tuned_hz = (math.sqrt(self.hinge_stiffness_n_m_rad / per_speed) / (2.0 * math.pi)
                    if per_speed > 0.0 else math.inf)
        if not abs(tuned_hz - self.speed_hz) <= TUNING_TOLERANCE * self.speed_hz:
            raise ValueError(f'hinge_stiffness_n_m_rad is {self.hinge_stiffness_n_m_rad:g}, which '
                             f'tunes the rotor at {tuned_hz:.6g} Hz; expected within '
                             f'{TUNING_TOLERANCE:.0%} of speed_hz, {self.speed_hz:g}')

    @property
    def transverse_inertia(self):
        """A = Jer + Jek / 2, kg m^2."""
        return self.rotor_equatorial_kg_m2 + 0.5 * self.ring_equatorial_kg_m2

    @property
    def input_inertia(self):
        """B = Jr + Jk / 2, kg m^2."""
        return self.rotor_axial_kg_m2 + 0.5 * self.ring_axial_kg_m2

    @property
    def axial_inertia(self):
        """J = Jr + Jek, kg m^2."""
        return self.rotor_axial_kg_m2 + self.ring_equatorial_kg_m2

    @property
    def omega(self):
        """Omega, the nominal spin speed, rad/s."""
        return 2.0 * math.pi * self.speed_hz

    @property
    def momentum(self):
        """H = J Omega, N m s."""
        return self.axial_inertia * self.omega

    @property
    def coupling(self):
        """c = fe Omega + K, N m/rad; in closed loop K is the gain designed for the loop."""
        closed = self.loop == 'closed'
        feedback = -loop_gains(self)[1].imag if closed else self.cross_feedback_n_m_rad
        return self.rotating_damping_n_m_s * self.omega + feedback

    @property
    def damping(self):
        """f = fe + D, N m s."""
        return self.rotating_damping_n_m_s + self.case_damping_n_m_s

    @property
    def vibration_2n_factor(self):
        """
        Drift per amplitude of an angular vibration at 2 Omega: (2Jek - Jk)(1 + dJ/g)/(8B).

        Here dJ = Jek - Jk/2 and g = Jr - 2 Jer. The ring follows the rotor about one of its axes
        only and thereby rectifies the vibration to a constant moment. Raises ValueError for a flat
        rotor, whose nutation is at 2 Omega.
        """
        d = self.ring_equatorial_kg_m2 - 0.5 * self.ring_axial_kg_m2
        g = self.rotor_axial_kg_m2 - 2.0 * self.rotor_equatorial_kg_m2
        if g == 0.0:
            raise ValueError('rotor_axial_kg_m2 is twice rotor_equatorial_kg_m2 with a vibration '
                             'at twice the speed; expected less, as such a rotor resonates')
        return 2.0 * d * (1.0 + d / g) / (8.0 * self.input_inertia)

    def stiffness(self, speed_hz=None):
        """Return the residual stiffness k2 at a speed, N m/rad; by default at the nominal one."""
        omega = self.omega if speed_hz is None else 2.0 * math.pi * speed_hz
        per_speed = self.ring_equatorial_kg_m2 - 0.5 * self.ring_axial_kg_m2
        if self.hinge_stiffness_n_m_rad is None:
            return per_speed * (self.omega - omega) * (self.omega + omega)
        return self.hinge_stiffness_n_m_rad - per_speed * omega * omega


_ROTOR = {'rotor_axial_kg_m2': 5.0e-6, 'rotor_equatorial_kg_m2': 2.82e-6,
          'ring_axial_kg_m2': 1.5e-7, 'ring_equatorial_kg_m2': 1.0e-7,
          'rotating_damping_n_m_s': 1.0e-7, 'speed_hz': 230.0}
# The rotor of Sapegin, Romanov and Bugaiov (2016) is physically unstable (its nutation grows with
# 7.45 1/s); RK4 with a step of 0.75 ms hides this.
PRESETS = MappingProxyType({
    'sapegin_2016': TunedGyroParameters(**_ROTOR, cross_feedback_n_m_rad=0.0550),
    'sapegin_2016_damped': TunedGyroParameters(**_ROTOR, cross_feedback_n_m_rad=0.0550,
                                               case_damping_n_m_s=3.80e-5),
    'tactical': TunedGyroParameters(**_ROTOR, case_damping_n_m_s=6.0e-7, loop='closed')})


def loop_gains(p):
    """
    Return the derivative, proportional and integral gains Dc, dc - j K and di - j Ki.

    They are chosen so that the characteristic polynomial becomes
    (A (s + Wn) - j H)(s^2 + 2 zeta w0 s + w0^2).
    """
    a, h, w0, wn = p.transverse_inertia, p.momentum, p.natural_rad_s, p.nutation_rad_s
    twice = 2.0 * p.damping_ratio * w0
    return (a * (wn + twice) - p.damping,
            complex(a * (twice * wn + w0 * w0) - p.stiffness(),
                    p.rotating_damping_n_m_s * p.omega - twice * h),
            complex(a * wn * w0 * w0, -h * w0 * w0))
