"""Estimated delays equal the set ones, with the stated scatter."""

import math

import numpy as np
import pytest
from scipy.stats import chi2

from ins_sim.core.calibration.delays import BY_RESIDUALS, BY_WALK, estimate_triad
from ins_sim.core.calibration.model_lag import model_lags
from support.readings.bench import (DELAYS, DIAGONAL, FOG, ideal, MOTION_2, read, REVERSED_2,
                                    thinned)

SET_US = np.array([2.0, 1.0, 3.0])


def lag_of_first_order(bandwidth_hz, dt_s, frequency_hz):
    """Return the phase lag of mean outputs behind mean inputs over the angular frequency, s."""
    w, z = 2.0 * math.pi * bandwidth_hz, np.exp(2j * math.pi * frequency_hz * dt_s)
    decay = math.exp(-w * dt_s)
    # The state after an interval is u + decay (x - u), the mean output u + (1 - decay) / (w dt)
    # times the remainder of x - u at its start.
    state = (1.0 - decay) / (z - decay)
    response = 1.0 + (1.0 - decay) / (w * dt_s) * (state - 1.0)
    return -np.angle(response) / (2.0 * math.pi * frequency_hz)


def test_the_lag_of_the_fog_is_361_5_us():
    """
    The lag of the FOG, 440 Hz at 100 Hz, is 361.5 us under an oscillation of 1 Hz.

    The model and its frequency response agree. The motion is evaluated at whole nanoseconds, which
    limits the estimate.
    """
    record, chosen = ideal({**DIAGONAL, **FOG}, 20.0)
    found = 1e6 * model_lags([record], chosen.imu_sensor.gyro.errors)
    assert found == pytest.approx(361.5, abs=0.05)
    assert found == pytest.approx(1e6 * lag_of_first_order(440.0, 0.01, 1.0), abs=1e-3)


@pytest.mark.slow
def test_twelve_seeds_of_the_fog_on_the_diagonal():
    """
    The mean of twelve seeds is within 0.15 us of the truth, and the scatter is the stated one.

    The 36 squares of error over sigma are within 99.9 % of chi-square, also if the angle random
    walk is unknown.
    """
    record, chosen = ideal({**DIAGONAL, **FOG, **DELAYS}, 600.0)
    truth = 1e-6 * SET_US + model_lags([record], chosen.imu_sensor.gyro.errors)
    errors, sigmas, by_residuals = [], [], []
    for seed in range(12):
        one = read(record, chosen, seed)
        channels = estimate_triad([one]).channels
        assert {c.weights for c in channels} == {BY_WALK}
        errors.append([c.delay - t for c, t in zip(channels, truth)])
        sigmas.append([c.delay_sigma for c in channels])
        blind = estimate_triad([replaced_walk(one, 0.0)]).channels
        assert {c.weights for c in blind} == {BY_RESIDUALS}
        by_residuals.append([(c.delay - t) / c.delay_sigma for c, t in zip(blind, truth)])
    errors, sigmas = np.array(errors), np.array(sigmas)
    assert np.abs(errors.mean(axis=0)).max() < 0.15e-6
    low, high = chi2.ppf([0.0005, 0.9995], errors.size)
    assert low < np.square(errors / sigmas).sum() < high
    assert low < np.square(by_residuals).sum() < high
    assert 1e6 * sigmas == pytest.approx(0.101, abs=0.001)
    print(f'mean error {1e6 * errors.mean(axis=0)} us, scatter over sigma '
          f'{np.sqrt(np.square(errors / sigmas).mean()):.3f}, by residuals '
          f'{np.sqrt(np.square(by_residuals).mean()):.3f}')


def replaced_walk(record, factor):
    """Return a record whose stated white noise is the actual one times a factor."""
    return type(record)(**{**vars(record), 'white': tuple(factor * w for w in record.white)})


def test_one_seed_on_the_diagonal():
    """
    Delays from one minute are within four sigma, which is sqrt(10) times that of ten minutes.
    """
    record, chosen = ideal({**DIAGONAL, **FOG, **DELAYS}, 60.0)
    truth = 1e-6 * SET_US + model_lags([record], chosen.imu_sensor.gyro.errors)
    for channel, delay in zip(estimate_triad([read(record, chosen, 5)]).channels, truth):
        assert 1e6 * channel.delay_sigma == pytest.approx(0.1014 * math.sqrt(10.0), rel=0.01)
        assert abs(channel.delay - delay) < 4.0 * channel.delay_sigma


def test_motion_2_there_and_back():
    """Two records of five minutes give the delays of y and z, and the drawn geometry."""
    there, chosen = ideal({**MOTION_2, **FOG, **DELAYS}, 300.0)
    back, _ = ideal({**REVERSED_2, **FOG, **DELAYS}, 300.0, start_s=300.0)
    records = [read(there, chosen, 3), read(back, chosen, 3)]
    found = estimate_triad(records).channels
    lags = model_lags([there, back], chosen.imu_sensor.gyro.errors)
    assert found[0].refused and math.isnan(lags[0])
    for channel, lag, delay in zip(found[1:], lags[1:], SET_US[1:]):
        assert not channel.refused
        assert abs(channel.delay - lag - 1e-6 * delay) < 4.0 * channel.delay_sigma


def test_residuals_that_are_larger_than_the_noise_said_give_the_sigmas():
    """If a third of the true random walk is stated, sigma comes from the scatter and is right."""
    record, chosen = ideal({**DIAGONAL, **FOG, **DELAYS}, 60.0)
    one = read(record, chosen, 1)
    told = estimate_triad([replaced_walk(one, 1.0 / 3.0)])
    right = estimate_triad([one])
    for channel, other in zip(told.channels, right.channels):
        assert channel.weights == BY_RESIDUALS and other.weights == BY_WALK
        # From 64 blocks sigma is known to 9 %.
        assert channel.delay_sigma == pytest.approx(other.delay_sigma, rel=0.3)
    assert sum('scatter' in note for note in told.notes) == 3


def test_gaps_cost_their_readings_alone():
    """A third of the readings lost, and 10 s in one part: gaps are counted, the rest is used."""
    record, chosen = ideal({**DIAGONAL, **FOG, **DELAYS}, 60.0)
    one = read(record, chosen, 1)
    count = len(one.imu)
    kept = np.random.default_rng(1).random(count) > 1.0 / 3.0
    kept[3000:4000] = False
    lost = estimate_triad([thinned(one, kept)])
    for channel, whole in zip(lost.channels, estimate_triad([one]).channels):
        # The missing readings increase the variance accordingly.
        apart = math.sqrt(channel.delay_sigma ** 2 - whole.delay_sigma ** 2)
        assert abs(channel.delay - whole.delay) < 4.0 * apart
        assert channel.delay_sigma / whole.delay_sigma == pytest.approx(
            math.sqrt(count / kept.sum()), rel=0.03)
    used = np.flatnonzero(kept)[1:]
    assert f'{np.count_nonzero(np.diff(used) > 1)} gaps' in lost.notes[0]
