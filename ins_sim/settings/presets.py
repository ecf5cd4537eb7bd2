"""
Presets of instrument errors, one for each class of IMU, from data sheets.

Values that a comment attributes to an instrument are from its published data sheet or brochure.
All others (rate random walk, temperature, non-linearity, pulses) are not in data sheets and are
engineering judgement.

Data sheets give the lowest Allan deviation as "in-run stability" or "bias instability". It is
0.664 B; the setting bias_instability is B, therefore the figure of the data sheet divided by
0.664. The minimum measured on a record is somewhat higher, because N and K add to B.

Presets are read-only; ``preset`` returns a new dict of settings, which other settings override.
"""

from dataclasses import dataclass
import math
from types import MappingProxyType

from .instrument_errors import AccelerometerErrors, GyroErrors
from .suggest import nearest_name

GYRO, ACCELEROMETER = 'gyro.errors.', 'accelerometer.errors.'
ROTORS = 'gyro.dtg.errors.'


@dataclass(frozen=True)
class Preset:
    """
    Errors of a class of instruments.

    Attributes
    ----------
    name : preset name
    datasheet : description of the class
    figures : its figures from data sheets, as text
    values : read-only {dotted key of imu_sensor: value}
    """

    name: str
    datasheet: str
    figures: str
    values: MappingProxyType


def _preset(name, datasheet, figures, gyro, accelerometer, more=MappingProxyType({})):
    values = dict(more)
    for prefix, terms in ((GYRO, gyro), (ACCELEROMETER, accelerometer)):
        for key, value in terms.items():
            values[prefix + key] = value if key == 'bandwidth_order' else (value,) * 3
    return Preset(name, datasheet, figures, MappingProxyType(values))


# Noise, biases and ranges are those of Honeywell HG4930 (CA51), one of the better of the class.
# Scale factors 500 and 300 ppm, gyro non-linearity 50 ppm at 400 deg/s, 1 deg/h/g with
# compensation and the filter of 262 Hz are those of Sensonor STIM300 (TS1524). Others are noisier:
# STIM300 has 0.15 deg/sqrt(h), 0.3 to 0.5 deg/h in run, 0.06 m/s/sqrt(h), 50 ug; Analog Devices
# ADIS16490 has 0.09 deg/sqrt(h), 1.8 deg/h.
_MEMS = _preset(
    'tactical_mems', 'tactical-grade MEMS IMU (class of HG4930, STIM300, ADIS16490)',
    'gyro: repeatability 7 deg/h, in-run 0.25 deg/h, ARW 0.04 deg/sqrt(h), range 400 deg/s '
    '(HG4930), scale factor 500 ppm, 1 deg/h/g (STIM300); accelerometer: repeatability 1.7 mg, '
    'in-run 25 ug, VRW 0.03 m/s/sqrt(h), range 20 g (HG4930), scale factor 300 ppm (STIM300); '
    'the rest is judgement',
    {'turn_on_bias_sigma_deg_h': 7.0, 'angle_random_walk_deg_sqrt_h': 0.04,
     'bias_instability_deg_h': 0.38, 'rate_random_walk_deg_h_sqrt_h': 2.0,
     'scale_factor_sigma_ppm': 500.0, 'scale_asymmetry_ppm': 50.0, 'cubic_ppm_s2_deg2': 3e-4,
     'misalignment_sigma_mrad': 0.5, 'non_orthogonality_mrad': 0.2,
     'g_sensitivity_deg_h_g': 1.0, 'g2_sensitivity_deg_h_g2': 0.1, 'bandwidth_hz': 262.0,
     'bandwidth_order': 2, 'saturation_deg_s': 400.0, 'quantisation_arcsec': 0.1,
     'temperature_bias_deg_h_c': 0.2, 'temperature_scale_ppm_c': 10.0},
    {'turn_on_bias_sigma_ug': 1700.0, 'velocity_random_walk_m_s_sqrt_h': 0.03,
     'bias_instability_ug': 38.0, 'acceleration_random_walk_ug_sqrt_h': 200.0,
     'scale_factor_sigma_ppm': 300.0, 'scale_asymmetry_ppm': 50.0, 'quadratic_ug_g2': 100.0,
     'cubic_ug_g3': 10.0, 'misalignment_sigma_mrad': 0.5, 'non_orthogonality_mrad': 0.2,
     'bandwidth_hz': 262.0, 'bandwidth_order': 2, 'saturation_g': 20.0,
     'quantisation_mm_s': 0.01, 'temperature_bias_ug_c': 50.0, 'temperature_scale_ppm_c': 10.0})

# Noise, in-run stability, linearity, bandwidth and range of the gyros, and the range of the
# accelerometers, are those of KVH 1750. Biases, scale factors, alignment and the noise of the
# accelerometers, 35 ug/sqrt(Hz), are those of Northrop Grumman LN-200. Its gyros are noisier,
# 0.07 deg/sqrt(h).
_FOG = _preset(
    'tactical_fog', 'tactical-grade fibre-optic IMU (class of LN-200, KVH 1750)',
    'gyro: in-run 0.05 deg/h, ARW 0.012 deg/sqrt(h), range 490 deg/s, bandwidth 440 Hz (KVH '
    '1750), repeatability 1 deg/h, scale factor 100 ppm, alignment 0.1 mrad (LN-200); '
    'accelerometer: repeatability 0.3 mg, VRW 0.02 m/s/sqrt(h), scale factor 300 ppm (LN-200), '
    'range 30 g (KVH 1750); the rest, such as in-run 13 ug, is judgement',
    {'turn_on_bias_sigma_deg_h': 1.0, 'angle_random_walk_deg_sqrt_h': 0.012,
     'bias_instability_deg_h': 0.075, 'rate_random_walk_deg_h_sqrt_h': 0.3,
     'scale_factor_sigma_ppm': 100.0, 'scale_asymmetry_ppm': 10.0, 'cubic_ppm_s2_deg2': 2e-4,
     'misalignment_sigma_mrad': 0.1, 'non_orthogonality_mrad': 0.1, 'bandwidth_hz': 440.0,
     'bandwidth_order': 1, 'saturation_deg_s': 490.0, 'quantisation_arcsec': 0.1,
     'temperature_bias_deg_h_c': 0.02, 'temperature_scale_ppm_c': 3.0},
    {'turn_on_bias_sigma_ug': 300.0, 'velocity_random_walk_m_s_sqrt_h': 0.02,
     'bias_instability_ug': 20.0, 'acceleration_random_walk_ug_sqrt_h': 100.0,
     'scale_factor_sigma_ppm': 300.0, 'scale_asymmetry_ppm': 30.0, 'quadratic_ug_g2': 30.0,
     'cubic_ug_g3': 2.0, 'misalignment_sigma_mrad': 0.1, 'non_orthogonality_mrad': 0.1,
     'bandwidth_hz': 200.0, 'bandwidth_order': 2, 'saturation_g': 30.0,
     'quantisation_mm_s': 0.01, 'temperature_bias_ug_c': 20.0, 'temperature_scale_ppm_c': 5.0})

# Noise, bias and scale factor of the gyros, and bias and scale factor of the accelerometers, are
# those of Honeywell HG9900 (brochure N61-1638); GG1320 has 0.0035 deg/sqrt(h), LN-100 0.001. No
# data sheet of the class gives bias instability or rate random walk of the gyros: they are below
# the white noise for hours, and only records of weeks show them (test_allan).
_RLG = _preset(
    'navigation_rlg', 'navigation-grade ring-laser IMU with quartz accelerometers (class of '
    '1 nmi/h: HG9900, GG1320, LN-100)',
    'gyro: bias 0.0035 deg/h, ARW 0.002 deg/sqrt(h), scale factor 5 ppm; accelerometer: bias 25 '
    'ug, scale factor 100 ppm (HG9900); the rest is judgement: gyro in-run 0.001 deg/h over '
    'hours, walk 0.0005 deg/h/sqrt(h), range 400 deg/s, pulses 0.01 arcsec; accelerometer in-run '
    '2 ug, VRW 0.003 m/s/sqrt(h) (5 ug/sqrt(Hz)), range 25 g',
    {'turn_on_bias_sigma_deg_h': 0.0035, 'angle_random_walk_deg_sqrt_h': 0.002,
     'bias_instability_deg_h': 0.0015, 'rate_random_walk_deg_h_sqrt_h': 5e-4,
     'scale_factor_sigma_ppm': 5.0, 'scale_asymmetry_ppm': 0.5,
     'misalignment_sigma_mrad': 0.01, 'non_orthogonality_mrad': 0.01, 'bandwidth_hz': 500.0,
     'bandwidth_order': 1, 'saturation_deg_s': 400.0, 'quantisation_arcsec': 0.01,
     'temperature_bias_deg_h_c': 1e-4, 'temperature_scale_ppm_c': 0.1},
    {'turn_on_bias_sigma_ug': 25.0, 'velocity_random_walk_m_s_sqrt_h': 0.003,
     'bias_instability_ug': 3.0, 'acceleration_random_walk_ug_sqrt_h': 10.0,
     'scale_factor_sigma_ppm': 100.0, 'scale_asymmetry_ppm': 5.0, 'quadratic_ug_g2': 10.0,
     'cubic_ug_g3': 0.5, 'misalignment_sigma_mrad': 0.02, 'non_orthogonality_mrad': 0.02,
     'bandwidth_hz': 300.0, 'bandwidth_order': 2, 'saturation_g': 25.0,
     'quantisation_mm_s': 0.002, 'temperature_bias_ug_c': 1.0, 'temperature_scale_ppm_c': 1.0})

# IEEE Std 813 gives the terms of the model and no figures.  All values are judgement, from the
# middle of the ranges reported for tactical two-axis gyros with compensation: fixed drift 0.1 to 3
# deg/h, in-run 0.02 to 0.2 deg/h over 100 to 1000 s, mass unbalance 0.1 to 1 deg/h/g, anisoelastic
# 0.01 to 0.05 deg/h/g^2, torquer 50 to 500 ppm and 10 to 50 ppm, 100 to 400 deg/s, axes 0.05 to
# 0.5 mrad, ARW 0.002 to 0.02 deg/sqrt(h), pulses 0.1 to 1 arcsec.
_DTG = _preset(
    'tactical_dtg', 'tactical-grade IMU with dynamically tuned gyros and quartz accelerometers '
    '(model of IEEE Std 813)',
    'judgement within the ranges of the class; gyro: fixed drift 1 deg/h, Gauss-Markov 0.02 deg/h '
    'over 100 s, floor 0.033 deg/h, mass unbalance 0.5 deg/h/g, quadrature 1 deg/h/g, spin axis '
    '0.1 deg/h/g, anisoelastic 0.02 deg/h/g^2, pick-off 10 urad, speed and hunting 5 ppm, product '
    'of rates compensated to 1 %, '
    'torquer 200 ppm, asymmetry 30 ppm, 200 deg/s, axes 0.2 mrad, ARW 0.005 deg/sqrt(h), pulses '
    '0.3 arcsec; accelerometer: repeatability 100 ug, in-run 7 ug, VRW 0.01 m/s/sqrt(h), range 20 '
    'g',
    {'turn_on_bias_sigma_deg_h': 1.0, 'gauss_markov_sigma_deg_h': 0.02,
     'gauss_markov_time_s': 100.0, 'angle_random_walk_deg_sqrt_h': 0.005,
     'bias_instability_deg_h': 0.05, 'rate_random_walk_deg_h_sqrt_h': 0.25,
     'scale_factor_sigma_ppm': 200.0, 'scale_asymmetry_ppm': 30.0, 'cubic_ppm_s2_deg2': 0.001,
     'misalignment_sigma_mrad': 0.2, 'non_orthogonality_mrad': 0.1,
     'saturation_deg_s': 200.0, 'quantisation_arcsec': 0.3, 'temperature_bias_deg_h_c': 0.02,
     'temperature_scale_ppm_c': 5.0},
    {'turn_on_bias_sigma_ug': 100.0, 'velocity_random_walk_m_s_sqrt_h': 0.01,
     'bias_instability_ug': 10.0, 'acceleration_random_walk_ug_sqrt_h': 50.0,
     'scale_factor_sigma_ppm': 150.0, 'scale_asymmetry_ppm': 15.0, 'quadratic_ug_g2': 20.0,
     'cubic_ug_g3': 1.0, 'misalignment_sigma_mrad': 0.2, 'non_orthogonality_mrad': 0.1,
     'bandwidth_hz': 300.0, 'bandwidth_order': 2, 'saturation_g': 20.0,
     'quantisation_mm_s': 0.01, 'temperature_bias_ug_c': 10.0, 'temperature_scale_ppm_c': 3.0},
    # The quadrature of a rigid rotor has opposite signs on y and z.
    {ROTORS + 'mass_unbalance_deg_h_g': (0.5,) * 4,
     ROTORS + 'quadrature_unbalance_deg_h_g': (1.0, -1.0) * 2,
     ROTORS + 'spin_axis_deg_h_g': (0.1,) * 4, ROTORS + 'anisoelastic_deg_h_g2': (0.02,) * 4,
     ROTORS + 'pickoff_offset_urad': (10.0,) * 4,
     ROTORS + 'pickoff_noise_urad_sqrt_s': (0.001,) * 4, ROTORS + 'speed_ppm': (5.0, -5.0),
     ROTORS + 'hunting_ppm': (5.0,) * 2, ROTORS + 'hunting_hz': 3.0,
     ROTORS + 'spin_rate_product': 0.01, ROTORS + 'vibration_2n_deg_s': (0.01,) * 2,
     'gyro.model': 'dtg', 'output': 'integrated'})

PRESETS = MappingProxyType({p.name: p for p in (_MEMS, _FOG, _RLG, _DTG)})


def preset(name):
    """
    Return a new dict {dotted key of imu_sensor: value} of a preset.

    Raises ValueError, with the nearest known name, if there is no such preset.
    """
    if name not in PRESETS:
        raise ValueError(f'unknown instrument preset {name!r}; the nearest known one is '
                         f'{nearest_name(name, PRESETS)!r}')
    return dict(PRESETS[name].values)


def navigator_values(entry):
    """
    Return the settings of the filter of aided_navigator that match a Preset.

    Gyro scale factor and misalignment are combined into one value. In level flight misalignment
    of the accelerometers and the drift of a gyro under 1 g act as biases, so they are added to
    the bias sigmas. Keys are the dotted keys of aided_navigator.
    """
    def one(key):
        return max(map(abs, entry.values.get(key, (0.0,))))

    def together(*parts):
        # Four digits, as data sheets have no more.
        return float(f'{math.hypot(*parts):.4g}')

    of_g = (one(GYRO + 'g_sensitivity_deg_h_g'), one(ROTORS + 'mass_unbalance_deg_h_g'))
    gyros_out, forces_out = (1e3 * one(triad + 'misalignment_sigma_mrad')
                             for triad in (GYRO, ACCELEROMETER))
    return {f'imu_model.{key}': value for key, value in (
        ('gyro_bias_sigma_deg_h', together(one(GYRO + 'turn_on_bias_sigma_deg_h'), *of_g)),
        ('gyro_bias_walk_deg_h_sqrt_h', one(GYRO + 'rate_random_walk_deg_h_sqrt_h')),
        ('angle_random_walk_deg_sqrt_h', one(GYRO + 'angle_random_walk_deg_sqrt_h')),
        ('gyro_scale_sigma_ppm', together(one(GYRO + 'scale_factor_sigma_ppm'), gyros_out)),
        ('accelerometer_bias_sigma_ug', together(
            one(ACCELEROMETER + 'turn_on_bias_sigma_ug'), forces_out)),
        ('accelerometer_bias_walk_ug_sqrt_h',
         one(ACCELEROMETER + 'acceleration_random_walk_ug_sqrt_h')),
        ('velocity_random_walk_m_s_sqrt_h',
         one(ACCELEROMETER + 'velocity_random_walk_m_s_sqrt_h')))}


def strapdown_values(entry):
    """Return {dotted key of strapdown: value} of a Preset, for its covariances."""
    return {key: value for key, value in entry.values.items()
            if key.startswith((GYRO, ACCELEROMETER))}


def preset_triads(name):
    """Return (GyroErrors, AccelerometerErrors) of the preset of that name."""
    values = preset(name)
    return tuple(cls(**{key.removeprefix(prefix): value for key, value in values.items()
                        if key.startswith(prefix)})
                 for cls, prefix in ((GyroErrors, GYRO), (AccelerometerErrors, ACCELEROMETER)))
