"""The IMU with errors: live and offline agree, and without errors it is the ideal one."""

from dataclasses import replace

import numpy as np
import pytest
from support.studies import MOTION_2, run_offline, settings

from ins_sim import parameter_files, resources
from ins_sim.core.sensors.imu.stream import make_imu, StreamImu
from ins_sim.core.sensors.imu.with_errors import reported_variances, with_errors
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.messages import topics

NOISY = {**MOTION_2, 'source': 'stream', 'seed': 5,
         'gyro.errors.angle_random_walk_deg_sqrt_h': [0.01, 0.02, 0.03],
         'gyro.errors.turn_on_bias_sigma_deg_h': [1.0] * 3,
         'accelerometer.errors.velocity_random_walk_m_s_sqrt_h': [0.03] * 3,
         'accelerometer.errors.quantisation_mm_s': [0.01] * 3}


def offline(values, **more):
    """Return the ImuSamples of ten seconds from an offline run."""
    s = settings(values, duration_s=10.0, **more)
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    return s, motion, ImuSamples.concatenate(imu_blocks(s, motion))


def test_zero_errors_are_the_ideal_instrument():
    """Without errors there is no wrapper and no covariance, and the seed changes no bit."""
    s, _, ideal = offline({**MOTION_2, 'source': 'stream'})
    assert with_errors(s.imu_sensor) is None
    assert isinstance(make_imu(s.imu_sensor), StreamImu)
    _, _, other = offline({**MOTION_2, 'source': 'stream', 'seed': 99})
    assert np.array_equal(ideal.omega, other.omega) and np.array_equal(ideal.f, other.f)


def test_live_is_offline_bit_for_bit_whatever_is_lost():
    """Sample by sample, from any start, a stage gives the bits of the offline run."""
    s, motion, expected = offline(NOISY)
    frame, t_ns = MapFrame(s.motion_generator.datum, True), expected.t_ns
    truth = motion.at(t_ns)
    samples = list(zip(t_ns.tolist(), frame.attitude(truth).tolist(), truth.omega_ib_b.tolist(),
                       truth.f_ib_b.tolist()))
    imu = make_imu(s.imu_sensor)
    assert imu.push(*samples[0]) == imu.push(*samples[0])
    got = [r for sample in samples[1:] for r in imu.push(*sample)]
    assert np.array_equal([r[1] for r in got], expected.omega[1:])
    assert np.array_equal([r[2] for r in got], expected.f[1:])
    gyros_only = replace(s.imu_sensor, accelerometer=type(s.imu_sensor.accelerometer)())
    late = make_imu(gyros_only)
    got = [r for sample in samples[500:] for r in late.push(*sample)][5:]
    np.testing.assert_allclose([r[1] for r in got], expected.omega[505:], rtol=0, atol=1e-12)


def test_noise_has_the_density_of_the_settings():
    """The variance of (reading - ideal reading) is that of the settings, within 4 sigma."""
    s, _, noisy = offline(NOISY)
    _, _, ideal = offline({**MOTION_2, 'source': 'stream'})
    variances = reported_variances(s.imu_sensor)
    for error, variance in zip((noisy.omega - ideal.omega, noisy.f - ideal.f), variances):
        ratio = error.var(axis=0) / variance
        print(f'\nvariance over reported variance {ratio}')
        assert np.abs(ratio - 1.0).max() < 4 * np.sqrt(2 / len(error))
    assert np.abs((noisy.omega - ideal.omega).mean(axis=0)).min() > 0


def test_covariances_reach_the_message():
    """The covariances in sensor_msgs/Imu are the variances; without errors they are unknown."""
    s, _, _ = offline(NOISY)
    variances = reported_variances(s.imu_sensor)
    topic = topics.imu_raw(*variances)
    _, doubles = topic.reader([(0, 37)]).read(topic.writer().pack(0, (0.0,) * 3, (0.0,) * 3))
    assert doubles[4] == -1.0
    assert [doubles[k] for k in (16, 20, 24)] == list(variances[0])
    assert [doubles[k] for k in (28, 32, 36)] == list(variances[1])
    assert [doubles[k] for k in (17, 18, 19, 21, 22, 23)] == [0.0] * 6


@pytest.mark.parametrize('name', ['imu_tactical_mems', 'imu_tactical_fog', 'imu_navigation_rlg'])
def test_presets_order_the_navigation_error(name):
    """In ten minutes at rest the error is smaller for a better IMU preset, as for its twin."""
    s = parameter_files.read([resources.config(name)], [
        'motion.kind:=static', 'duration_s:=600.0', 'rate_hz:=20.0', 'source:=motion'])
    run = run_offline(s)
    assert run.twin is None
    worst = np.abs(run.errors.position).max()
    print(f'\n{name}: {worst:.1f} m in ten minutes')
    low, high = {'imu_tactical_mems': (300.0, 1e5), 'imu_tactical_fog': (30.0, 5000.0),
                 'imu_navigation_rlg': (0.5, 300.0)}[name]
    assert low < worst < high
