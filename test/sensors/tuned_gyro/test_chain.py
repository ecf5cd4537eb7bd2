"""Two tuned gyros in a complete run: live and offline, predicted and measured, with delays."""

import numpy as np
import pytest
from support.studies import DEG_PER_HOUR, MOTION_2, prediction_of, run_offline, settings, streamed

from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.timeseries.histories import ImuSamples

DTG = {'motion.kind': 'two_axis', 'gyro.model': 'dtg', 'output': 'integrated',
       'input': 'integrated'}


@pytest.mark.parametrize('arrangement', ['paper', 'turned'])
def test_drift_is_the_predicted_one(arrangement, figures):
    """The drift is within 1 % of the sum over channels with the transfer function of the gyro."""
    s = settings({**DTG, 'gyro.dtg.arrangement': arrangement}, duration_s=600.0)
    prediction, errors = prediction_of(s), run_offline(s).errors
    measured = errors.drift[-1]
    off = np.linalg.norm(measured - prediction.drift) / np.linalg.norm(prediction.drift)
    position = np.abs(errors.position[::10] - prediction.position[:len(errors[::10])]).max()
    print(f'\n{arrangement}: predicted {prediction.drift * DEG_PER_HOUR} deg/h, measured '
          f'{measured * DEG_PER_HOUR}, off by {off:.1e}; position within {position:.2f} of '
          f'{np.abs(errors.position).max():.2f} m')
    figures.record(f'tuned_gyro.drift_off.{arrangement}', 100.0 * off, '%', 1.0, 'asked')
    assert off <= 0.01
    assert position <= 0.01 * np.abs(errors.position).max()


def test_delays_compose_with_the_rotors():
    """Delays cause the same drift with tuned gyros as with ideal gyros, within 1 %."""
    late = {'gyro.delay_us.y': 500.0}
    runs = [run_offline(settings({**DTG, **v}, duration_s=200.0), twin=False)
            for v in (late, {})]
    with_rotors = [run.errors.drift[-1] for run in runs]
    ideal = prediction_of(settings({**MOTION_2, **late}, duration_s=200.0)).drift
    added = with_rotors[0] - with_rotors[1]
    print(f'\nadded by 500 us: {added * DEG_PER_HOUR} deg/h, ideal gyro {ideal * DEG_PER_HOUR}')
    # At 1 rad/s the gain of the rotors is within 1e-3 of one.
    assert np.linalg.norm(added - ideal) <= 0.01 * np.linalg.norm(ideal)


def test_live_is_offline_bit_for_bit_and_reset_forgets():
    """Samples passed one by one give the bits of the offline run, and again after a reset."""
    s = settings({**DTG, 'gyro.delay_us.x': 30.0}, source='stream', duration_s=3.0)
    expected, samples = streamed(s)
    imu = make_imu(s.imu_sensor)
    for _ in range(2):
        got = [r for sample in samples for r in imu.push(*sample)]
        assert np.array_equal([r[1] for r in got], expected.omega)
        assert np.array_equal([r[2] for r in got], expected.f)
        imu.reset()


def test_closed_form_in_any_cutting():
    """Rotors carry their state from block to block: any cutting gives the same bits."""
    s = settings(DTG, duration_s=3.0)
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    from ins_sim.core.sensors.imu.ideal import MotionImu
    whole = MotionImu(s.imu_sensor, motion, 0).advance(300)
    imu = MotionImu(s.imu_sensor, motion, 0)
    parts = ImuSamples.concatenate(imu.advance(n) for n in (1, 99, 150, 50))
    assert np.array_equal(parts.omega, whole.omega)


def test_rotation_vectors_are_refused():
    """A tuned gyro refuses output rotation_vector, because it integrates its rate."""
    with pytest.raises(ValueError, match='expected integrated, because the readings of a tuned'):
        settings({**DTG, 'output': 'rotation_vector'})
