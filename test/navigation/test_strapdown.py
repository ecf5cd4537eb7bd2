"""The strapdown: order of convergence, both inputs, vertical channels, initial errors."""

import numpy as np
import pytest
from support.studies import MOTION_1, MOTION_2, run_offline, settings, study

from ins_sim.core.attitude import quaternion
from ins_sim.core.navigation import increments

WOBBLE = {'motion.kind': 'sinusoids', 'motion.sinusoids.angle_deg': [20.0, 15.0, 25.0],
          'motion.sinusoids.position_m': [2.0, 3.0, 1.0],
          'motion.sinusoids.angle_hz': [0.9, 1.0, 1.0],
          'motion.sinusoids.position_hz': [1.0, 0.9, 0.5]}


def final(values, rate, **more):
    """Return the largest horizontal position error (m) and attitude error (rad) in 20 s."""
    s = settings(values, rate_hz=rate, duration_s=20.0, **more)
    errors = run_offline(s, twin=False).errors
    return np.abs(errors.position[:, :2]).max(), np.abs(errors.attitude).max()


def order(errors, rates):
    """Return the slope of log error against log step."""
    return -np.polyfit(np.log(rates), np.log(errors), 1)[0]


def test_rotation_vector_input_converges_with_order_two():
    """With input instant the attitude is exact, and position and velocity are of second order."""
    rates = [25.0, 50.0, 100.0, 200.0]
    found = [final(WOBBLE, r) for r in rates]
    slope = order([p for p, _ in found], rates)
    print(f'\nposition errors {[f"{p:.1e}" for p, _ in found]} m at {rates} Hz, order {slope:.2f}')
    assert slope > 1.9
    assert max(a for _, a in found) < 1e-12


def test_integrated_input_converges_with_order_four():
    """With input integrated (two-sample coning) the drift of a cone is of fourth order."""
    cone = {'motion.kind': 'coning', 'motion.coning.half_angle_deg': 5.0,
            'motion.coning.frequency_hz': 2.0, 'output': 'integrated', 'input': 'integrated'}
    rates = [50.0, 100.0, 200.0]
    slope = order([final(cone, r)[1] for r in rates], rates)
    raw = final({**cone, 'input': 'rotation_vector'}, 100.0)[1]
    compensated = final(cone, 100.0)[1]
    print(f'\nconing: order {slope:.2f}; attitude error in 20 s {compensated:.1e} rad, without '
          f'compensation {raw:.1e} rad')
    assert slope > 3.8
    assert compensated < 1e-2 * raw


def test_sculling_is_compensated():
    """A sculling motion rectifies f x theta / 2; with input integrated 1e-3 of it remains."""
    scull = {'motion.kind': 'sculling', 'motion.sculling.amplitude_deg': 2.0,
             'motion.sculling.acceleration_m_s2': 10.0, 'motion.sculling.frequency_hz': 2.0,
             'output': 'integrated'}
    right = final({**scull, 'input': 'integrated'}, 100.0)[0]
    wrong = final({**scull, 'input': 'rotation_vector'}, 100.0)[0]
    print(f'\nsculling, 20 s: {right:.2e} m compensated, {wrong:.2e} m not')
    assert right < 1e-2 * wrong


def test_exact_increments_at_large_angles():
    """At constant rate and force the velocity rotation is exact for angles below pi."""
    rng = np.random.default_rng(1)
    for _ in range(100):
        w, f = rng.normal(size=3), rng.normal(size=3)
        nodes, weights = np.polynomial.legendre.leggauss(20)
        exact = sum(0.5 * c * np.array(quaternion.rotate(
            quaternion.exponential(tuple(0.5 * (x + 1) * w)), tuple(f)))
            for x, c in zip(nodes, weights))
        # If the last two samples are equal there is no coning and no sculling between them.
        zero = (0.0, 0.0, 0.0)
        phi, u = increments.two_sample_increments(tuple(w), tuple(f), zero, zero)
        np.testing.assert_allclose(phi, w)
        np.testing.assert_allclose(u, exact, rtol=1e-12, atol=1e-13)


def test_free_vertical_channel_diverges_and_damped_does_not():
    """Free, the vertical error grows as exp(t sqrt(2 g / R)) (570 s); damped, it stays bounded."""
    start = {'motion.kind': 'static', 'rate_hz': 20.0,
             'initial.position_error_m': [0.0, 0.0, 10.0]}
    free = run_offline(settings(start, duration_s=1200.0, vertical__channel='free'), False).errors
    growth = free.position[-1, 2] / 10.0
    expected = np.cosh(1200.0 * np.sqrt(2 * 9.8156 / 6.3782e6))
    damped = run_offline(settings(start, duration_s=1200.0, vertical__channel='damped'),
                         False).errors
    print(f'\nfree: 10 m grow {growth:.3f} times in 20 min (cosh: {expected:.3f}); damped: '
          f'{damped.position[-1, 2]:.1e} m left')
    assert growth == pytest.approx(expected, rel=5e-3)
    assert abs(damped.position[-1, 2]) < 1e-3
    held = run_offline(settings(start, duration_s=10.0), False).errors
    assert np.abs(held.position[:, 2]).max() == 0.0


def test_initial_errors_are_what_was_asked():
    """The first output has the attitude, velocity and position errors of the settings."""
    s = settings({**MOTION_2, 'initial.attitude_error_deg': [0.1, -0.2, 1.0],
                  'initial.velocity_error_m_s': [0.3, -0.4, 0.0],
                  'initial.position_error_m': [20.0, -30.0, 0.0], 'gyro.delay_us.y': 0.0},
                 duration_s=0.1)
    errors = run_offline(s).errors
    np.testing.assert_allclose(np.degrees(errors.attitude[0]), [0.1, -0.2, 1.0], atol=1e-12)
    np.testing.assert_allclose(errors.velocity[0], [0.3, -0.4, 0.0], atol=1e-12)
    np.testing.assert_allclose(errors.position[0], [20.0, -30.0, 0.0], atol=1e-8)


NO_DELAY = {'gyro.delay_us.x': 0.0, 'gyro.delay_us.y': 0.0}
AT_ONE_MS = {'rate_hz': 1000.0, 'output_every': 10}
PUNCTUAL = {'motion 1': {**MOTION_1, **NO_DELAY}, 'motion 2': {**MOTION_2, **NO_DELAY}}


@pytest.mark.slow
def test_an_hour_of_motion_1_at_one_millisecond(figures):
    """Motion 1 at 1 ms with a delay of 1 us ends 112.05 m north and 15.04 m east, as published."""
    errors, _ = study({**MOTION_1, **AT_ONE_MS}, twin=False)
    east, north, _ = np.abs(errors.position).max(axis=0)
    print(f'\nmotion 1 late at 1 ms: |dN| {north:.4g}, |dE| {east:.4g} m')
    figures.record('strapdown.motion_1_at_1_ms', (north, east), 'm', (112.05, 15.04), 'published')
    assert (north, east) == (pytest.approx(112.05, abs=5e-3), pytest.approx(15.04, abs=5e-3))


@pytest.mark.slow
@pytest.mark.parametrize('name', PUNCTUAL)
@pytest.mark.parametrize('minutes', [10, pytest.param(60, marks=pytest.mark.figures)])
def test_the_floor_at_one_millisecond(name, minutes, figures):
    """Without delays the error at 1 ms is below 5e-4 m in an hour, and smaller in ten minutes."""
    errors, _ = study({**PUNCTUAL[name], **AT_ONE_MS, 'duration_s': 60.0 * minutes}, twin=False)
    floor = np.abs(errors.position).max()
    print(f'\n{name} at 1 ms, {minutes} min: {floor:.2g} m')
    if minutes == 60:
        figures.record(f'strapdown.floor_at_1_ms.{name.replace(" ", "_")}', floor, 'm', 5e-4,
                       'asked')
    assert floor <= 5e-4 * minutes / 60.0
