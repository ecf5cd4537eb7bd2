"""The error sources in the settings: one for each parameter that is not zero."""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.numerics.units import DEG
from ins_sim.core.sensors.imu.triad_errors import FLICKER_SIGMA, FLICKER_TIMES
from ins_sim.core.sensors.imu.triad_model import KEYS

ACCELEROMETER, GYRO = 0, 1
# Coefficients of TriadModel that are drawn once per run, in the order of ``TimeLanes.by_error``.
CONSTANTS = ('turn_on_sigma', 'scale_sigma', 'misalignment_sigma')
# Labels of the random coefficients, for accelerometers and gyros.
RANDOM_WORDS = {
    'turn_on_sigma': ('turn-on bias',) * 2, 'scale_sigma': ('scale factor',) * 2,
    'misalignment_sigma': ('misalignment',) * 2,
    'white': ('velocity random walk', 'angle random walk'),
    'walk': ('acceleration random walk', 'rate random walk'),
    'gauss_markov_sigma': ('in-run bias',) * 2, 'flicker': ('bias instability',) * 2}
FIXED_WORDS = {
    'bias': 'given bias', 'scale': 'given scale factor', 'asymmetry': 'scale asymmetry',
    'quadratic': 'quadratic error', 'cubic': 'cubic error', 'misalignment': 'given misalignment',
    'non_orthogonality': 'non-orthogonality', 'g_linear': 'g-sensitivity',
    'g_quadratic': 'g2-sensitivity', 'bandwidth_hz': 'lag', 'temperature_bias':
    'temperature, bias', 'temperature_scale': 'temperature, scale factor'}
TRIAD_WORDS = 'accelerometer', 'gyro'


@dataclass(frozen=True)
class ErrorSource:
    """
    One source of errors.

    Attributes
    ----------
    key : name of the parameter
    label : description
    unit : unit of the parameter
    values : values of the three axes in this unit, or (value,) for all
    si : the same in SI units
    fixed : whether the error is the same in every run
    triad : ACCELEROMETER, GYRO, or None for initial errors
    kind : the coefficient of TriadModel, or of the initial errors
    inverse : True if the error is inversely proportional to the parameter, as the error of a lag
        to its bandwidth; False if it is proportional

    """

    key: str
    label: str
    unit: str
    values: tuple
    si: tuple
    fixed: bool
    triad: int | None
    kind: str
    inverse: bool = False


@dataclass(frozen=True)
class MarkovProcess:
    """A stationary process: its source; by axis, time constants (s) and variances for a unit."""

    source: ErrorSource
    time_s: tuple
    variance: tuple


def sources_of(markov):
    """Return the ErrorSources of MarkovProcesses, each once."""
    return list(dict.fromkeys(process.source for process in markov))


def random_sources(gyro, accelerometer):
    """Return the ErrorSources of both triads that differ from run to run."""
    found = []
    for triad, settings in ((ACCELEROMETER, accelerometer), (GYRO, gyro)):
        for kind, words in RANDOM_WORDS.items():
            for key, (coefficient, unit) in KEYS[type(settings)].items():
                values = getattr(settings, key)
                if coefficient == kind and any(values):
                    found.append(triad_source(settings, triad, key, words[triad], False))
    return found


def triad_source(settings, triad, key, words, fixed, inverse=False):
    """Return the ErrorSource of a parameter of GyroErrors or AccelerometerErrors."""
    kind, unit = KEYS[type(settings)][key]
    values = getattr(settings, key)
    described = type(settings).__dataclass_fields__[key].metadata['unit']
    return ErrorSource(f'{settings.NAME}.{key}', f'{TRIAD_WORDS[triad]} {words}', described,
                       values, tuple(unit * v for v in values), fixed, triad, kind, inverse)


def start_sources(initial):
    """Return the ErrorSources for the standard deviations in settings.strapdown.Initial."""
    return [ErrorSource(f'initial.{key}', words, unit, (value,), (value * si,), False, None, kind)
            for key, words, unit, si, kind in (
                ('position_sigma_m', 'initial position', 'm', 1.0, 'position'),
                ('velocity_sigma_m_s', 'initial velocity', 'm/s', 1.0, 'velocity'),
                ('tilt_sigma_mrad', 'initial tilt', 'mrad', 1e-3, 'tilt'),
                ('azimuth_sigma_mrad', 'initial azimuth', 'mrad', 1e-3, 'azimuth'))
            if (value := getattr(initial, key))]


def start_errors(initial):
    """Return the ErrorSources for the given errors in settings.strapdown.Initial."""
    return [ErrorSource(f'initial.{key}', words, unit, values, tuple(si * v for v in values), True,
                        None, kind)
            for key, words, unit, si, kind in (
                ('position_error_m', 'given initial position', 'm', 1.0, 'position'),
                ('velocity_error_m_s', 'given initial velocity', 'm/s', 1.0, 'velocity'),
                ('attitude_error_deg', 'given initial attitude', 'deg', DEG, 'attitude'))
            if any(values := getattr(initial, key))]


def processes(sources, triad, settings):
    """
    Return the MarkovProcesses and the random walks of a triad.

    A walk is a pair: its source, and the density of the walk for a unit of the source, 1/s. A
    Gauss-Markov process with infinite time constant is a walk that reaches its standard deviation
    after an hour.

    sources: ErrorSources; settings: GyroErrors or AccelerometerErrors.
    """
    markov, walks = [], []
    for source in sources:
        if source.triad != triad:
            continue
        if source.kind == 'flicker':
            markov += [MarkovProcess(source, (time,) * 3,
                                     (FLICKER_SIGMA * FLICKER_SIGMA,) * 3)
                       for time in FLICKER_TIMES]
        elif source.kind == 'walk':
            walks.append((source, np.ones(3)))
        elif source.kind == 'gauss_markov_sigma':
            walking = np.isinf(settings.gauss_markov_time_s)
            if walking.any():
                walks.append((source, np.where(walking, 1.0 / 3600.0, 0.0)))
            if not walking.all():
                markov.append(MarkovProcess(source, tuple(
                    1.0 if math.isinf(t) else t for t in settings.gauss_markov_time_s),
                    tuple(0.0 if w else 1.0 for w in walking.tolist())))
    return markov, walks
