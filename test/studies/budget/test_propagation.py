"""Properties of the propagation: steps, limits of processes, and axes."""

import numpy as np
import pytest

import ins_sim
from ins_sim.core.prediction.budget import propagation
from ins_sim.core.prediction.budget.interval_responses import mean_variance
from ins_sim.core.simulation.free_covariance import free_covariance
from ins_sim.core.simulation.inertial import imu_blocks, navigate_blocks
from ins_sim.io.motion import read_motion

GYRO, FORCE = 'gyro.errors.', 'accelerometer.errors.'


def budget(values, motion='racetrack'):
    """Return the ErrorBudget of ten minutes."""
    return ins_sim.budget(ins_sim.read_settings(motion, {'duration_s': 600.0, **values}))


def test_random_parts_bear_longer_steps(monkeypatch):
    """With steps of 0.2 s sigmas agree to 1e-5 with those for steps of 0.05 s."""
    files = ['racetrack', 'imu_tactical_fog']
    fine = budget({}, files)
    monkeypatch.setattr(propagation, 'STEP_S', 0.2)
    coarse = budget({}, files)
    for k in (120, 360):
        one, other = (np.sqrt(np.diagonal(b.linear.total_covariance()[k]))[[0, 1, 3, 4, 6, 7, 8]]
                      for b in (fine, coarse))
        assert other == pytest.approx(one, rel=1e-5)


def test_an_endless_process_is_a_walk():
    """A Gauss-Markov process with infinite time constant is a random walk with sigma at 1 h."""
    times = [np.inf, 300.0, 300.0]
    walk = budget({GYRO + 'rate_random_walk_deg_h_sqrt_h': [0.5, 0.0, 0.0]})
    endless = budget({GYRO + 'gauss_markov_sigma_deg_h': [0.5, 0.0, 0.0],
                      GYRO + 'gauss_markov_time_s': times})
    assert endless.rms() == pytest.approx(walk.rms(), rel=1e-12)
    both = budget({GYRO + 'gauss_markov_sigma_deg_h': [0.5, 0.2, 0.0],
                   GYRO + 'gauss_markov_time_s': times})
    other = budget({GYRO + 'gauss_markov_sigma_deg_h': [0.0, 0.2, 0.0]})
    assert both.rms() ** 2 == pytest.approx(walk.rms() ** 2 + other.rms() ** 2, rel=1e-12)


def test_a_slow_process_is_a_bias_and_a_fast_one_is_white():
    """A time constant of 1e9 s gives a turn-on bias, one of 1 ms white noise with 2 sigma^2 T."""
    bias = budget({FORCE + 'turn_on_bias_sigma_ug': 100.0})
    slow = budget({FORCE + 'gauss_markov_sigma_ug': 100.0, FORCE + 'gauss_markov_time_s': 1e9})
    assert slow.rms() == pytest.approx(bias.rms(), rel=1e-6)
    density = 1000.0 * 9.80665e-6 * np.sqrt(2.0 * 1e-3)
    white = budget({FORCE + 'noise_density_m_s2_sqrt_hz': density})
    fast = budget({FORCE + 'gauss_markov_sigma_ug': 1000.0, FORCE + 'gauss_markov_time_s': 1e-3})
    # After the time t the variance of a process with correlation time T is smaller by the fraction
    # T/t.
    assert fast.rms()[60:] == pytest.approx(white.rms()[60:], rel=1e-4)


def test_a_walk_has_run_before_the_navigation():
    """A walk starts at motion time zero: at the start of navigation it is a bias of K sqrt(t)."""
    key = GYRO + 'rate_random_walk_deg_h_sqrt_h'
    same = {'motion.kind': 'static', 'duration_s': 300.0}
    late = budget({key: 0.5, **same, 'duration_s': 600.0, 'initial.after_s': 300.0}, []).rms()
    fresh = budget({key: 0.5, **same}, []).rms()
    biased = budget({GYRO + 'turn_on_bias_sigma_deg_h': 0.5 * np.sqrt(300.0 / 3600.0), **same},
                    []).rms()
    assert late == pytest.approx(np.hypot(fresh, biased), rel=1e-9)


def test_axes_add_up():
    """The variances of the axes of each source add up to its variance; one axis has its own."""
    values = {GYRO + 'turn_on_bias_sigma_deg_h': [1.0, 2.0, 3.0],
              GYRO + 'bias_instability_deg_h': [0.1, 0.0, 0.3],
              FORCE + 'velocity_random_walk_m_s_sqrt_h': [0.1, 0.2, 0.0]}
    linear = budget(values).linear
    whole = np.diagonal(linear.covariance, axis1=2, axis2=3)
    assert linear.by_axis.sum(axis=2) == pytest.approx(whole, rel=1e-12, abs=1e-30)
    for k, source in enumerate(linear.random):
        alone = [0.0, 0.0, 0.0]
        alone[0] = source.values[0]
        other = budget({source.key: alone}).linear
        assert linear.by_axis[k, :, 0] == pytest.approx(other.by_axis[0, :, 0], rel=1e-12)


@pytest.mark.parametrize('motion', ['racetrack', 'motion_2'])
def test_against_the_covariance_of_the_strapdown(motion):
    """
    The budget agrees with the covariance of the navigator to 0.6^2/24/2.

    The steps of the navigator rotate by up to 0.6 rad.
    """
    settings = ins_sim.read_settings(motion, {
        'duration_s': 100.0, 'strapdown:output_every': 100,
        **{GYRO + key: value for key, value in (
            ('turn_on_bias_sigma_deg_h', 1.0), ('angle_random_walk_deg_sqrt_h', 0.1),
            ('scale_factor_sigma_ppm', 100.0), ('misalignment_sigma_mrad', 0.1),
            ('rate_random_walk_deg_h_sqrt_h', 10.0))},
        FORCE + 'turn_on_bias_sigma_ug': 300.0, FORCE + 'velocity_random_walk_m_s_sqrt_h': 0.1,
        FORCE + 'scale_factor_sigma_ppm': 300.0, FORCE + 'misalignment_sigma_mrad': 0.1,
        'initial.position_sigma_m': 1.0, 'initial.velocity_sigma_m_s': 0.05,
        'initial.tilt_sigma_mrad': 0.3, 'initial.azimuth_sigma_mrad': 1.5})
    free = free_covariance(settings.strapdown)
    flown = read_motion(settings.motion_generator)
    # With a perfect IMU the covariance is propagated along the truth.
    perfect = ins_sim.read_settings(motion, {'duration_s': 100.0})
    for _ in navigate_blocks(settings.strapdown, flown, imu_blocks(perfect, flown),
                             covariance=free):
        pass
    found = np.sqrt(np.diagonal(ins_sim.budget(settings).linear.total_covariance()[-1]))
    level = [0, 1, 3, 4]
    assert found[level] == pytest.approx(np.sqrt(free.p.diagonal()[level]), rel=7e-3)


def test_the_variance_of_a_mean():
    """The variance of a mean is 2 (x - 1 + exp(-x))/x^2, also where these terms cancel."""
    x = np.array([1e-12, 1e-6, 0.01, 0.0999999, 0.1000001, 1.0, 30.0, 1e4])
    expected = [1.0, 1.0 - 1e-6 / 3.0]
    expected += [float(2.0 * (v - 1.0 + np.exp(-v)) / v ** 2) for v in x[2:]]
    assert mean_variance(x) == pytest.approx(expected, rel=5e-9)
