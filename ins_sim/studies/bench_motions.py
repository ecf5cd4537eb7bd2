"""
Compare bench motions by the standard deviations of the gyro delays that they allow to estimate.
"""

from dataclasses import dataclass, replace
import math

import numpy as np

from ins_sim.core.calibration.foreseen import foresee, ForeseenDelays, planned_record
from ins_sim.core.motion.factory import make_motion
from ins_sim.settings.motion import Coning, MotionSettings, Rocking, TwoAxis

# Psi and theta of a level rocking about north for which the axis is the diagonal of the body: all
# three axes rotate alike.
DIAGONAL = {'psi_deg': math.degrees(math.atan(math.sqrt(0.5))), 'theta_deg': -45.0,
            'gamma_deg': 0.0}
AMPLITUDES_DEG = (1.0, 5.0, 20.0)
# Number of rocking periods over which the standard deviation is computed before it is scaled to
# the length.
PERIODS, SHORTEST_S = 4.0, 10.0


@dataclass(frozen=True)
class BenchCase:
    """A bench motion: name, and MotionSettings of its parts, which have equal lengths."""

    name: str
    parts: tuple


@dataclass(frozen=True, eq=False)
class RockingSweep:
    """
    Rocking about the diagonal: frequencies (n,), Hz, and sigmas (n, amplitudes), s.

    NaN if the rocking exceeds the range of the gyros.
    """

    frequencies_hz: np.ndarray
    amplitudes_deg: tuple
    sigmas: np.ndarray


def diagonal_rocking(amplitude_deg=5.0, frequency_hz=1.0):
    """Return the MotionSettings of a rocking about the diagonal of the body."""
    return MotionSettings(kind='rocking', rocking=Rocking('north', amplitude_deg, frequency_hz),
                          **DIAGONAL)


def single_rocking():
    """Return the MotionSettings of the same rocking about the forward axis of the body."""
    return MotionSettings(kind='rocking', rocking=Rocking('x'))


def bench_cases():
    """Return the BenchCases that are compared."""
    one_sense = MotionSettings(kind='two_axis')
    reversed_sense = replace(one_sense, two_axis=TwoAxis(-1.0, -0.5))
    return [
        BenchCase('rocking about the diagonal, 5 deg, 1 Hz', (diagonal_rocking(),)),
        BenchCase('motion 1: rocking about north at psi 45 deg, 5 deg, 1 Hz',
                  (MotionSettings(kind='rocking', psi_deg=45.0, theta_deg=0.0),)),
        BenchCase('rocking about the forward axis, 5 deg, 1 Hz',
                  (single_rocking(),)),
        BenchCase('motion 2, reversed half-way', (one_sense, reversed_sense)),
        BenchCase('three angles at 0.3, 0.5 and 0.7 Hz', (MotionSettings(kind='sinusoids'),)),
        BenchCase('coning, 5 deg, 1 Hz',
                  (MotionSettings(kind='coning', coning=Coning('z', 5.0, 1.0)),)),
        BenchCase('motion 2 in one sense', (one_sense,))]


def foresee_case(case, settings, white, duration_s):
    """
    Return the ForeseenDelays of a BenchCase.

    Parameters
    ----------
    case : BenchCase
    settings : SimulationSettings; only position, rate and start are used
    white : (3,) angle random walk, rad/sqrt(s)
    duration_s : length of all parts together, s
    """
    generator, part_s = settings.motion_generator, duration_s / len(case.parts)
    records = [planned_record(
        case.name, make_motion(part, generator.datum, generator.earth), generator.datum,
        generator.earth, white, settings.imu_sensor.rate_hz, generator.start_s + k * part_s,
        part_s) for k, part in enumerate(case.parts)]
    return foresee(records)


def sweep_rocking(settings, white, duration_s, frequencies_hz):
    """Return the RockingSweep for a length in s; settings and white: see ``foresee_case``."""
    sigmas = np.full((len(frequencies_hz), len(AMPLITUDES_DEG)), np.nan)
    ranges = [r for r in settings.imu_sensor.gyro.errors.saturation_deg_s if r]
    most_deg_s = math.sqrt(3.0) * min(ranges, default=math.inf)
    for i, frequency in enumerate(frequencies_hz):
        span_s = math.ceil(max(PERIODS, SHORTEST_S * frequency)) / frequency
        for k, amplitude in enumerate(AMPLITUDES_DEG):
            if amplitude * 2.0 * math.pi * frequency > most_deg_s:
                continue
            case = BenchCase('rocking', (diagonal_rocking(amplitude, float(frequency)),))
            found: ForeseenDelays = foresee_case(case, settings, white, span_s)
            sigmas[i, k] = max(found.sigmas) * math.sqrt(span_s / duration_s)
    return RockingSweep(np.asarray(frequencies_hz), AMPLITUDES_DEG, sigmas)


def direction_map(single_sigma, azimuth_deg, elevation_deg):
    """
    Return the largest sigma of the three delays for each direction of the rocking axis.

    A channel rotates by the component of the rocking along its axis, and sigma is inversely
    proportional to it.

    Parameters
    ----------
    single_sigma : sigma of a channel that is rocked about its own axis, s
    azimuth_deg : (n,) direction of the rocking axis in the body, from forward to the left, deg
    elevation_deg : (m,) direction of the rocking axis in the body, upwards, deg

    Returns
    -------
    (m, n) array
        Largest sigma, s.
    """
    azimuth, elevation = np.radians(azimuth_deg), np.radians(elevation_deg)[:, None]
    level = np.cos(elevation)
    parts = np.abs(np.stack(np.broadcast_arrays(
        level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation) + 0.0 * azimuth)))
    return single_sigma / np.maximum(parts.min(axis=0), 1e-9)
