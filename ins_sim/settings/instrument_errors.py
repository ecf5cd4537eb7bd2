"""
Settings of the instrument errors; the defaults are error-free.

Lists are by FLU axis (x, y, z); one number sets all three. Random terms are given as
densities or as standard deviations of processes, not as the scatter of a sample, so that their
meaning does not depend on the rate. Both triads have the same keys, apart from the units;
``core.sensors.imu.triad_model`` converts both to SI.

White noise is given as a random walk (units of data sheets) or as a density (units of Kalibr,
Gazebo and PX4). Both are N of IEEE Std 952; the variance of a sample is N^2/dt.
"""

from dataclasses import fields
import math

from .catalogue import for_all_axes
from .field import setting, settings_class, SettingsGroup

Axes = tuple[float, ...]
MOST = 1e9


def axes(doc, unit, low=0.0, high=MOST, default=0.0):
    """Return a setting of three numbers: x, y, z."""
    return setting((default,) * 3, doc, unit, low, high, size=3, equal_axes=True)


BIAS = 'Bias, the same in every run'
TURN_ON = 'Standard deviation of the bias, drawn once per run'
GAUSS_MARKOV = 'Standard deviation of the in-run bias, a stationary Gauss-Markov process'
GAUSS_MARKOV_TIME = ('Correlation time of the Gauss-Markov process; infinite = random walk that '
                     'has this standard deviation after one hour')
INSTABILITY = ('Bias instability B of IEEE Std 952 (flicker noise). The flat part of its Allan '
               'deviation is sqrt(2 ln 2/pi) B = 0.664 B; data sheets usually give this flat '
               'part, so divide their figure by 0.664')
DENSITY = ('Density N of the white noise, as Kalibr, Gazebo and PX4 give it; the variance of a '
           'sample is N^2 rate_hz. Used instead of ')
SCALE = 'Scale factor error, the same in every run'
SCALE_SIGMA = 'Standard deviation of the scale factor error, drawn once per run'
ASYMMETRY = 'Scale factor error for positive inputs, with the opposite sign for negative ones'
MISALIGNMENT = 'Rotation vector from the body axes to the axes of the triad'
MISALIGNMENT_SIGMA = 'Standard deviation of the misalignment, drawn once per run'
NON_ORTHOGONALITY = ('Rotation of the sensitive axis y towards x, of z towards x, of z towards '
                     'y; x is the reference')
BANDWIDTH = 'Half-power frequency (bandwidth) of the channel; 0 = no lag'
ORDER = 'Order of the low-pass filter of bandwidth_hz: 1, or 2 (Butterworth)'
TEMPERATURE_SCALE = 'Scale factor error per degree of deviation from temperature.reference_c'
REPORTED = ('Standard deviation reported in the messages; negative = standard deviation of the '
            'simulated white noise')


class TriadSettings(SettingsGroup):
    """
    Base class of the errors of both triads.

    ``NAME`` is the name of the group in the settings of a node; ``WHITE`` holds the two names
    under which the white noise can be given.
    """

    NAME, WHITE = '', ('', '')

    def check(self):
        """Expand single numbers to all axes; raise ValueError if white noise is given twice."""
        for f in fields(self):
            self.__dict__[f.name] = for_all_axes(self.__dict__[f.name], f)
        values = [getattr(self, name) for name in self.WHITE]
        if all(isinstance(value, tuple) and any(value) for value in values):
            one, other = (f'{self.NAME}.{name} is {list(value)}'
                          for name, value in zip(self.WHITE, values))
            raise ValueError(f'{one} and {other}; expected one of them, and 0 for the other: both '
                             'are the white noise')


@settings_class
class GyroErrors(TriadSettings):
    """Errors of the gyro triad."""

    NAME = 'gyro.errors'
    WHITE = ('angle_random_walk_deg_sqrt_h', 'noise_density_rad_s_sqrt_hz')

    bias_deg_h: Axes = axes(BIAS, 'deg/h', -MOST)
    turn_on_bias_sigma_deg_h: Axes = axes(TURN_ON, 'deg/h')
    gauss_markov_sigma_deg_h: Axes = axes(GAUSS_MARKOV, 'deg/h')
    gauss_markov_time_s: Axes = axes(GAUSS_MARKOV_TIME, 's', 1e-3, math.inf, default=300.0)
    angle_random_walk_deg_sqrt_h: Axes = axes('Angle random walk N (white noise of the rate)',
                                              'deg/sqrt(h)')
    noise_density_rad_s_sqrt_hz: Axes = axes(DENSITY + 'angle_random_walk_deg_sqrt_h',
                                             'rad/s/sqrt(Hz)')
    rate_random_walk_deg_h_sqrt_h: Axes = axes('Rate random walk K', 'deg/h/sqrt(h)')
    bias_instability_deg_h: Axes = axes(INSTABILITY, 'deg/h')
    scale_factor_ppm: Axes = axes(SCALE, 'ppm', -1e6)
    scale_factor_sigma_ppm: Axes = axes(SCALE_SIGMA, 'ppm')
    scale_asymmetry_ppm: Axes = axes(ASYMMETRY, 'ppm', -1e6)
    cubic_ppm_s2_deg2: Axes = axes('Scale factor error proportional to the square of the rate',
                                   'ppm/(deg/s)^2', -MOST)
    misalignment_mrad: Axes = axes(MISALIGNMENT, 'mrad', -1000.0, 1000.0)
    misalignment_sigma_mrad: Axes = axes(MISALIGNMENT_SIGMA, 'mrad', 0.0, 100.0)
    non_orthogonality_mrad: Axes = axes(NON_ORTHOGONALITY, 'mrad', -500.0, 500.0)
    g_sensitivity_deg_h_g: Axes = axes('Drift proportional to specific force along the same axis',
                                       'deg/h/g',
                                       -MOST)
    g2_sensitivity_deg_h_g2: Axes = axes('Drift by the square of specific force along the same '
                                         'axis', 'deg/h/g^2', -MOST)
    bandwidth_hz: Axes = axes(BANDWIDTH, 'Hz')
    bandwidth_order: int = setting(1, ORDER, '', 1, 2)
    saturation_deg_s: Axes = axes('Greatest rate that is measured; 0 = no limit', 'deg/s')
    quantisation_arcsec: Axes = axes('Weight of one output pulse; the remainder is kept for the '
                                     'next sample; 0 = no quantisation', 'arcsec')
    temperature_bias_deg_h_c: Axes = axes('Drift per degree of deviation from '
                                          'temperature.reference_c', 'deg/h/C', -MOST)
    temperature_scale_ppm_c: Axes = axes(TEMPERATURE_SCALE, 'ppm/C', -1e6)
    reported_sigma_deg_s: Axes = axes(REPORTED, 'deg/s', -1.0, default=-1.0)


@settings_class
class AccelerometerErrors(TriadSettings):
    """Errors of the accelerometer triad."""

    NAME = 'accelerometer.errors'
    WHITE = ('velocity_random_walk_m_s_sqrt_h', 'noise_density_m_s2_sqrt_hz')

    bias_ug: Axes = axes(BIAS, 'ug', -MOST)
    turn_on_bias_sigma_ug: Axes = axes(TURN_ON, 'ug')
    gauss_markov_sigma_ug: Axes = axes(GAUSS_MARKOV, 'ug')
    gauss_markov_time_s: Axes = axes(GAUSS_MARKOV_TIME, 's', 1e-3, math.inf, default=300.0)
    velocity_random_walk_m_s_sqrt_h: Axes = axes('Velocity random walk N (white noise)',
                                                 'm/s/sqrt(h)')
    noise_density_m_s2_sqrt_hz: Axes = axes(DENSITY + 'velocity_random_walk_m_s_sqrt_h',
                                            'm/s^2/sqrt(Hz)')
    acceleration_random_walk_ug_sqrt_h: Axes = axes('Acceleration random walk K', 'ug/sqrt(h)')
    bias_instability_ug: Axes = axes(INSTABILITY, 'ug')
    scale_factor_ppm: Axes = axes(SCALE, 'ppm', -1e6)
    scale_factor_sigma_ppm: Axes = axes(SCALE_SIGMA, 'ppm')
    scale_asymmetry_ppm: Axes = axes(ASYMMETRY, 'ppm', -1e6)
    quadratic_ug_g2: Axes = axes('Bias proportional to the square of specific force (rectifies '
                                 'vibration)', 'ug/g^2', -MOST)
    cubic_ug_g3: Axes = axes('Error proportional to the cube of specific force', 'ug/g^3', -MOST)
    misalignment_mrad: Axes = axes(MISALIGNMENT, 'mrad', -1000.0, 1000.0)
    misalignment_sigma_mrad: Axes = axes(MISALIGNMENT_SIGMA, 'mrad', 0.0, 100.0)
    non_orthogonality_mrad: Axes = axes(NON_ORTHOGONALITY, 'mrad', -500.0, 500.0)
    bandwidth_hz: Axes = axes(BANDWIDTH, 'Hz')
    bandwidth_order: int = setting(1, ORDER, '', 1, 2)
    saturation_g: Axes = axes('Greatest specific force that is measured; 0 = no limit', 'g')
    quantisation_mm_s: Axes = axes('Weight of one output pulse; the remainder is kept for the '
                                   'next sample; 0 = no quantisation', 'mm/s')
    temperature_bias_ug_c: Axes = axes('Bias per degree of deviation from '
                                       'temperature.reference_c', 'ug/C', -MOST)
    temperature_scale_ppm_c: Axes = axes(TEMPERATURE_SCALE, 'ppm/C', -1e6)
    reported_sigma_m_s2: Axes = axes(REPORTED, 'm/s^2', -1.0, default=-1.0)


@settings_class
class Temperature(SettingsGroup):
    """Temperature of the instruments: constant, ramp and sinusoid of motion time."""

    reference_c: float = setting(25.0, 'Temperature of the calibration, at which the temperature '
                                 'errors vanish', 'C', -100.0, 200.0)
    constant_c: float = setting(25.0, 'Temperature at motion time zero, to which ramp and '
                                'sinusoid are added', 'C', -100.0, 200.0)
    ramp_c_h: float = setting(0.0, 'Rise of the temperature per hour', 'C/h', -1e5, 1e5)
    amplitude_c: float = setting(0.0, 'Amplitude of the sinusoidal temperature change', 'C',
                                 -200.0, 200.0)
    period_s: float = setting(3600.0, 'Period of the sinusoidal temperature change', 's', 1.0, 1e7)


@settings_class
class Sampling(SettingsGroup):
    """Stamps and losses of the samples, common to both triads (one message)."""

    latency_us: float = setting(0.0, 'Constant time added to every stamp', 'us', -1e6, 1e6)
    jitter_us: float = setting(0.0, 'Standard deviation of the random error of the stamps, at '
                               'most a tenth of the sampling period', 'us', 0.0, 1e6)
    drop_out_probability: float = setting(0.0, 'Probability that a sample is lost', '', 0.0, 1.0)
