"""The covariance of the free INS: compared with Monte Carlo, its bits, and its content."""

import numpy as np
import pytest
from support.covariances import ratios, settings_of, SIGMAS, steps_of

from ins_sim import parameter_files, resources
from ins_sim.core.navigation.free_covariance import SIZE
from ins_sim.core.navigation.navigator import InertialNavigator
from ins_sim.core.sensors.imu.with_errors import reported_variances
from ins_sim.core.simulation.free_covariance import (disagreement, free_covariance,
                                                     published_covariance)
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.io.motion import read_motion

FOG, MEMS = 'imu_tactical_fog', 'imu_tactical_mems'
UP = [5, 8]


def in_turn(settings, motion, blocks, covariance):
    """Navigate sample by sample, as a live navigator does."""
    navigator = InertialNavigator(settings, covariance)
    for imu in blocks:
        truth = motion.at(imu.t_ns)
        for k in range(len(imu)):
            navigator.step(int(imu.t_ns[k]), tuple(imu.omega[k].tolist()),
                           tuple(imu.f[k].tolist()), truth.one(k))
            yield k


@pytest.mark.parametrize('values', [
    {}, {'vertical.channel': 'free', 'input': 'integrated', 'output': 'integrated',
         'initial.after_s': 0.83}, {'vertical.channel': 'damped', 'rate_hz': 7.0,
                                    'imu_sensor:rate_hz': 7.0}])
def test_the_stream_gives_the_bits_of_the_batch(values):
    """Readings cut in any way give the same bits, with initial errors and sigmas."""
    settings = settings_of('motion_2', FOG, 5.0, **{
        'initial.position_error_m': [3.0, -2.0, 1.0], **SIGMAS, **values})
    expected = steps_of(settings)
    assert len(expected) > 8
    for found in (steps_of(settings, loop=in_turn),
                  steps_of(settings, cut=lambda imu: (imu[k:k + 37] for k in range(
                      0, len(imu), 37)))):
        assert len(found) == len(expected)
        for one, other in zip(found, expected):
            assert one[0] == other[0] and one[3] == other[3]
            assert np.array_equal(one[1], other[1]) and np.array_equal(one[2], other[2])


def test_what_is_predicted_is_what_runs_show():
    """
    On a minute of racetrack predicted sigmas are 0.75 to 1.25 of those of 60 runs.

    This holds for every axis.
    """
    found = ratios(settings_of('racetrack', MEMS, 60.0, **SIGMAS), [60.0])
    level = np.delete(found, UP, axis=1)
    assert (level > 0.75).all() and (level < 1.25).all(), found.round(2)


@pytest.mark.slow
@pytest.mark.parametrize('channel', ['truth', 'free'])
@pytest.mark.parametrize('instrument', [FOG, MEMS])
@pytest.mark.parametrize('motion', ['rest', 'racetrack'])
def test_the_table_of_predictions(motion, instrument, channel):
    """
    At 60, 300 and 600 s predicted sigmas are 0.75 to 1.25 of those of 60 runs.

    This holds for every axis, including up if the channel is free.
    """
    found = ratios(settings_of(motion, instrument, 600.0, **SIGMAS, **{
        'vertical.channel': channel}), [60.0, 300.0, 600.0])
    print(motion, instrument, channel, found.round(2).tolist())
    if channel == 'truth':
        found = np.delete(found, UP, axis=1)
    assert (found > 0.75).all() and (found < 1.25).all(), found.round(2)


@pytest.mark.slow
def test_the_prediction_of_motion_2():
    """
    On motion 2 the predicted error of 16 km in 600 s is within 0.6 to 1.6 of the runs.

    Almost all of it is due to scale factors.
    """
    found = ratios(settings_of('motion_2', FOG, 600.0), [60.0, 300.0, 600.0])
    print('motion_2', found.round(2).tolist())
    level = np.delete(found, UP, axis=1)
    assert (level > 0.6).all() and (level < 1.6).all(), found.round(2)


def is_positive(p):
    """Return whether a symmetric matrix, scaled to correlations, is positive semidefinite."""
    size = np.sqrt(np.diag(p))
    return np.array_equal(p, p.T) and np.linalg.eigvalsh(p / np.outer(size, size))[0] > -1e-12


@pytest.mark.parametrize('motion, instrument', [('motion_2', MEMS), ('racetrack', FOG)])
def test_every_covariance_is_positive(motion, instrument):
    """
    The covariance of all 27 states is positive after each step.

    The up rows are held if the height is that of the truth.
    """
    steps = steps_of(settings_of(motion, instrument, 60.0))
    assert len(steps) > 100
    for _, p, mean, _ in steps:
        assert p.shape == (SIZE, SIZE) and is_positive(p)
        for k in (2, 5):
            assert np.count_nonzero(p[k]) == 1 and mean[k] == 0.0
    assert np.diag(steps[-1][1])[:2].min() > np.diag(steps[0][1])[:2].max()


def test_a_perfect_ins_is_not_believed_to_be_exact():
    """With perfect instruments no variance is zero, and none grows much."""
    steps = steps_of(settings_of('rest', 'default', 20.0))
    assert (np.diag(steps[0][1]) > 0.0).all()
    assert 1e-3 <= np.sqrt(steps[-1][1][0, 0]) < 2e-3


def test_readings_slower_than_the_steps_are_cut():
    """
    A reading every four seconds is divided into eight steps, which equal fine steps.

    The comparison is up to the middle of the interval.
    """
    slow, fast = (settings_of('rest', MEMS, 60.0, **{
        'rate_hz': rate, 'imu_sensor:rate_hz': rate, 'motion_generator:rate_hz': rate})
        for rate in (0.25, 100.0))
    one, other = (steps_of(s)[-1] for s in (slow, fast))
    assert one[0] == other[0] == 60_000_000_000
    # The white part of flicker noise is the same; pulses and the middle of steps differ.
    assert np.sqrt(np.diag(one[1])[:9]) == pytest.approx(np.sqrt(np.diag(other[1])[:9]), rel=1e-3)


def test_what_is_published_belongs_to_the_step_before():
    """
    Published pose, velocity, rate and position at the start have the initial sigmas.

    They are in the axes of map.
    """
    settings = settings_of('racetrack', FOG, 1.0, **SIGMAS)
    motion = read_motion(settings.motion_generator)
    free = published_covariance(settings.strapdown)
    imu = next(iter(imu_blocks(settings, motion)))
    truth = motion.at(imu.t_ns)
    navigator = InertialNavigator(settings.strapdown, free)
    for k in range(10):
        navigator.step(int(imu.t_ns[k]), tuple(imu.omega[k].tolist()), tuple(imu.f[k].tolist()),
                       truth.one(k))
    known = free.shown
    assert known.t_ns == imu.t_ns[0]
    pose = np.reshape(known.pose, (6, 6))
    assert pose[0, 0] == pytest.approx(1.0) and pose[2, 2] == pytest.approx(1e-6, rel=1e-3)
    assert np.sqrt(np.diag(pose)[3:]) == pytest.approx([3e-4, 3e-4, 1.5e-3], rel=1e-3)
    speed = float(np.hypot(*truth.v_n[0, :2]))
    velocity = np.reshape(known.velocity, (3, 3))
    # Across the track the azimuth error also rotates the velocity.
    assert np.trace(velocity) == pytest.approx(
        2 * 0.05 ** 2 + (speed * 1.5e-3) ** 2 + (speed * 3e-4) ** 2, rel=1e-3)
    assert all(is_positive(np.reshape(m, (n, n))) for m, n in (
        (known.pose, 6), (known.velocity, 3), (known.rate, 3), (known.place, 3)))


@pytest.mark.parametrize('name', ['default', FOG, MEMS, 'imu_navigation_rlg', 'imu_tactical_dtg',
                                  'grade_tactical', 'grade_mid', 'grade_navigation'])
def test_the_files_describe_one_imu_to_both_nodes(name):
    """imu/data_raw states the noise that the strapdown expects; another IMU is reported."""
    settings = parameter_files.read([resources.parameter_file(name)])
    stated = reported_variances(settings.imu_sensor)
    assert disagreement(settings.strapdown, stated) == ''
    assert disagreement(settings.strapdown, (stated[0], (1.0, 1.0, 1.0))).startswith(
        'imu/data_raw states a noise of 1 m/s^2 per sample on axis x, and accelerometer.errors of '
        'strapdown have ')


def test_figures_that_do_not_fit_are_refused():
    """Invalid values are refused as by the sensor, with a message that names the key."""
    settings = settings_of('rest', FOG, 1.0, **{'gyro.errors.saturation_deg_s': [1e-4] * 3})
    with pytest.raises(ValueError, match='gyro.errors.saturation_deg_s is 0.0001 on axis x'):
        free_covariance(settings.strapdown)
