"""The prediction compared with simulation, and with a second way of computing it."""

import numpy as np
import pytest
from support.studies import DEG_PER_HOUR, FLIGHT, MOTION_1, MOTION_2, prediction_of, run_offline, \
    settings

from ins_sim.core.motion.factory import make_motion
from ins_sim.core.prediction.drift import channel_drift, delay_response, mean_drift

RANDOM = [5, 17, 42]


def harmonics(seed):
    """Return a random multi-harmonic motion of 10 s with random delays, and its highest rate."""
    rng = np.random.default_rng(seed)
    values = {'motion.kind': 'harmonics', 'motion.harmonics.period_s': 10.0,
              'motion.psi_deg': float(rng.uniform(-180, 180)),
              'motion.theta_deg': float(rng.uniform(-30, 30)),
              'motion.gamma_deg': float(rng.uniform(-30, 30))}
    for angle in ('psi', 'theta', 'gamma'):
        values[f'motion.harmonics.{angle}_deg'] = rng.uniform(-8, 8, 5).tolist()
        values[f'motion.harmonics.{angle}_phase_deg'] = rng.uniform(-180, 180, 5).tolist()
    for axis in 'xyz':
        values[f'gyro.delay_us.{axis}'] = float(rng.uniform(-3, 3))
    return values, 2 * np.pi * 5 / 10.0


def cases():
    """Return name, settings and rate w of each motion whose drift is measured."""
    yield 'motion 1', MOTION_1, 2 * np.pi
    yield 'motion 2', MOTION_2, 1.0
    for seed in RANDOM:
        yield f'random {seed}', *harmonics(seed)


CASES = list(cases())
NAMES = [c[0] for c in CASES]
DRIFTS = [pytest.param(*case, marks=pytest.mark.slow) if case[0] in ('random 17', 'random 42')
          else case for case in CASES]


@pytest.mark.parametrize('name, values, w', DRIFTS, ids=NAMES)
def test_measured_drift_is_the_predicted_one(name, values, w, figures):
    """
    The slope of the inertial attitude error equals the prediction within 1e-4 + (w dt)^2 / 4.
    """
    s = settings(values, duration_s=1000.0)
    measured = run_offline(s, twin=False).errors.drift[-1]
    predicted = prediction_of(s).drift
    error = np.linalg.norm(measured - predicted) / np.linalg.norm(predicted)
    bound = 1e-4 + (w * 0.01) ** 2 / 4
    figures.record(f'prediction.drift_off.{name.replace(" ", "_")}', error, '', bound, 'bound')
    print(f'\n{name}: predicted {predicted * DEG_PER_HOUR} deg/h, measured '
          f'{measured * DEG_PER_HOUR}, off by {error:.2e} (bound {bound:.2e})')
    assert error <= bound


@pytest.mark.parametrize('name, values, w', CASES, ids=NAMES)
def test_fourier_sum_equals_time_mean(name, values, w):
    """
    The Fourier sum and the time mean of the drift agree to first order in the delay.

    For delays of nanoseconds the second order, k w tau, is below 1e-7.
    """
    s = settings(values)
    generator, delay = s.motion_generator, s.imu_sensor.gyro.delay_us
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    tau = 1e-9 * np.array((delay.x, delay.y, delay.z))
    time = mean_drift(motion, lambda truth: truth.omega_ib_b * tau, True, 0.0, None)
    fourier = channel_drift(motion, [delay_response(x) for x in tau])
    assert np.linalg.norm(fourier - time) <= 1e-7 * np.linalg.norm(time)


@pytest.mark.parametrize('values', [
    pytest.param(MOTION_1, marks=pytest.mark.slow), MOTION_2, {**FLIGHT, 'motion.kind': 'cruise'}],
    ids=['motion 1', 'motion 2', 'cruise'])
def test_linear_model_predicts_the_position_error(values):
    """For 20 minutes the position error is predicted within 1 % of its largest value."""
    s = settings(values, duration_s=1200.0, output_every=10)
    result = run_offline(s)
    position = result.errors.position - result.twin.position
    predicted = prediction_of(s).position
    n = min(len(position), len(predicted))
    off = np.abs(position[:n] - predicted[:n]).max() / np.abs(position).max()
    print(f'\nlargest error {np.abs(position).max():.3f} m, predicted within {off:.2e} of it')
    assert off <= 0.01


def test_linear_model_predicts_initial_errors():
    """Errors due to an initial attitude, velocity or position error are predicted within 1 %."""
    s = settings({'motion.kind': 'static', 'rate_hz': 20.0,
                  'initial.attitude_error_deg': [0.001, -0.002, 0.01],
                  'initial.velocity_error_m_s': [0.05, -0.02, 0.0],
                  'initial.position_error_m': [30.0, -50.0, 0.0]}, duration_s=1200.0,
                 output_every=2)
    errors = run_offline(s).errors
    predicted = prediction_of(s)
    off = np.abs(errors.position - predicted.position[:len(errors)]).max()
    scale = np.abs(errors.position - errors.position[0]).max()
    print(f'\ninitial errors: {scale:.1f} m in 20 min, predicted within {off:.3f} m')
    assert off <= 0.01 * scale
    np.testing.assert_allclose(errors.attitude, predicted.attitude[:len(errors)],
                               atol=1e-3 * np.radians(0.01))


@pytest.mark.slow
def test_both_resonances_of_motion_2_by_simulation():
    """Motion 2 at theta = +30 deg: the second resonance, psi' = -2 gamma', is the stronger one."""
    drifts = {}
    for name, gamma_rate in (("psi' = 2 gamma'", 0.5), ("psi' = -2 gamma'", -0.5)):
        s = settings(MOTION_2, motion__theta_deg=30.0, duration_s=1000.0,
                     motion__two_axis__gamma_rate_rad_s=gamma_rate)
        found = prediction_of(s).resonances
        formula = {n: d for n, rate, d in found}
        assert {n for n, rate, d in found if rate == 1.0} == {name}
        measured = run_offline(s, twin=False).errors.drift[-1]
        drifts[name] = np.linalg.norm(measured)
        # The formula neglects the rotation of the Earth: Omega / gamma' at the larger resonance.
        bound = 7.3e-5 / 0.5 * max(map(np.linalg.norm, formula.values()))
        assert np.linalg.norm(measured - formula[name]) <= bound
        print(f'\n{name}: {measured * DEG_PER_HOUR} deg/h, formula '
              f'{formula[name] * DEG_PER_HOUR}')
    assert drifts["psi' = -2 gamma'"] == pytest.approx(3 * drifts["psi' = 2 gamma'"], rel=1e-3)
