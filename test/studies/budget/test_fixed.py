"""Errors that are the same in every run: the budget compared with single simulations."""

import numpy as np
import pytest

import ins_sim

FIXED = {
    'gyro.errors.bias_deg_h': [1.0, -2.0, 0.5],
    'accelerometer.errors.bias_ug': [100.0, 50.0, -80.0],
    'gyro.errors.scale_factor_ppm': [100.0, -50.0, 80.0],
    'accelerometer.errors.scale_factor_ppm': [100.0, -50.0, 80.0],
    'gyro.errors.misalignment_mrad': [0.1, -0.2, 0.3],
    'accelerometer.errors.misalignment_mrad': [0.1, -0.2, 0.3],
    'gyro.errors.non_orthogonality_mrad': [0.1, 0.2, 0.3],
    'accelerometer.errors.non_orthogonality_mrad': [0.1, -0.2, 0.3],
    'gyro.errors.scale_asymmetry_ppm': [50.0, 20.0, -30.0],
    'accelerometer.errors.scale_asymmetry_ppm': [50.0, 20.0, -30.0],
    'gyro.errors.cubic_ppm_s2_deg2': 0.1,
    'accelerometer.errors.quadratic_ug_g2': [30.0, 20.0, 10.0],
    'accelerometer.errors.cubic_ug_g3': 5.0, 'gyro.errors.g_sensitivity_deg_h_g': [1.0, 2.0, 1.0],
    'gyro.errors.g2_sensitivity_deg_h_g2': [0.3, 0.1, 0.1],
    'gyro.errors.temperature_bias_deg_h_c': [0.1, 0.2, 0.1],
    'gyro.errors.temperature_scale_ppm_c': 3.0,
    'accelerometer.errors.temperature_bias_ug_c': [20.0, 10.0, 20.0],
    'accelerometer.errors.temperature_scale_ppm_c': 3.0,
    'gyro.errors.bandwidth_hz': [100.0, 150.0, 200.0],
    'accelerometer.errors.bandwidth_hz': [50.0, 60.0, 70.0],
    'gyro.delay_us': {'gyro.delay_us.x': 2.0, 'gyro.delay_us.y': 1.0, 'gyro.delay_us.z': 3.0},
    'accelerometer.delay_us': {'accelerometer.delay_us.x': 200.0,
                               'accelerometer.delay_us.y': 100.0},
    'initial.position_error_m': [10.0, -20.0, 0.0],
    'initial.velocity_error_m_s': [0.1, 0.05, 0.0],
    'initial.attitude_error_deg': [0.01, -0.02, 0.03]}
COMMON = {'temperature.ramp_c_h': 60.0, 'strapdown:output_every': 100,
          'accelerometer.errors.bandwidth_order': 2}


def values_of(key):
    """Return the settings of one fixed error."""
    value = FIXED[key]
    return value if isinstance(value, dict) else {key: value}


def budget_and_run(motion, values):
    """Return the LinearBudget and the errors (9,) of a simulation at its end."""
    settings = ins_sim.read_settings(motion, {**COMMON, **values})
    linear = ins_sim.budget(settings).linear
    assert not linear.random
    errors = ins_sim.simulate(settings, twin=False).errors
    return linear, np.concatenate([errors.position[-1], errors.velocity[-1], errors.attitude[-1]])


def check(linear, found, parts):
    """Compare position, velocity and attitude within given fractions of the simulated ones."""
    mean = linear.total_mean()[-1]
    for rows in (slice(0, 3), slice(3, 6), slice(6, 9)):
        size = np.linalg.norm(found[rows])
        # Floors: rounding and truncation of the strapdown.
        floor = {0: 1e-3, 3: 1e-5, 6: 1e-7}[rows.start]
        assert np.linalg.norm(mean[rows] - found[rows]) < parts * size + floor


@pytest.mark.slow
@pytest.mark.parametrize('key', FIXED)
def test_one_error_alone(key):
    """On 100 s of racetrack the budget of each single error agrees with a simulation to 4e-3."""
    linear, found = budget_and_run('racetrack', {'duration_s': 100.0, **values_of(key)})
    assert [source.key for source in linear.fixed] == [key]
    check(linear, found, 4e-3)


@pytest.mark.parametrize('motion', ['racetrack', 'motion_2'])
def test_all_errors_at_once(motion):
    """
    With all fixed errors one minute agrees to 2e-3, and to the rotation of the axes.

    The rotation of the axes is of second order.
    """
    values = {'duration_s': 60.0}
    for key in FIXED:
        values.update(values_of(key))
    linear, found = budget_and_run(motion, values)
    assert len(linear.fixed) == len(FIXED)
    check(linear, found, 2e-3 + np.linalg.norm(found[6:]))


@pytest.mark.parametrize('source', ['stream', 'motion'])
def test_the_start_of_lags(source):
    """If navigation starts 2 s later, or a motion feeds the IMU, the budget agrees as well."""
    for after_s in (0.0, 2.0):
        linear, found = budget_and_run('motion_2', {
            'duration_s': 20.0, 'initial.after_s': after_s, 'imu_sensor:source': source,
            **values_of('gyro.errors.bandwidth_hz')})
        check(linear, found, 4e-3)


@pytest.mark.parametrize('channel', ['free', 'damped'])
def test_the_vertical_channel(channel):
    """
    An upward velocity error of 0.1 m/s follows the gravity gradient if free.

    If the channel is damped, it vanishes.
    """
    linear, found = budget_and_run('racetrack', {
        'duration_s': 60.0, 'vertical.channel': channel, 'vertical.time_constant_s': 5.0,
        'initial.velocity_error_m_s': [0.0, 0.0, 0.1]})
    up = linear.total_mean()[-1, 2]
    if channel == 'free':
        assert up == pytest.approx(found[2], rel=1e-3) and up > 6.0
    else:
        assert abs(up) < 0.01 and abs(found[2]) < 0.01
