"""
Settings of the pair of dynamically tuned gyros and of its study.

Every default error is that of a perfect pair.

Lists of two are by gyro, lists of four by channel (gyro_1_y, gyro_1_z, gyro_2_y, gyro_2_z), y
and z being the sensitive axes of a gyro's case (``ins_sim.core.sensors.tuned_gyro.pair``).
"""

import math

from .field import group, setting, settings_class, SettingsGroup

MOST = 1e9
# Names of the rotors whose parameters are in ``core.sensors.tuned_gyro.rotor.PRESETS``.
ROTORS = ('sapegin_2016', 'sapegin_2016_damped', 'tactical')


def by_gyro(doc, unit, low=0.0, high=MOST):
    """Return a setting of two numbers, by gyro."""
    return setting((0.0,) * 2, doc, unit, low, high, size=2)


def by_channel(doc, unit, low=-MOST, high=MOST):
    """Return a setting of four numbers, by channel."""
    return setting((0.0,) * 4, doc, unit, low, high, size=4)


@settings_class
class CustomTunedGyro(SettingsGroup):
    """The gyro of preset custom; by default that of preset tactical."""

    rotor_axial_kg_m2: float = setting(5.0e-6, 'axial inertia of the rotor, Jr', 'kg m^2', 0.0,
                                       1.0)
    rotor_equatorial_kg_m2: float = setting(2.82e-6, 'equatorial inertia of the rotor, Jer',
                                            'kg m^2', 0.0, 1.0)
    ring_axial_kg_m2: float = setting(1.5e-7, 'axial inertia of the ring, Jk', 'kg m^2', 0.0, 1.0)
    ring_equatorial_kg_m2: float = setting(1.0e-7, 'equatorial inertia of the ring, Jek', 'kg m^2',
                                           0.0, 1.0)
    speed_hz: float = setting(230.0, 'nominal speed of the rotor, Omega / 2 pi', 'Hz', 0.0, 1e5)
    rotating_damping_n_m_s: float = setting(1.0e-7, 'damping that turns with the shaft, fe',
                                            'N m s', 0.0, 1.0)
    case_damping_n_m_s: float = setting(6.0e-7, 'damping that does not turn, D', 'N m s', 0.0, 1.0)
    cross_feedback_n_m_rad: float = setting(0.0, 'pick-off to torquer, turned by +j, K; loop open '
                                            'only', 'N m/rad', 0.0, 1e3)
    hinge_stiffness_n_m_rad: float = setting(0.0, 'mean stiffness of the two hinges; 0 = the one '
                                             'that tunes the rotor at speed_hz', 'N m/rad', 0.0,
                                             1e3)
    loop: str = setting('closed', 'open: the tilt is read; closed: the torquer holds the rotor, '
                        'and its moment is read', choices=('open', 'closed'))
    natural_rad_s: float = setting(2.0 * math.pi * 35.0, 'natural frequency of the closed '
                                   'loop', 'rad/s', 0.0, 1e6)
    damping_ratio: float = setting(1.0, 'its damping ratio', '', 0.0, 100.0)
    nutation_rad_s: float = setting(200.0, 'decay of the nutation in the closed loop', '1/s', 0.0,
                                    1e6)


@settings_class
class TunedGyroErrors(SettingsGroup):
    """What disturbs the rotors and their pick-offs (the read-out: gyro.errors)."""

    mass_unbalance_deg_h_g: tuple[float, ...] = by_channel(
        'drift by specific force along the same axis', 'deg/h/g')
    quadrature_unbalance_deg_h_g: tuple[float, ...] = by_channel(
        'drift by specific force along the other sensitive axis; of a rigid rotor opposite on y '
        'and z', 'deg/h/g')
    spin_axis_deg_h_g: tuple[float, ...] = by_channel(
        'drift by specific force along the spin axis', 'deg/h/g')
    anisoelastic_deg_h_g2: tuple[float, ...] = by_channel(
        'drift by the product of specific forces along the spin and the same axis (rectifies '
        'vibration)', 'deg/h/g^2')
    pickoff_offset_urad: tuple[float, ...] = by_channel(
        'tilt at which the pick-off reads zero', 'urad', -1e5, 1e5)
    pickoff_noise_urad_sqrt_s: tuple[float, ...] = by_channel(
        'white noise of the pick-off: n^2/dt is the variance of its mean over dt',
        'urad sqrt(s)', 0.0, 1e5)
    speed_ppm: tuple[float, ...] = by_gyro(
        'speed of the rotor off the nominal one, which also detunes it', 'ppm', -1e5, 1e5)
    hunting_ppm: tuple[float, ...] = by_gyro('amplitude of the hunting of the speed', 'ppm', 0.0,
                                             1e5)
    hunting_hz: float = setting(3.0, 'frequency of the hunting', 'Hz', 1e-3, 100.0)
    spin_rate_product: float = setting(
        0.0, 'part of the product (B - A)/(B Omega) of spin-axis and sensitive rate that is left '
        'uncompensated; 1 = all', '', -1.0, 1.0)
    vibration_2n_deg_s: tuple[float, ...] = by_gyro(
        'amplitude of the angular vibration at twice the speed of the rotor', 'deg/s', 0.0, 1e4)
    vibration_2n_phase_deg: tuple[float, ...] = by_gyro(
        'its phase to the hinges of the rotor plus the direction of its axis from y', 'deg',
        -360.0, 360.0)


@settings_class
class TunedGyroFault(SettingsGroup):
    """A fault of one channel, in time or by the service ~/fault."""

    channel: str = setting('none', 'which channel',
                           choices=('none', 'gyro_1_y', 'gyro_1_z', 'gyro_2_y', 'gyro_2_z'))
    bias_deg_h: float = setting(0.0, 'added to its reading', 'deg/h', -MOST, MOST)
    scale: float = setting(1.0, 'factor of its reading; 0 = dead', '', -1e3, 1e3)
    start_s: float = setting(0.0, 'motion time of its begin; below 0 = only by the service', 's',
                             -1.0, 1e7)
    end_s: float = setting(1e7, 'motion time of its end', 's', 0.0, 1e7)


@settings_class
class ParitySettings(SettingsGroup):
    """The test of the four channels against each other."""

    window_s: float = setting(1.0, 'the parity is averaged over this time', 's', 1e-3, 1e4)
    threshold_deg_h: float = setting(0.0, 'mean parity that is reported as a fault; 0 = from '
                                     'noise, sigmas and present motion', 'deg/h', 0.0, MOST)


@settings_class
class TunedGyroPairSettings(SettingsGroup):
    """Two dynamically tuned gyros in place of the ideal triad."""

    preset: str = setting('tactical', 'parameters of both gyros '
                          '(sensors.tuned_gyro.rotor.PRESETS), or custom; sapegin_2016, the '
                          'rotor of that paper, is unstable, and only RK4 at 0.332 to 1.099 ms '
                          'damps it',
                          choices=(*ROTORS, 'custom'))
    custom: CustomTunedGyro = group(CustomTunedGyro)
    arrangement: str = setting('paper', 'paper: gyro 1 senses x and y, gyro 2 senses z and x; '
                               'turned: each pick-off pair turned 45 deg about its spin axis',
                               choices=('paper', 'turned'))
    method: str = setting('exact', 'propagation of the rotors: matrix exponential or RK4',
                          choices=('exact', 'rk4'))
    hold: str = setting('quadratic', 'rate within a step of the exact method: the parabola or the '
                        'straight line', choices=('quadratic', 'linear'))
    steps_per_sample: int = setting(1, 'steps of the rotors in a sampling period', 'steps', 1,
                                    1000)
    on_unstable: str = setting('refuse', 'rotors or steps that grow: refuse them, or warn and run',
                               choices=('refuse', 'warn'))
    errors: TunedGyroErrors = group(TunedGyroErrors)
    fault: TunedGyroFault = group(TunedGyroFault)
    parity: ParitySettings = group(ParitySettings)


SWEEPS = {'base_rate': 'base rate [rad/s]', 'rotor_speed': 'rotor speed [Hz]'}


@settings_class
class TunedGyroStudySettings(SettingsGroup):
    """One table and its figure: a rocking base recovered through two tuned gyros."""

    sweep: str = setting('base_rate', 'what the values are: angular frequency of the base or '
                         'speed of the rotors, tuned there', choices=tuple(SWEEPS))
    values: tuple[float, ...] = setting((1.0,), 'values of the table, rad/s or Hz', '', 1e-3, 1e4)
    paper_deg: tuple[float, ...] = setting((), 'what the paper prints for each of them; none = '
                                           'no comparison', 'deg', 0.0, 90.0)
    paper_limits_hz: tuple[float, ...] = setting((), 'lowest and highest stable speed in the '
                                                 'paper; none = no comparison', 'Hz', 1e-3, 1e4)
    curve_values: tuple[float, ...] = setting((), 'values of the curve in the figure; none = '
                                              'those of the table', '', 1e-3, 1e4)
    amplitude_deg: float = setting(10.0, 'amplitude of the rocking in roll', 'deg', 1e-3, 89.0)
    base_rate_rad_s: float = setting(1.0, 'angular frequency of the base where the speed is swept',
                                     'rad/s', 1e-3, 1e4)
    rotor_speed_hz: float = setting(230.0, 'speed of the rotors where the base rate is swept, and '
                                    'where the search for the limits begins', 'Hz', 1e-3, 1e4)
    preset: str = setting('sapegin_2016', 'parameters of both gyros '
                          '(sensors.tuned_gyro.rotor.PRESETS)',
                          choices=ROTORS)
    method: str = setting('rk4', 'integration of the gyros: rk4 as in the paper, or exact',
                          choices=('rk4', 'exact'))
    step_ms: float = setting(0.75, 'step of gyros and orientation', 'ms', 1e-3, 100.0)

    def check(self):
        """Check the lists against each other."""
        if len(self.paper_deg) not in (0, len(self.values)):
            raise ValueError(f'paper_deg has {len(self.paper_deg)} entries; expected none or '
                             f'{len(self.values)}, one for each of values')
        if len(self.paper_limits_hz) not in (0, 2):
            raise ValueError(f'paper_limits_hz has {len(self.paper_limits_hz)} entries; expected '
                             'none or 2')
        if not self.values:
            raise ValueError('values is empty; expected at least one')
