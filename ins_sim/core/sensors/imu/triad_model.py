"""The error model of a triad in SI units, built from the settings of gyros or accelerometers."""

from dataclasses import dataclass, fields
import math

from ins_sim.core.numerics.elementary import log, sin
from ins_sim.core.numerics.units import DEG, DEG_H, SQRT_H, STANDARD_GRAVITY, UG
from ins_sim.settings.catalogue import check_value
from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors

# Floor of the Allan deviation of flicker noise divided by its coefficient B, sqrt(2 ln 2 / pi)
# (IEEE Std 952).
FLICKER_FLOOR = math.sqrt(2.0 * log(2.0) / math.pi)
# The range must exceed the standard deviation of the white noise by this factor.
SIGMAS = 5.0


@dataclass(frozen=True)
class TriadModel:
    """
    Coefficients of a triad, tuples of three by body axis.

    U is the unit of the triad: rad/s for gyros, m/s^2 for accelerometers.

    Attributes
    ----------
    bias, turn_on_sigma, gauss_markov_sigma, flicker : U
    gauss_markov_time : s; infinite for a random walk
    white : U sqrt(s)
    walk : U/sqrt(s)
    scale, scale_sigma, asymmetry : dimensionless
    quadratic, cubic : 1/U and 1/U^2
    misalignment, misalignment_sigma, non_orthogonality : rad
    g_linear, g_quadratic : U/(m/s^2) and U/(m/s^2)^2
    bandwidth_hz : Hz, 0 for no lag
    order : 1 or 2, of the lag
    saturation : U, 0 for no limit
    quantum : U s, 0 for no quantisation
    temperature_bias, temperature_scale : U/K and 1/K
    reported_sigma : U; negative to report the standard deviation of the noise
    """

    bias: tuple
    turn_on_sigma: tuple
    gauss_markov_sigma: tuple
    gauss_markov_time: tuple
    white: tuple
    walk: tuple
    flicker: tuple
    scale: tuple
    scale_sigma: tuple
    asymmetry: tuple
    cubic: tuple
    misalignment: tuple
    misalignment_sigma: tuple
    non_orthogonality: tuple
    bandwidth_hz: tuple
    order: int
    saturation: tuple
    quantum: tuple
    temperature_bias: tuple
    temperature_scale: tuple
    reported_sigma: tuple
    quadratic: tuple = (0.0, 0.0, 0.0)
    g_linear: tuple = (0.0, 0.0, 0.0)
    g_quadratic: tuple = (0.0, 0.0, 0.0)


G2 = STANDARD_GRAVITY * STANDARD_GRAVITY
_COMMON = {
    'gauss_markov_time_s': ('gauss_markov_time', 1.0),
    'scale_factor_ppm': ('scale', 1e-6),
    'scale_factor_sigma_ppm': ('scale_sigma', 1e-6),
    'scale_asymmetry_ppm': ('asymmetry', 1e-6),
    'misalignment_mrad': ('misalignment', 1e-3),
    'misalignment_sigma_mrad': ('misalignment_sigma', 1e-3),
    'non_orthogonality_mrad': ('non_orthogonality', 1e-3),
    'bandwidth_hz': ('bandwidth_hz', 1.0),
    'bandwidth_order': ('order', None),
    'temperature_scale_ppm_c': ('temperature_scale', 1e-6),
}
# Settings key to (coefficient, SI value of its unit). The white noise has two keys; settings
# contain one of them. Both give its density N in SI: 1 deg/sqrt(h) is pi/180/60 rad/s/sqrt(Hz),
# and 1 m/s/sqrt(h) is 1/60 m/s^2/sqrt(Hz).
KEYS = {
    GyroErrors: _COMMON | {
        'bias_deg_h': ('bias', DEG_H),
        'turn_on_bias_sigma_deg_h': ('turn_on_sigma', DEG_H),
        'gauss_markov_sigma_deg_h': ('gauss_markov_sigma', DEG_H),
        'noise_density_rad_s_sqrt_hz': ('white', 1.0),
        'angle_random_walk_deg_sqrt_h': ('white', DEG / SQRT_H),
        'rate_random_walk_deg_h_sqrt_h': ('walk', DEG_H / SQRT_H),
        'bias_instability_deg_h': ('flicker', DEG_H),
        'cubic_ppm_s2_deg2': ('cubic', 1e-6 / (DEG * DEG)),
        'g_sensitivity_deg_h_g': ('g_linear', DEG_H / STANDARD_GRAVITY),
        'g2_sensitivity_deg_h_g2': ('g_quadratic', DEG_H / G2),
        'saturation_deg_s': ('saturation', DEG),
        'quantisation_arcsec': ('quantum', DEG / 3600.0),
        'temperature_bias_deg_h_c': ('temperature_bias', DEG_H),
        'reported_sigma_deg_s': ('reported_sigma', DEG),
    },
    AccelerometerErrors: _COMMON | {
        'bias_ug': ('bias', UG),
        'turn_on_bias_sigma_ug': ('turn_on_sigma', UG),
        'gauss_markov_sigma_ug': ('gauss_markov_sigma', UG),
        'noise_density_m_s2_sqrt_hz': ('white', 1.0),
        'velocity_random_walk_m_s_sqrt_h': ('white', 1.0 / SQRT_H),
        'acceleration_random_walk_ug_sqrt_h': ('walk', UG / SQRT_H),
        'bias_instability_ug': ('flicker', UG),
        'quadratic_ug_g2': ('quadratic', UG / G2),
        'cubic_ug_g3': ('cubic', UG / (G2 * STANDARD_GRAVITY)),
        'saturation_g': ('saturation', STANDARD_GRAVITY),
        'quantisation_mm_s': ('quantum', 1e-3),
        'temperature_bias_ug_c': ('temperature_bias', UG),
        'reported_sigma_m_s2': ('reported_sigma', 1.0),
    },
}


def triad_model(settings, dt_s, name=''):
    """
    Return the TriadModel of GyroErrors or AccelerometerErrors.

    Parameters
    ----------
    settings : GyroErrors or AccelerometerErrors
    dt_s : sampling period, s
    name : prefix of the keys in messages

    Raises
    ------
    ValueError
        If a value is out of its bounds, or the range of the instrument is too small for its noise
        or pulses. The message names key, value and expectation.
    """
    keys, values, prefix = KEYS[type(settings)], {}, f'{name}.' if name else ''
    known = {f.name: f for f in fields(settings)}
    for key, (coefficient, unit) in keys.items():
        value = getattr(settings, key)
        if key == 'gauss_markov_time_s':
            _check_times(prefix + key, value, known[key])
        else:
            value = check_value(prefix + key, value, known[key])
        if coefficient not in values or any(value):
            values[coefficient] = value if unit is None else tuple(unit * v for v in value)
    model = TriadModel(**values)
    _check_range(settings, model, dt_s, prefix)
    return model


def _check_times(name, value, f):
    """Check correlation times; an infinite one (random walk) passes, unlike in the catalogue."""
    if not hasattr(value, '__iter__') or isinstance(value, str) or len(value) != 3:
        raise ValueError(f'{name} is {value!r}; expected 3 correlation times in s')
    check_value(name, [1.0 if v == math.inf else v for v in value], f)


def _check_range(settings, model, dt_s, prefix):
    names = {coefficient: key for key, (coefficient, _) in KEYS[type(settings)].items()}
    names['white'] = next((name for name in settings.WHITE if any(getattr(settings, name))), '')
    units = dict(KEYS[type(settings)].values())
    key = prefix + names['saturation']
    for axis, most, white, quantum in zip('xyz', model.saturation, model.white, model.quantum):
        if most == 0.0:
            continue
        noise = SIGMAS * white / math.sqrt(dt_s)
        for least, what in ((noise, f'{SIGMAS:g} standard deviations of the white noise '
                             f'({names["white"]}) of a sample'),
                            (quantum / dt_s, f'one pulse ({names["quantum"]}) a sample')):
            if most < least:
                unit = units['saturation']
                raise ValueError(f'{key} is {most / unit:g} on axis {axis}; expected at least '
                                 f'{least / unit:.4g}, {what}')


def noise_variance(model, dt_s):
    """
    Return the variance of white noise and quantisation of one sample by axis, U^2.

    It is N^2/dt + (q/dt)^2/6: the quantisation error of a sample is the difference of two
    remainders, each with variance q^2/12.
    """
    return tuple(n * n / dt_s + q * q / (6.0 * dt_s * dt_s)
                 for n, q in zip(model.white, model.quantum))


def white_variance(settings, dt_s, name=''):
    """
    Return the variance that is published with a sample, by axis, (rad/s)^2 or (m/s^2)^2.

    It is the square of the setting reported_sigma or, if that is negative, the variance of the
    noise.

    Parameters
    ----------
    settings : GyroErrors or AccelerometerErrors
    dt_s : sampling period, s
    name : prefix of the keys in messages
    """
    model = triad_model(settings, dt_s, name)
    return reported_variance(noise_variance(model, dt_s), model.reported_sigma)


def reported_variance(variances, sigmas):
    """Return the variances by axis, replaced by the square of each sigma that is not negative."""
    return tuple(v if s < 0.0 else s * s for v, s in zip(variances, sigmas))


def temperature_off(temperature, t_s):
    """Return the temperature minus the calibration temperature, K, at times t_s (s)."""
    off = temperature.constant_c - temperature.reference_c + temperature.ramp_c_h * t_s / 3600.0
    if temperature.amplitude_c:
        off = off + temperature.amplitude_c * sin(2.0 * math.pi * t_s / temperature.period_s)
    return off
