"""What is known of the errors of an instrument beforehand, from its own figures."""

from typing import NamedTuple

import numpy as np

from ins_sim.core.numerics.units import STANDARD_GRAVITY
from ins_sim.settings.instrument_errors import AccelerometerErrors
from .triad_errors import FLICKER_SIGMA, FLICKER_TIMES
from .triad_model import noise_variance, triad_model

# What changes faster is white noise to a navigator, s; what changes more slowly stays as it is.
SLOW_S = 100.0


class TriadSigmas(NamedTuple):
    """
    Variances and densities of the errors of a triad by axis, tuples of three (U: rad/s or m/s^2).

    bias U^2, scale 1, misalignment rad^2: at the start; white U^2 s, walk U^2/s: densities;
    sample U^2: of one sample.
    """

    bias: tuple
    scale: tuple
    misalignment: tuple
    white: tuple
    walk: tuple
    sample: tuple


def triad_sigmas(settings, dt_s, name=''):
    """
    Return the TriadSigmas of GyroErrors or AccelerometerErrors.

    dt_s: sampling period, s; name: as of ``triad_model``, whose ValueError it raises.  What is
    the same in every run is squared in: fixed biases, scale factors and misalignments, the
    asymmetry as a scale factor, the non-orthogonality as the misalignment that turns the same
    axis, and what 1 g causes (g-sensitivity, quadratic and cubic terms of an accelerometer) as a
    bias.  Temperature, lags and terms of a rotor are left out.
    """
    m = triad_model(settings, dt_s, name)
    one_g = STANDARD_GRAVITY if isinstance(settings, AccelerometerErrors) else 0.0
    fast = sum(2.0 * time for time in FLICKER_TIMES if time <= SLOW_S)
    slow = sum(1.0 for time in FLICKER_TIMES if time > SLOW_S)
    flicker = FLICKER_SIGMA * FLICKER_SIGMA * np.square(m.flicker)
    sigma, time = np.array(m.gauss_markov_sigma), np.array(m.gauss_markov_time)
    walking, white = np.isinf(time), time <= SLOW_S
    variance = sigma * sigma
    # of axis y towards x (about z), of z towards x (about y) and towards y (about x)
    about_z, about_y, about_x = m.non_orthogonality
    found = (
        _squares(m.bias, m.turn_on_sigma, _power(m.g_linear, STANDARD_GRAVITY, 1),
                 _power(m.g_quadratic, STANDARD_GRAVITY, 2), _power(m.quadratic, one_g, 2),
                 _power(m.cubic, one_g, 3))
        + slow * flicker + np.where(walking | white, 0.0, variance),
        _squares(m.scale, m.scale_sigma, m.asymmetry),
        _squares(m.misalignment, m.misalignment_sigma, (about_x, about_y, about_z)),
        np.square(m.white) + fast * flicker
        + np.where(white, 2.0 * variance * np.where(white, time, 0.0), 0.0),
        np.square(m.walk) + np.where(walking, variance / 3600.0, 0.0),
        noise_variance(m, dt_s))
    return TriadSigmas(*(tuple(float(x) for x in values) for values in found))


def _power(coefficients, value, power):
    """Return coefficients times a power of a value, (3,)."""
    found = np.array(coefficients)
    for _ in range(power):
        found = found * value
    return found


def _squares(*terms):
    """Return the sums of the squares of terms by axis, (3,)."""
    total = np.zeros(3)
    for term in terms:
        total = total + np.square(term)
    return total
