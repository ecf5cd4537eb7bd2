"""A-priori standard deviations of the errors of an instrument, from its error settings."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from .triad_errors import FLICKER_SIGMA, FLICKER_TIMES, TriadErrors
from .triad_model import KEYS, noise_variance, triad_model

# Time constant, s, up to which a process counts as white noise for a navigator; slower processes
# count as constant.
SLOW_S = 100.0
# Coefficients of a triad that are random, and those that carry a state from sample to sample.
RANDOM = ('turn_on_sigma', 'gauss_markov_sigma', 'flicker', 'white', 'walk', 'scale_sigma',
          'misalignment_sigma')
REMEMBERED = ('bandwidth_hz', 'saturation', 'quantum')


class TriadSigmas(NamedTuple):
    """
    Variances and spectral densities of the errors of a triad, tuples of three by body axis.

    U is the unit of the triad: rad/s for gyros, m/s^2 for accelerometers.

    Attributes
    ----------
    bias : variance of the bias at the start, U^2
    scale : variance of the scale factor error at the start
    misalignment : variance of the misalignment at the start, rad^2
    white : spectral density of the white noise, U^2 s
    walk : spectral density of the random walk of the bias, U^2/s
    sample : variance of the white noise and pulses of one sample, U^2
    """

    bias: tuple
    scale: tuple
    misalignment: tuple
    white: tuple
    walk: tuple
    sample: tuple


def triad_sigmas(settings, dt_s, name=''):
    """
    Return the TriadSigmas of the errors that differ from run to run.

    Of flicker noise and Gauss-Markov processes, the parts with a time constant of at most SLOW_S
    count as white noise and the slower parts as a constant bias. The latter overestimates them
    after a few time constants.

    Parameters
    ----------
    settings : GyroErrors or AccelerometerErrors
    dt_s : sampling period, s
    name : prefix of the keys in the ValueError that ``triad_model`` raises
    """
    m = triad_model(settings, dt_s, name)
    fast = slow = 0.0
    for time in FLICKER_TIMES:
        fast, slow = (fast + 2.0 * time, slow) if time <= SLOW_S else (fast, slow + 1.0)
    flicker = FLICKER_SIGMA * FLICKER_SIGMA * np.square(m.flicker)
    variance, time = np.square(m.gauss_markov_sigma), np.array(m.gauss_markov_time)
    walking, white = np.isinf(time), time <= SLOW_S
    found = (
        np.square(m.turn_on_sigma) + slow * flicker + np.where(walking | white, 0.0, variance),
        np.square(m.scale_sigma), np.square(m.misalignment_sigma),
        np.square(m.white) + fast * flicker + 2.0 * variance * np.where(white, time, 0.0),
        np.square(m.walk) + np.where(walking, variance / 3600.0, 0.0),
        noise_variance(m, dt_s))
    return TriadSigmas(*(tuple(float(x) for x in values) for values in found))


def fixed_errors(settings):
    """
    Return a function (input, force) -> error for the errors that are the same in every run.

    The function takes and returns three floats by body axis, see ``TriadErrors.step``. The result
    is None if the triad has no such errors. Lags, the limits of the range, pulses and temperature
    are left out.

    Parameters
    ----------
    settings : GyroErrors or AccelerometerErrors
    """
    off = {key: (0.0,) * 3 for key, (coefficient, _) in KEYS[type(settings)].items()
           if coefficient in RANDOM + REMEMBERED}
    triad = TriadErrors(replace(settings, **off), 0, 0, '', 1.0)
    if triad.perfect:
        return None

    def error(value, force):
        found = triad.step(0, value, force, 0.0)
        return found[0] - value[0], found[1] - value[1], found[2] - value[2]

    return error
