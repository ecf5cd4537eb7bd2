"""
Settings of the instrument errors; every default is the perfect instrument.

Lists are by FLU axis (x, y, z), and one number stands for three equal ones.  Random terms are
densities or standard deviations of processes, never the scatter of a sample, so that nothing
changes meaning with the rate.  Key by key the two triads are alike;
``core.sensors.imu.triad_model`` brings both to SI.

White noise is given as a random walk, in the units of data sheets, or as a density, in those of
Kalibr, Gazebo and PX4: N of IEEE Std 952 both times, N^2/dt being the variance of a sample.
"""

from dataclasses import fields
import math

from .catalogue import for_all_axes
from .field import setting, settings_class, SettingsGroup

Axes = tuple[float, ...]
MOST = 1e9


def axes(doc, unit, low=0.0, high=MOST, default=0.0):
    """Return a setting of three numbers, by axis."""
    return setting((default,) * 3, doc, unit, low, high, size=3, equal_axes=True)


BIAS = 'bias, the same in every run'
TURN_ON = 'bias drawn once a run, standard deviation'
GAUSS_MARKOV = 'in-run bias, stationary Gauss-Markov process, standard deviation'
GAUSS_MARKOV_TIME = ('its correlation time; infinite = random walk of that standard deviation '
                     'after one hour')
INSTABILITY = ('bias instability B of IEEE Std 952, flicker noise: the Allan deviation lies flat '
               'at 0.664 B, sqrt(2 ln 2/pi) B; that floor is the figure of data sheets, so give '
               'it over 0.664')
DENSITY = ('density N of the white noise, as Kalibr, Gazebo and PX4 give it: N^2 rate_hz is the '
           'variance of a sample; in place of ')
SCALE = 'scale factor error, the same in every run'
SCALE_SIGMA = 'scale factor error drawn once a run, standard deviation'
ASYMMETRY = 'scale factor error of positive inputs; that of negative ones is its opposite'
MISALIGNMENT = 'rotation vector from the body axes to those of the triad'
MISALIGNMENT_SIGMA = 'the same, drawn once a run, standard deviation'
NON_ORTHOGONALITY = ('turn of the sensitive axis y towards x, of z towards x, of z towards y; x '
                     'is the reference')
BANDWIDTH = 'half-power frequency of the channel; 0 = no lag'
ORDER = 'order of that lag: 1, or 2 (Butterworth)'
TEMPERATURE_SCALE = 'scale factor error per degree off the reference'
REPORTED = ('standard deviation reported in place of that of the noise; negative = that of the '
            'noise')


class TriadSettings(SettingsGroup):
    """
    What the errors of both triads share: one number for three axes, one unit for the white noise.

    NAME: of the group in the settings of a node; WHITE: the names of the white noise.
    """

    NAME, WHITE = '', ('', '')

    def check(self):
        """Take a number for all axes; refuse white noise that is given twice."""
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
    angle_random_walk_deg_sqrt_h: Axes = axes('angle random walk N', 'deg/sqrt(h)')
    noise_density_rad_s_sqrt_hz: Axes = axes(DENSITY + 'angle_random_walk_deg_sqrt_h',
                                             'rad/s/sqrt(Hz)')
    rate_random_walk_deg_h_sqrt_h: Axes = axes('rate random walk K', 'deg/h/sqrt(h)')
    bias_instability_deg_h: Axes = axes(INSTABILITY, 'deg/h')
    scale_factor_ppm: Axes = axes(SCALE, 'ppm', -1e6)
    scale_factor_sigma_ppm: Axes = axes(SCALE_SIGMA, 'ppm')
    scale_asymmetry_ppm: Axes = axes(ASYMMETRY, 'ppm', -1e6)
    cubic_ppm_s2_deg2: Axes = axes('scale factor error growing with the square of the rate',
                                   'ppm/(deg/s)^2', -MOST)
    misalignment_mrad: Axes = axes(MISALIGNMENT, 'mrad', -1000.0, 1000.0)
    misalignment_sigma_mrad: Axes = axes(MISALIGNMENT_SIGMA, 'mrad', 0.0, 100.0)
    non_orthogonality_mrad: Axes = axes(NON_ORTHOGONALITY, 'mrad', -500.0, 500.0)
    g_sensitivity_deg_h_g: Axes = axes('drift by specific force along the same axis', 'deg/h/g',
                                       -MOST)
    g2_sensitivity_deg_h_g2: Axes = axes('drift by the square of specific force along the same '
                                         'axis', 'deg/h/g^2', -MOST)
    bandwidth_hz: Axes = axes(BANDWIDTH, 'Hz')
    bandwidth_order: int = setting(1, ORDER, '', 1, 2)
    saturation_deg_s: Axes = axes('greatest rate that is read; 0 = none', 'deg/s')
    quantisation_arcsec: Axes = axes('weight of one pulse; the remainder is carried on; 0 = none',
                                     'arcsec')
    temperature_bias_deg_h_c: Axes = axes('drift per degree off the reference', 'deg/h/C', -MOST)
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
    velocity_random_walk_m_s_sqrt_h: Axes = axes('velocity random walk N', 'm/s/sqrt(h)')
    noise_density_m_s2_sqrt_hz: Axes = axes(DENSITY + 'velocity_random_walk_m_s_sqrt_h',
                                            'm/s^2/sqrt(Hz)')
    acceleration_random_walk_ug_sqrt_h: Axes = axes('acceleration random walk K', 'ug/sqrt(h)')
    bias_instability_ug: Axes = axes(INSTABILITY, 'ug')
    scale_factor_ppm: Axes = axes(SCALE, 'ppm', -1e6)
    scale_factor_sigma_ppm: Axes = axes(SCALE_SIGMA, 'ppm')
    scale_asymmetry_ppm: Axes = axes(ASYMMETRY, 'ppm', -1e6)
    quadratic_ug_g2: Axes = axes('bias growing with the square of specific force (rectifies '
                                 'vibration)', 'ug/g^2', -MOST)
    cubic_ug_g3: Axes = axes('error growing with the cube of specific force', 'ug/g^3', -MOST)
    misalignment_mrad: Axes = axes(MISALIGNMENT, 'mrad', -1000.0, 1000.0)
    misalignment_sigma_mrad: Axes = axes(MISALIGNMENT_SIGMA, 'mrad', 0.0, 100.0)
    non_orthogonality_mrad: Axes = axes(NON_ORTHOGONALITY, 'mrad', -500.0, 500.0)
    bandwidth_hz: Axes = axes(BANDWIDTH, 'Hz')
    bandwidth_order: int = setting(1, ORDER, '', 1, 2)
    saturation_g: Axes = axes('greatest specific force that is read; 0 = none', 'g')
    quantisation_mm_s: Axes = axes('weight of one pulse; the remainder is carried on; 0 = none',
                                   'mm/s')
    temperature_bias_ug_c: Axes = axes('bias per degree off the reference', 'ug/C', -MOST)
    temperature_scale_ppm_c: Axes = axes(TEMPERATURE_SCALE, 'ppm/C', -1e6)
    reported_sigma_m_s2: Axes = axes(REPORTED, 'm/s^2', -1.0, default=-1.0)


@settings_class
class Temperature(SettingsGroup):
    """Temperature of the instruments: constant, ramp and sinusoid of motion time."""

    reference_c: float = setting(25.0, 'temperature of the calibration', 'C', -100.0, 200.0)
    constant_c: float = setting(25.0, 'temperature at motion time zero', 'C', -100.0, 200.0)
    ramp_c_h: float = setting(0.0, 'rise per hour', 'C/h', -1e5, 1e5)
    amplitude_c: float = setting(0.0, 'amplitude of the sinusoid', 'C', -200.0, 200.0)
    period_s: float = setting(3600.0, 'period of the sinusoid', 's', 1.0, 1e7)


@settings_class
class Sampling(SettingsGroup):
    """How samples reach the outside; both triads share it, as they share a message."""

    latency_us: float = setting(0.0, 'added to every stamp', 'us', -1e6, 1e6)
    jitter_us: float = setting(0.0, 'scatter of the stamps, standard deviation, at most a tenth '
                               'of the sampling period', 'us', 0.0, 1e6)
    drop_out_probability: float = setting(0.0, 'probability that a sample is lost', '', 0.0, 1.0)
