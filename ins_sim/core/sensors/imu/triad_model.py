"""The error model of a triad in SI, made from the settings of either triad and checked."""

from dataclasses import dataclass, fields
import math

from ins_sim.core.numerics.elementary import log, sin
from ins_sim.core.numerics.units import DEG, DEG_H, SQRT_H, STANDARD_GRAVITY, UG
from ins_sim.settings.catalogue import check_value
from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors

# The Allan deviation of flicker noise over its coefficient B, sqrt(2 ln 2 / pi) (IEEE Std 952).
FLICKER_FLOOR = math.sqrt(2.0 * log(2.0) / math.pi)
# Noise must stay inside the range by this factor.
SIGMAS = 5.0


@dataclass(frozen=True)
class TriadModel:
    """
    Coefficients by axis, tuples of three, in rad/s or m/s^2 (here: U), rad, s and kelvin.

    bias, turn_on_sigma, gauss_markov_sigma, flicker U; gauss_markov_time s; white U sqrt(s);
    walk U/sqrt(s); scale, scale_sigma, asymmetry 1; quadratic 1/U; cubic 1/U^2; misalignment,
    misalignment_sigma, non_orthogonality rad; g_linear U/(m/s^2), g_quadratic U/(m/s^2)^2;
    bandwidth_hz Hz, order 1 or 2; saturation U, quantum U s, 0 = none; temperature_bias U/K,
    temperature_scale 1/K; reported_sigma U, negative = that of the noise.
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
# Settings key to (coefficient, its SI value of one unit).  The white noise has two keys, of which
# settings give one: its density is N in SI, and 1 deg/sqrt(h) is pi/180/60 rad/s/sqrt(Hz), as one
# m/s/sqrt(h) is 1/60 m/s^2/sqrt(Hz).
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

    dt_s: sampling period, s; name: what stands before the keys in a message.  Raises ValueError,
    in one sentence that names key, value and expectation, on anything out of its bounds, and on
    noise or pulses that do not fit into the range of the instrument.
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
    """Check correlation times; infinite ones, which the catalogue refuses, are random walks."""
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
    Return the variance of white noise and quantiser of one sample by axis, U^2.

    N^2/dt + (q/dt)^2/6: the pulses of a sample err by the difference of two remainders, each of
    variance q^2/12.
    """
    return tuple(n * n / dt_s + q * q / (6.0 * dt_s * dt_s)
                 for n, q in zip(model.white, model.quantum))


def white_variance(settings, dt_s, name=''):
    """
    Return the variance to report of one sample by axis, (rad/s)^2 or (m/s^2)^2.

    That of the noise, or where the setting reported_sigma is not negative its square.
    """
    model = triad_model(settings, dt_s, name)
    return reported_variance(noise_variance(model, dt_s), model.reported_sigma)


def reported_variance(variances, sigmas):
    """Return the variances by axis, or where a sigma is not negative its square."""
    return tuple(v if s < 0.0 else s * s for v, s in zip(variances, sigmas))


def temperature_off(temperature, t_s):
    """Return by how much the instruments are warmer than at calibration, K, at times t_s."""
    off = temperature.constant_c - temperature.reference_c + temperature.ramp_c_h * t_s / 3600.0
    if temperature.amplitude_c:
        off = off + temperature.amplitude_c * sin(2.0 * math.pi * t_s / temperature.period_s)
    return off
