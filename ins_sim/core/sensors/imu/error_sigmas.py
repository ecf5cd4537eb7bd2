"""What is known of the errors of an instrument beforehand, from its own figures."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from .triad_errors import FLICKER_SIGMA, FLICKER_TIMES, TriadErrors
from .triad_model import KEYS, noise_variance, triad_model

# What changes faster is white noise to a navigator, s; what changes more slowly stays as it is.
SLOW_S = 100.0
# Coefficients of a triad that are drawn, or that carry something from sample to sample.
RANDOM = ('turn_on_sigma', 'gauss_markov_sigma', 'flicker', 'white', 'walk', 'scale_sigma',
          'misalignment_sigma')
REMEMBERED = ('bandwidth_hz', 'saturation', 'quantum')


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
    Return the TriadSigmas of GyroErrors or AccelerometerErrors: of what differs from run to run.

    dt_s: sampling period, s; name: as of ``triad_model``, whose ValueError it raises.  Of flicker
    noise and Gauss-Markov processes, what has a time constant of at most SLOW_S is white noise,
    the rest a bias that stays, which is more than it does after a few time constants.
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
    Return a function (input, force) -> error of the errors that are the same in every run.

    settings: GyroErrors or AccelerometerErrors.  Inputs and errors are three floats by body axis,
    as of ``TriadErrors.step``; None where a triad has no such errors.  Lags, range and pulses are
    left out, and temperature.
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
