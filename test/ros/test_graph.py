"""Three processes over DDS give the numbers of the offline run, also on a busy machine."""

import subprocess
import sys

from ins_sim.core.earth.frames import MapFrame
from ins_sim.io.motion import read_motion
from ins_sim.io.simulated_topics.covariance import CovarianceSource
from ins_sim.settings.presets import preset
from ins_sim.messages import topics
from ins_sim.messages.convert import error_blocks, state_blocks
from support.live import Chain, Listener, warnings_of_loss
import numpy as np
import pytest
from support import studies
from support.studies import run_offline

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

VALUES = {'motion.kind': 'two_axis', 'gyro.delay_us.y': 1.0, 'rate_hz': 100.0, 'duration_s': 30.0,
          'imu_data': True}
LOCK_STEP = {'pacing.real_time_factor': 0.0, 'pacing.required': '[strapdown, listener]'}
HEARD = (topics.IMU_RAW, topics.IMU_DATA, topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)
FORWARD = ('motion_generator', 'imu_sensor', 'strapdown')


def lock_step(domain, folder, order=FORWARD, values=VALUES, load=0, more=(), warns=False):
    """
    Run the chain in lock-step; return {topic name: {stamp: doubles}}.

    more: further topics to receive; warns: whether the nodes must warn, or must not.
    """
    listener, chain = Listener(domain, (*HEARD, *more)), Chain(domain, folder)
    hogs = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(load)]
    try:
        started = {node: chain.start(node, {**values, **LOCK_STEP}) for node in order}
        generator = started['motion_generator']
        listener.poll_until(lambda: generator.poll() is not None, 120.0)
        end_ns = round(values['duration_s'] * 1e9) - round(1e9 / values['rate_hz'])
        listener.poll_until(lambda: all(
            max(stamps, default=0) >= end_ns for stamps in listener.heard.values()))
        codes = chain.end()
        assert set(codes.values()) == {0}, [chain.text(p) for p in started.values()]
        texts = [chain.text(process) for process in started.values()]
        assert bool(warnings_of_loss(texts)) == warns, texts
    finally:
        for hog in hogs:
            hog.kill()
        chain.end()
        listener.close()
    return listener.heard


def test_lock_step_is_the_offline_run(ros_domain, tmp_path):
    """
    Solution and errors agree with the offline run to 1e-9, and the rounding of positions.

    Truth and solution pass through Cartesian messages: 1 ulp of the radius of the Earth is 1e-9 m,
    and a position is a sum of a few such terms; an attitude rounds at 1e-15, and its first slope
    at that over one step.
    """
    same_as_offline(VALUES, lock_step(ros_domain, tmp_path))


def same_as_offline(values, heard):
    """Compare received messages with the offline run of the values; return the Run."""
    settings = studies.settings({**values, 'source': 'stream'})
    run = run_offline(settings, twin=False)
    frame = MapFrame(settings.strapdown.datum, True)
    expected = {**state_blocks(frame, run.states, run.imu, CovarianceSource(
        settings, run, read_motion(settings.motion_generator)).at(run.states.t_ns)),
        **error_blocks(run.errors)}
    rounding = {'ins/odometry': 8e-9, 'ins/error/position': 8e-9, 'ins/error/velocity': 1e-11,
                'ins/error/attitude': 1e-14, 'ins/error/drift': 1e-14 / 0.01, 'ins/fix': 8e-9,
                'imu/data': 0.0}
    for topic, values in expected.items():
        got = heard[topic.name]
        assert sorted(got) == run.states.t_ns.tolist()
        got = np.array([got[t] for t in sorted(got)])
        difference, scale = np.abs(got - values).max(), np.abs(values).max()
        print(f'{topic.name}: {difference:.2e} of {scale:.2e}')
        assert difference <= 1e-9 * scale + rounding[topic.name]
    return run


TACTICAL = {key: list(value) if isinstance(value, tuple) else value
            for key, value in preset('tactical_dtg').items()}
DTG = {**VALUES, **TACTICAL, 'gyro.model': 'dtg', 'output': 'integrated', 'input': 'integrated',
       'gyro.dtg.arrangement': 'turned', 'seed': 3,
       'gyro.dtg.errors.pickoff_noise_urad_sqrt_s': [0.02] * 4,
       'gyro.dtg.errors.hunting_ppm': [5.0, 5.0], 'gyro.dtg.errors.spin_rate_product': 1.0,
       'sampling.latency_us': 2500.0, 'sampling.jitter_us': 400.0, 'imu_time': 'nominal',
       'imu_latency_us': 2500.0, 'orientation': 'euler_vector'}


def test_tuned_gyros_with_all_their_errors(ros_domain, tmp_path):
    """
    Tuned gyros with late, jittering stamps have the readings and parity of the offline run.

    They agree to the bit.
    """
    heard = lock_step(ros_domain, tmp_path, values=DTG, more=(topics.IMU_PARITY,))
    run = same_as_offline(DTG, heard)
    imu, parity = heard['imu/data_raw'], heard['imu/parity']
    assert sorted(imu) == sorted(parity) == run.imu.t_ns.tolist()
    assert np.array_equal([imu[t] for t in sorted(imu)],
                          np.concatenate([run.imu.omega, run.imu.f], axis=1))
    assert np.array_equal([parity[t][0] for t in sorted(parity)], run.imu.parity)


def test_drop_outs(ros_domain, tmp_path):
    """Lost samples are gaps: the strapdown warns and starts anew, as offline."""
    values = {**VALUES, 'sampling.drop_out_probability': 0.01, 'seed': 2}
    heard = lock_step(ros_domain, tmp_path, values=values, warns=True)
    run = same_as_offline(values, heard)
    print(f'{len(run.faults)} gaps, {3001 - len(run.imu)} samples lost')
    assert sorted(heard['imu/data_raw']) == run.imu.t_ns.tolist()
    assert len(run.faults) > 10


def test_twice_the_same_bits_once_under_load_in_any_order(ros_domain, tmp_path):
    """A second run, under load and with another order of start, gives the same bits."""
    first = lock_step(ros_domain, tmp_path)
    (tmp_path / 'again').mkdir()
    again = lock_step(ros_domain, tmp_path / 'again', tuple(reversed(FORWARD)), load=3)
    assert first == again
