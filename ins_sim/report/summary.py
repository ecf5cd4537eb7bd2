"""Numbers of a run: predicted, measured and published values side by side."""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.simulation.inertial import withheld_readings
from . import coverage

DEG_PER_HOUR = 180.0 / math.pi * 3600.0

# Largest |dN|, |dE| in metres during one hour at 100 Hz: the tables for the two motions of
# Bogdanov and Fomichev (2018) and for the closed-form flights, re-derived
# (docs/explanation/validation.md). Key: kind, theta, detuning.
PUBLISHED_POSITION = {
    ('rocking', 0.0, 0.0): (111.98, 15.03),
    ('two_axis', -30.0, 0.0): (4472.1, 623.94),
    ('two_axis', -30.0, 0.001): (1963.4, 2931.6),
    ('two_axis', -30.0, 0.01): (34.03, 211.79),
    ('two_axis', -30.0, 0.1): (4.190, 25.60),
    ('two_axis', 0.0, 0.0): (3442.8, 479.48),
    ('two_axis', 0.0, 0.001): (1511.6, 2257.9),
    ('two_axis', 0.0, 0.01): (26.42, 164.61),
    ('two_axis', 0.0, 0.1): (3.501, 21.31),
    ('cruise', None, None): (3.591, 3.327),
    ('aggressive', None, None): (5.997, 10.741)}
# Mean drift, deg/h, by the closed forms (9), exact, and (19) of Bogdanov and Fomichev (2018).
PUBLISHED_DRIFT = {
    ('rocking', 0.0, 0.0): (0.0, 0.0, 0.0154884),
    ('two_axis', -30.0, 0.0): (0.0334932, 0.0, 0.0),
    ('two_axis', 0.0, 0.0): (0.0257831, 0.0, 0.0)}


@dataclass(frozen=True)
class SummaryRow:
    """One result: name, unit, and predicted, measured, zero-delay and published value or None."""

    name: str
    unit: str
    predicted: float | None
    measured: float
    twin: float | None
    published: float | None


def study_key(settings):
    """Return the key in the published tables if they contain these settings, else None."""
    generator, sensor = settings.motion_generator, settings.imu_sensor
    motion, delay = generator.motion, sensor.gyro.delay_us
    taus = (delay.y, delay.x, delay.z)
    nominal = (generator.duration_s == 3600.0 and generator.start_s == 0.0
               and generator.earth.rotation)
    bench = nominal and (generator.datum.latitude_deg, motion.gamma_deg) == (55.75, 0.0)
    if motion.kind == 'rocking':
        s = motion.rocking
        if bench and taus == (0.0, 1.0, 0.0) and (
                s.axis, s.amplitude_deg, s.frequency_hz, motion.psi_deg, motion.theta_deg) == (
                'north', 5.0, 1.0, 45.0, 0.0):
            return 'rocking', 0.0, 0.0
    elif motion.kind == 'two_axis':
        s = motion.two_axis
        if bench and taus == (1.0, 0.0, 0.0) and (
                s.psi_rate_rad_s, s.gamma_rate_rad_s, motion.psi_deg) == (1.0, 0.5, 0.0):
            return 'two_axis', motion.theta_deg, s.detuning_rad_s
    elif nominal and taus == (1.0, 2.0, 3.0) and (
            generator.datum.latitude_deg, generator.datum.longitude_deg) == (55.0, 37.0):
        return motion.kind, None, None
    return None


def summary_rows(settings, errors, twin=None, prediction=None):
    """
    Return the SummaryRows of a run, given its settings, its NavErrors, those of the zero-delay
    twin, and its Prediction.

    Rows that the prediction does not cover (see ``coverage``) are without it.
    """
    of_twin = coverage.comparable_with_twin(settings, prediction)
    prediction = coverage.comparable(settings, prediction)
    key = study_key(settings)
    place, drift = PUBLISHED_POSITION.get(key), PUBLISHED_DRIFT.get(key)
    end, twin_end = errors.drift[-1], None if twin is None else twin.drift[-1]
    table = []
    for axis, name in enumerate(('east', 'north', 'up')):
        table.append(SummaryRow(
            f'mean drift {name}', 'deg/h',
            None if prediction is None else prediction.drift[axis] * DEG_PER_HOUR,
            end[axis] * DEG_PER_HOUR,
            None if twin is None else twin_end[axis] * DEG_PER_HOUR,
            None if drift is None else drift[axis]))
    largest = _largest(block.position for block in errors.blocks())
    if twin is not None:
        twin_largest = _largest(block.position for block in twin.blocks())
    for axis, name in ((1, 'N'), (0, 'E')):
        table.append(SummaryRow(
            f'max |d{name}|', 'm', None if prediction is None else prediction.largest[axis],
            largest[axis], None if twin is None else twin_largest[axis],
            None if place is None else place[1 - axis]))
    if twin is not None:
        apart = _largest(block.position - other.position
                         for block, other in zip(errors.blocks(), twin.blocks()))
        for axis, name in ((1, 'N'), (0, 'E')):
            table.append(SummaryRow(
                f'max |d{name} - twin|', 'm', None if of_twin is None else of_twin.largest[axis],
                apart[axis], None, None))
    return table


def _largest(blocks):
    """Return the largest magnitudes (3,) in blocks (n, 3)."""
    largest = np.zeros(3)
    for block in blocks:
        largest = np.maximum(largest, np.abs(block).max(axis=0))
    return largest


def gap_lines(faults):
    """Return the lines about gaps at which the strapdown was restarted."""
    if not faults:
        return []
    return [f'{len(faults)} gaps; the strapdown started anew after each; the first: '
            f'{faults[0]}']


def withheld_lines(settings):
    """Return the lines about samples at the end that a negative delay makes unavailable."""
    count = withheld_readings(settings)
    if not count:
        return []
    what = 'reading is' if count == 1 else f'{count} readings are'
    return [f'the last {what} left out, because a channel with a negative delay needs the truth '
            'after the end of the run']


def parity_lines(sensor, imu):
    """Return the lines about the parity of tuned gyros of ImuSensorSettings."""
    if imu.parity is None:
        return []
    from ins_sim.core.sensors.tuned_gyro.instrument import PairInstrument
    from ins_sim.core.sensors.tuned_gyro.parity import parity_windows
    found = parity_windows(sensor, PairInstrument(sensor), imu[:])
    beyond = found[found[:, 3] > 0.0]
    if not len(beyond):
        most = (np.abs(found[:, 1]) / found[:, 2]).max() if len(found) else 0.0
        return [f'parity of the gyro channels: at most {most:.2f} of the threshold in '
                f'{len(found)} windows']
    t_s, mean, threshold, _ = beyond[0]
    return [f'parity of the gyro channels: beyond the threshold in {len(beyond)} of {len(found)} '
            f'windows, first in the one that ends at {t_s:g} s: {mean * DEG_PER_HOUR:.4g} deg/h; '
            f'expected at most {threshold * DEG_PER_HOUR:.4g} deg/h']
