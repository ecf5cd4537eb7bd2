"""The IMU on streamed truth, compared with the closed form (docs/theory/streamed_truth.md)."""

import numpy as np
import pytest
from support.studies import DEG_PER_HOUR, MOTION_2, run_offline, settings

from ins_sim.core.attitude import quaternion
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.core.simulation.inertial import imu_blocks, navigate_blocks

LATE = {'gyro.delay_us.x': 1.0, 'gyro.delay_us.y': 0.5, 'gyro.delay_us.z': 0.0}
MIXED = {**LATE, 'gyro.delay_us.z': -1.0}
BOUND = {1.0: 1e-7, 10.0: 2e-6, 30.0: 5e-5}  # Section 8: 1 us, at 100 Hz.


def mix(frequency):
    """Return a coning motion of 3 deg: two angles of the same frequency, out of phase."""
    return {'motion.kind': 'sinusoids', 'motion.theta_deg': 5.0,
            'motion.sinusoids.angle_deg': [2.0, 3.0, 3.0],
            'motion.sinusoids.angle_hz': [frequency] * 3,
            'motion.sinusoids.angle_phase_deg': [0.0, 30.0, 120.0],
            'motion.sinusoids.position_m': [0.0, 0.0, 0.0]}


def readings(values, **more):
    """Return the ImuSamples of a run."""
    s = settings(values, **more)
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    return ImuSamples.concatenate(imu_blocks(s, motion))


@pytest.mark.parametrize('rate', [100.0, 1000.0])
@pytest.mark.parametrize('frequency', [1.0, 10.0, 30.0])
def test_delay_signal_of_the_stream(frequency, rate, figures):
    """
    The delay signal of the stream agrees with the closed form, relative to its largest value.

    Bounds: 1e-7 at 1 Hz, 2e-6 at 10 Hz, 5e-5 at 30 Hz, plus the rounding of one increment (2e-16
    rad) divided by the delay signal.
    """
    def signal(source):
        common = {**mix(frequency), 'source': source, 'rate_hz': rate, 'duration_s': 4.0}
        return (readings({**common, **LATE}).omega[5:390] - readings(common).omega[5:390])

    closed, streamed = signal('motion'), signal('stream')
    largest = np.abs(closed).max()
    error = np.abs(streamed - closed).max() / largest
    rounding = 8 * 2.2e-16 * rate / largest
    figures.record(f'stream.delay_signal.{frequency:g}.{rate:g}', error, '', BOUND[frequency],
                   'bound at 100 Hz')
    print(f'\n{frequency:g} Hz motion, {rate:g} Hz: error {error:.1e} (bound '
          f'{BOUND[frequency]:.0e} + rounding {rounding:.0e})')
    assert error <= BOUND[frequency] + rounding


def drift_of(source, late, frequency, rate):
    """Return the drift over 20 s of the coning motion, rad/s, after the history of the stream."""
    s = settings({**mix(frequency), **late, 'source': source, 'rate_hz': rate,
                  'duration_s': 20.0, 'initial.after_s': 0.1})
    return run_offline(s, twin=False).errors.drift[-1]


@pytest.mark.parametrize('rate', [100.0, 1000.0])
@pytest.mark.parametrize('frequency', [1.0, 10.0, 30.0])
def test_drift_of_the_stream(frequency, rate):
    """
    The mean drift through the stream equals that through the closed form.

    The drift is a mean of the delay signal. Its error is at most sqrt(3) times the bound on the
    signal (section 8) times the largest signal, plus the rounding of the slope.
    """
    closed, streamed = (drift_of(source, LATE, frequency, rate)
                        - drift_of(source, {}, frequency, rate) for source in ('motion', 'stream'))
    common = {**mix(frequency), 'rate_hz': rate, 'duration_s': 2.0}
    signal = np.abs(readings({**common, **LATE}).omega - readings(common).omega).max()
    error = np.linalg.norm(streamed - closed)
    print(f'\n{frequency:g} Hz motion, {rate:g} Hz: drift {closed * DEG_PER_HOUR} deg/h, stream '
          f'off by {error / np.linalg.norm(closed):.1e} of it')
    assert error <= 3 ** 0.5 * BOUND[frequency] * signal + 1e-14


def test_slerp_would_be_seen():
    """With slerp in place of Hermite curves the delay signal at 10 Hz would be far off."""
    values = {**mix(10.0), 'rate_hz': 100.0}
    s = settings(values)
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    frame = MapFrame(generator.datum, True)
    t = period_ns(100.0) * np.arange(100)
    q = frame.attitude(motion.at(t)).tolist()
    late = frame.attitude(motion.at(t - 1000)).tolist()
    errors = []
    for k in range(1, 100):
        turn = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(q[k - 1]), q[k]))
        slerp = quaternion.multiply(q[k], quaternion.exponential([-x * 1e-4 for x in turn]))
        off = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(late[k]), slerp))
        true = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(q[k]), late[k]))
        errors.append(np.linalg.norm(off) / np.linalg.norm(true))
    assert max(errors) > 1e-2


@pytest.mark.parametrize('values', [
    {**MOTION_2, **MIXED}, {**MOTION_2, **MIXED, 'output': 'integrated'},
    {**MOTION_2, **MIXED, 'accelerometer.delay_us.y': 40000.0, 'history': 'frozen'}])
def test_any_cutting_gives_the_same_bits(values):
    """Blocks of one sample, one block and random blocks give the same bits."""
    s = settings(values)
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    whole = MotionImu(s.imu_sensor, motion, 0).advance(500)
    rng = np.random.default_rng(3)
    for cuts in ([1] * 500, np.diff(np.sort(np.r_[0, 500, rng.integers(0, 500, 20)]))):
        imu = MotionImu(s.imu_sensor, motion, 0)
        parts = ImuSamples.concatenate(imu.advance(int(n)) for n in cuts if n)
        for name in ('t_ns', 'omega', 'f'):
            assert np.array_equal(getattr(parts, name), getattr(whole, name)), name
    outputs = []
    for blocks in ([whole], [whole[k:k + 1] for k in range(500)]):
        outputs.append([np.concatenate([getattr(e, n) for _, _, e in navigate_blocks(
            s.strapdown, motion, blocks)]) for n in ('attitude', 'position', 'drift')])
    for one, other in zip(*outputs):
        assert np.array_equal(one, other)


def push_all(imu, motion, frame, t_ns):
    """Return the readings of an IMU that receives the truth at the instants t_ns."""
    truth, out = motion.at(t_ns), []
    for sample in zip(t_ns.tolist(), frame.attitude(truth).tolist(),
                      truth.omega_ib_b.tolist(), truth.f_ib_b.tolist()):
        out += imu.push(*sample)
    return out


@pytest.mark.parametrize('truth_rate, delay_us', [(1000.0, 2500.0), (50.0, 0.0), (100.0, -30000.0),
                                                  (200.0, 123456.0)])
def test_stream_at_another_rate_with_any_delay(truth_rate, delay_us):
    """Truth at another rate than the IMU, with any delays, matches the closed form."""
    values = {**MOTION_2, 'gyro.delay_us.x': delay_us, 'accelerometer.delay_us.z': delay_us}
    s = settings(values, source='stream')
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    frame = MapFrame(generator.datum, True)
    t = period_ns(truth_rate) * np.arange(int(truth_rate * 2))
    streamed = push_all(make_imu(s.imu_sensor), motion, frame, t)
    closed = MotionImu(s.imu_sensor, motion, 0).advance(len(streamed))
    assert [r[0] for r in streamed] == closed.t_ns.tolist()
    skip = 5 + int(max(0.0, delay_us) / 1e4)
    omega, f = (np.array([r[k] for r in streamed])[skip:] for k in (1, 2))
    # Truncation error of the cubics at w h <= 0.02: (w h)^4 / 384 and 19 (w h)^4 / 720.
    np.testing.assert_allclose(omega, closed.omega[skip:], atol=1e-7)
    np.testing.assert_allclose(f, closed.f[skip:], atol=1e-6)
    late = t[-1] - max(0, round(-delay_us * 1e3)) - streamed[-1][0]
    assert 0 <= late < period_ns(100.0)


def streamed_drift(late, jitter, spoil):
    """Return the drift over 60 s of motion 2, rad/s, through a stream with defects."""
    s = settings({**MOTION_2, 'gyro.delay_us.y': late, 'initial.after_s': 0.1}, source='stream')
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    t = period_ns(100.0) * np.arange(6001) + jitter
    truth, imu, out = motion.at(t), make_imu(s.imu_sensor), []
    q = spoil(MapFrame(generator.datum, True).attitude(truth))
    for sample in zip(t.tolist(), q.tolist(), truth.omega_ib_b.tolist(), truth.f_ib_b.tolist()):
        out += imu.push(*sample)
    block = ImuSamples(*(np.array([r[k] for r in out]) for k in range(3)))
    (*_, errors), = navigate_blocks(s.strapdown, motion, [block])
    return errors.drift[-1]


def single(q):
    """Return quaternions rounded to single precision."""
    return q.astype(np.float32).astype(float)


def test_float32_attitudes_and_jitter_change_the_drift_by_little():
    """Jitter of 1 us or float32 quaternions change the mean drift by below 1e-7 (section 8)."""
    def same(q):
        return q

    steady = np.zeros(6001, dtype=np.int64)
    jitter = np.random.default_rng(0).integers(-1000, 1001, 6001)
    jitter[0] = 0
    exact = streamed_drift(1.0, steady, same) - streamed_drift(0.0, steady, same)
    for name, shift, spoil in (('1 us of jitter', jitter, same), ('float32', steady, single)):
        drift = streamed_drift(1.0, shift, spoil) - streamed_drift(0.0, shift, spoil)
        change = np.linalg.norm(drift - exact) / np.linalg.norm(exact)
        print(f'\n{name} changes the drift by {change:.1e} of it')
        assert change < 1e-7
