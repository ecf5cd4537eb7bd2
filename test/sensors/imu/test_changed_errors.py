"""Biases and faults that change during a run; internal states are kept."""

from dataclasses import replace

import numpy as np
import pytest
from support.studies import MOTION_2, settings

from ins_sim.core.motion.factory import make_motion
from ins_sim.core.numerics.units import DEG_H, UG
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.sensors.imu.with_errors import changed

DT_NS, COUNT = 10_000_000, 400
FULL = {'gyro.errors.angle_random_walk_deg_sqrt_h': [0.01] * 3,
        'gyro.errors.rate_random_walk_deg_h_sqrt_h': [0.5] * 3,
        'gyro.errors.turn_on_bias_sigma_deg_h': [1.0] * 3,
        'gyro.errors.misalignment_mrad': [1.0, -2.0, 3.0],
        'gyro.errors.bandwidth_hz': [30.0] * 3, 'gyro.errors.bandwidth_order': 2,
        'gyro.errors.quantisation_arcsec': [2.0] * 3,
        'accelerometer.errors.bandwidth_hz': [30.0] * 3,
        'accelerometer.errors.quantisation_mm_s': [0.2] * 3}
TUNED = {'gyro.model': 'dtg', 'output': 'integrated', 'input': 'integrated',
         'gyro.dtg.errors.mass_unbalance_deg_h_g': [1.0] * 4,
         'gyro.dtg.fault.channel': 'gyro_1_z', 'gyro.dtg.fault.bias_deg_h': 100.0,
         'gyro.dtg.fault.start_s': 1.0, 'gyro.dtg.fault.end_s': 3.5}
KINDS = {'perfect': {}, 'noise, lags and pulses': FULL, 'tuned': {**FULL, **TUNED},
         'own motion': {**FULL, 'source': 'motion'}, 'late': {**FULL, 'gyro.delay_us.y': 700.0}}


def flown(values, changes=()):
    """Return rates and forces (n, 3) of a flight; changes: {sample: {key: value}}, permanent."""
    s = settings({**MOTION_2, 'source': 'stream', **values})
    imu = make_imu(s.imu_sensor, motion := make_motion(
        s.motion_generator.motion, s.motion_generator.datum, s.motion_generator.earth))
    truth = motion.at(DT_NS * np.arange(COUNT, dtype=np.int64))
    readings, given = [], dict(values)
    for k, sample in enumerate(imu.samples(truth)):
        if k in dict(changes):
            given.update(dict(changes)[k])
            new = settings({**MOTION_2, 'source': 'stream', **given}).imu_sensor
            imu = changed(imu, new)
        readings += imu.push(*sample)
    return np.array([r[1] for r in readings]), np.array([r[2] for r in readings])


@pytest.mark.parametrize('kind', KINDS)
def test_a_change_to_the_same_values_changes_no_bit(kind):
    """Setting equal values again leaves lags, pulses, rotors and fault schedule bit for bit."""
    expected = flown(KINDS[kind])
    got = flown(KINDS[kind], [(k, {}) for k in (1, 7, 150, 151, 300)])
    assert all(np.array_equal(a, b) for a, b in zip(got, expected))


def test_pulses_lose_nothing_at_a_change():
    """The sum of readings equals that of inputs within one pulse despite changing biases."""
    steps = [(100, {'gyro.errors.bias_deg_h': [3600.0] * 3}),
             (200, {'gyro.errors.bias_deg_h': [0.0] * 3,
                    'accelerometer.errors.bias_ug': [1e4] * 3})]
    pulses = {key: value for key, value in FULL.items() if 'quantisation' in key}
    omega, f = (a.sum(axis=0) * 0.01 for a in flown(pulses, steps))
    ideal_omega, ideal_f = (a.sum(axis=0) * 0.01 for a in flown({}))
    # The pulses of sample 0 are counted too, although it has no interval before it.
    assert np.abs(omega - ideal_omega - 3600.0 * DEG_H).max() <= 2.0 * DEG_H
    assert np.abs(f - ideal_f - 2.0 * 1e4 * UG).max() <= 2e-4


def test_a_bias_behind_a_lag_is_there_at_once():
    """A changed bias acts after the lag, like noise, so that the step is not smoothed."""
    lagged = {key: value for key, value in FULL.items() if 'bandwidth' in key}
    omega, _ = flown(lagged, [(200, {'gyro.errors.bias_deg_h': [3600.0] * 3})])
    before, _ = flown(lagged)
    step = (omega - before) / DEG_H
    assert not step[:200].any() and step[200:] == pytest.approx(3600.0, rel=1e-9)


def test_the_imu_without_errors_stays_bare():
    """After a bias is removed again the IMU is ideal and has no wrapper."""
    s = settings({**MOTION_2, 'source': 'stream'}).imu_sensor
    imu = make_imu(s)
    biased = replace(s, gyro=replace(s.gyro, errors=replace(s.gyro.errors,
                                                            bias_deg_h=(1.0,) * 3)))
    assert changed(imu, biased) is not imu
    assert changed(changed(imu, biased), s) is imu
