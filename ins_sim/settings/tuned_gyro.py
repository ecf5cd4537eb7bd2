"""
Settings of the pair of dynamically tuned gyros and of its study.

The defaults are error-free.

Lists of two are by gyro, lists of four by channel: gyro_1_y, gyro_1_z, gyro_2_y, gyro_2_z. Here y
and z are the sensitive axes of the case of a gyro (``ins_sim.core.sensors.tuned_gyro.pair``).
"""

import math

from .field import group, setting, settings_class, SettingsGroup

MOST = 1e9
# Names of the rotor presets in ``core.sensors.tuned_gyro.rotor.PRESETS``.
ROTORS = ('sapegin_2016', 'sapegin_2016_damped', 'tactical')


def by_gyro(doc, unit, low=0.0, high=MOST):
    """Return a setting of two numbers, one for each gyro."""
    return setting((0.0,) * 2, doc, unit, low, high, size=2)


def by_channel(doc, unit, low=-MOST, high=MOST):
    """Return a setting of four numbers, one for each channel."""
    return setting((0.0,) * 4, doc, unit, low, high, size=4)


@settings_class
class CustomTunedGyro(SettingsGroup):
    """Rotor parameters of preset custom; the defaults are those of preset tactical."""

    rotor_axial_kg_m2: float = setting(5.0e-6, 'Axial moment of inertia Jr of the rotor', 'kg m^2',
                                       0.0, 1.0)
    rotor_equatorial_kg_m2: float = setting(2.82e-6, 'Equatorial moment of inertia Jer of the '
                                            'rotor', 'kg m^2', 0.0, 1.0)
    ring_axial_kg_m2: float = setting(1.5e-7, 'Axial moment of inertia Jk of the ring', 'kg m^2',
                                      0.0, 1.0)
    ring_equatorial_kg_m2: float = setting(1.0e-7, 'Equatorial moment of inertia Jek of the ring',
                                           'kg m^2', 0.0, 1.0)
    speed_hz: float = setting(230.0, 'Nominal speed of the rotor, Omega / 2 pi', 'Hz', 0.0, 1e5)
    rotating_damping_n_m_s: float = setting(1.0e-7, 'Damping fe that rotates with the shaft',
                                            'N m s', 0.0, 1.0)
    case_damping_n_m_s: float = setting(6.0e-7, 'Damping D fixed to the case', 'N m s', 0.0, 1.0)
    cross_feedback_n_m_rad: float = setting(0.0, 'Gain K of the cross feedback from pick-off to '
                                            'torquer (turned by +j); used with the loop open only',
                                            'N m/rad', 0.0, 1e3)
    hinge_stiffness_n_m_rad: float = setting(0.0, 'Mean stiffness of the two hinges; 0 = the '
                                             'stiffness that tunes the rotor at speed_hz',
                                             'N m/rad', 0.0, 1e3)
    loop: str = setting('closed', 'How the gyro is read. open: from the tilt of the rotor; '
                        'closed: from the torque that keeps the rotor at zero tilt',
                        choices=('open', 'closed'))
    natural_rad_s: float = setting(2.0 * math.pi * 35.0, 'Natural frequency of the closed loop',
                                   'rad/s', 0.0, 1e6)
    damping_ratio: float = setting(1.0, 'Damping ratio of the closed loop', '', 0.0, 100.0)
    nutation_rad_s: float = setting(200.0, 'Decay rate of the nutation in the closed loop', '1/s',
                                    0.0, 1e6)


@settings_class
class TunedGyroErrors(SettingsGroup):
    """Errors of rotors and pick-offs; those of the read-out are in gyro.errors."""

    mass_unbalance_deg_h_g: tuple[float, ...] = by_channel('Drift proportional to specific force '
                                                           'along the same axis', 'deg/h/g')
    quadrature_unbalance_deg_h_g: tuple[float, ...] = by_channel(
        'Drift proportional to specific force along the other sensitive axis; a rigid rotor has '
        'opposite signs on y and z', 'deg/h/g')
    spin_axis_deg_h_g: tuple[float, ...] = by_channel('Drift proportional to specific force along '
                                                      'the spin axis', 'deg/h/g')
    anisoelastic_deg_h_g2: tuple[float, ...] = by_channel('Drift proportional to the product of '
                                                          'the specific forces along the spin '
                                                          'axis and the same axis (it rectifies '
                                                          'vibration)', 'deg/h/g^2')
    pickoff_offset_urad: tuple[float, ...] = by_channel('Tilt at which the pick-off reads zero',
                                                        'urad', -1e5, 1e5)
    pickoff_noise_urad_sqrt_s: tuple[float, ...] = by_channel('White noise n of the pick-off; the '
                                                              'variance of its mean over dt is '
                                                              'n^2/dt', 'urad sqrt(s)', 0.0, 1e5)
    speed_ppm: tuple[float, ...] = by_gyro('Deviation of the rotor speed from the nominal one, '
                                           'which also detunes the rotor', 'ppm', -1e5, 1e5)
    hunting_ppm: tuple[float, ...] = by_gyro('Amplitude of the hunting (periodic change) of the '
                                             'rotor speed', 'ppm', 0.0, 1e5)
    hunting_hz: float = setting(3.0, 'Frequency of the hunting', 'Hz', 1e-3, 100.0)
    spin_rate_product: float = setting(0.0, 'Uncompensated fraction of the drift (B - A)/(B '
                                       'Omega) times spin-axis rate times sensitive rate; 1 = no '
                                       'compensation', '', -1.0, 1.0)
    vibration_2n_deg_s: tuple[float, ...] = by_gyro('Amplitude of the angular vibration at twice '
                                                    'the speed of the rotor', 'deg/s', 0.0, 1e4)
    vibration_2n_phase_deg: tuple[float, ...] = by_gyro('Phase of that vibration relative to the '
                                                        'hinges of the rotor, plus the direction '
                                                        'of its axis from y', 'deg', -360.0, 360.0)


@settings_class
class TunedGyroFault(SettingsGroup):
    """Fault of one channel, scheduled or requested by the service ~/fault."""

    channel: str = setting('none', 'Channel that fails; none = no fault',
                           choices=('none', 'gyro_1_y', 'gyro_1_z', 'gyro_2_y', 'gyro_2_z'))
    bias_deg_h: float = setting(0.0, 'Bias added to the reading of that channel', 'deg/h', -MOST,
                                MOST)
    scale: float = setting(1.0, 'Factor of the reading of that channel; 0 = no signal', '', -1e3,
                           1e3)
    start_s: float = setting(0.0, 'Motion time at which the fault begins; negative = only on '
                             'request of the service ~/fault', 's', -1.0, 1e7)
    end_s: float = setting(1e7, 'Motion time at which the fault ends', 's', 0.0, 1e7)


@settings_class
class ParitySettings(SettingsGroup):
    """Consistency test of the four channels."""

    window_s: float = setting(1.0, 'Time over which the parity is averaged', 's', 1e-3, 1e4)
    threshold_deg_h: float = setting(0.0, 'Mean parity above which a fault is reported; 0 = '
                                     'computed from noise, standard deviations and present motion',
                                     'deg/h', 0.0, MOST)


@settings_class
class TunedGyroPairSettings(SettingsGroup):
    """Two dynamically tuned gyros in place of the ideal triad."""

    preset: str = setting('tactical', 'Rotor parameters of both gyros: a preset of '
                          'sensors.tuned_gyro.rotor.PRESETS, or custom. The rotor sapegin_2016 '
                          '(Sapegin, Romanov and Bugaiov 2016) is unstable; only RK4 with steps '
                          'of 0.332 to 1.099 ms damps it', choices=(*ROTORS, 'custom'))
    custom: CustomTunedGyro = group(CustomTunedGyro)
    arrangement: str = setting('paper', 'Arrangement of the two gyros. paper: gyro 1 senses x and '
                               'y, gyro 2 senses z and x; turned: the same, with each pair of '
                               'pick-offs turned by 45 deg about its spin axis',
                               choices=('paper', 'turned'))
    method: str = setting('exact', 'Integration of the rotor equations. exact: matrix '
                          'exponential; rk4: fourth-order Runge-Kutta', choices=('exact', 'rk4'))
    hold: str = setting('quadratic', 'Interpolation of the angular rate within a step of the '
                        'exact method. quadratic: parabola; linear: straight line',
                        choices=('quadratic', 'linear'))
    steps_per_sample: int = setting(1, 'Number of integration steps of the rotors in a sampling '
                                    'period', 'steps', 1, 1000)
    on_unstable: str = setting('refuse', 'What to do if rotors or integration steps are unstable: '
                               'refuse them, or warn and run', choices=('refuse', 'warn'))
    errors: TunedGyroErrors = group(TunedGyroErrors)
    fault: TunedGyroFault = group(TunedGyroFault)
    parity: ParitySettings = group(ParitySettings)


SWEEPS = {'base_rate': 'base rate [rad/s]', 'rotor_speed': 'rotor speed [Hz]'}


@settings_class
class TunedGyroStudySettings(SettingsGroup):
    """Study of the rocking of a base measured by two tuned gyros: one table and its figure."""

    sweep: str = setting('base_rate', 'Quantity that is varied: angular frequency of the base, or '
                         'speed of the rotors (which are tuned at each speed)',
                         choices=tuple(SWEEPS))
    values: tuple[float, ...] = setting((1.0,), 'Values of the table, rad/s for base_rate or Hz '
                                        'for rotor_speed', '', 1e-3, 1e4)
    paper_deg: tuple[float, ...] = setting((), 'Amplitudes printed in the paper for these values; '
                                           'empty = no comparison', 'deg', 0.0, 90.0)
    paper_limits_hz: tuple[float, ...] = setting((), 'Lowest and highest stable speed printed in '
                                                 'the paper; empty = no comparison', 'Hz', 1e-3,
                                                 1e4)
    curve_values: tuple[float, ...] = setting((), 'Values of the curve in the figure; empty = '
                                              'those of the table', '', 1e-3, 1e4)
    amplitude_deg: float = setting(10.0, 'Amplitude of the rocking in roll', 'deg', 1e-3, 89.0)
    base_rate_rad_s: float = setting(1.0, 'Angular frequency of the base while the rotor speed is '
                                     'varied', 'rad/s', 1e-3, 1e4)
    rotor_speed_hz: float = setting(230.0, 'Speed of the rotors while the base rate is varied, '
                                    'and start of the search for the stability limits', 'Hz', 1e-3,
                                    1e4)
    preset: str = setting('sapegin_2016', 'Rotor parameters of both gyros, see '
                          'sensors.tuned_gyro.rotor.PRESETS', choices=ROTORS)
    method: str = setting('rk4', 'Integration of the gyros: rk4 as in Sapegin, Romanov and '
                          'Bugaiov 2016, or exact', choices=('rk4', 'exact'))
    step_ms: float = setting(0.75, 'Integration step of gyros and orientation', 'ms', 1e-3, 100.0)

    def check(self):
        """Raise ValueError unless the lists have matching lengths."""
        if len(self.paper_deg) not in (0, len(self.values)):
            raise ValueError(f'paper_deg has {len(self.paper_deg)} entries; expected none or '
                             f'{len(self.values)}, one for each of values')
        if len(self.paper_limits_hz) not in (0, 2):
            raise ValueError(f'paper_limits_hz has {len(self.paper_limits_hz)} entries; expected '
                             'none or 2')
        if not self.values:
            raise ValueError('values is empty; expected at least one')
