"""Three processes over DDS: the numbers of the offline run, whatever the machine does."""

import subprocess
import sys

from ins_sim.core.map_frame import MapFrame
from ins_sim.core.simulation import simulate
from ins_sim.messages import topics
from ins_sim.messages.convert import error_blocks, state_blocks
from live import Chain, Listener
import numpy as np
import pytest
import studies

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

VALUES = {'gyro.delay_us.y': 1.0, 'rate_hz': 100.0, 'duration_s': 30.0}
LOCK_STEP = {'pacing.real_time_factor': 0.0, 'pacing.required': '[strapdown, listener]'}
HEARD = (topics.IMU_RAW, topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)
FORWARD = ('motion_generator', 'imu_sensor', 'strapdown')


def lock_step(domain, folder, order=FORWARD, values=VALUES, load=0):
    """Run the chain in lock-step and return {topic name: {stamp: doubles}}."""
    listener, chain = Listener(domain, HEARD), Chain(domain, folder)
    hogs = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(load)]
    try:
        started = {node: chain.start(node, {**values, **LOCK_STEP}) for node in order}
        generator = started['motion_generator']
        listener.poll_until(lambda: generator.poll() is not None, 120.0)
        last_ns = max(listener.heard['imu/data_raw'])
        listener.poll_until(lambda: last_ns in listener.heard['ins/error/drift'])
        codes = chain.end()
        assert set(codes.values()) == {0}, [chain.text(p) for p in started.values()]
        for process in started.values():
            assert 'WARN' not in chain.text(process), chain.text(process)
    finally:
        for hog in hogs:
            hog.kill()
        chain.end()
        listener.close()
    return listener.heard


def test_lock_step_is_the_offline_run(ros_domain, tmp_path):
    """
    The solution and its errors agree to 1e-9 relative, beside the rounding of a position.

    Truth and solution pass through Cartesian messages: 1 ulp of the radius of the Earth is
    1e-9 m, and a position is a sum of a few such terms; an attitude rounds at 1e-15, and
    its first slope at that over one step.
    """
    heard = lock_step(ros_domain, tmp_path)
    settings = studies.settings({**VALUES, 'source': 'stream'})
    run = simulate(settings, twin=False)
    frame = MapFrame(settings.strapdown.datum, True)
    expected = {**state_blocks(frame, run.states, run.imu.omega), **error_blocks(run.errors)}
    rounding = {'ins/odometry': 8e-9, 'ins/error/position': 8e-9, 'ins/error/velocity': 1e-11,
                'ins/error/attitude': 1e-14, 'ins/error/drift': 1e-14 / 0.01, 'ins/fix': 8e-9}
    for topic, values in expected.items():
        got = heard[topic.name]
        assert sorted(got) == run.states.t_ns.tolist()
        got = np.array([got[t] for t in sorted(got)])
        difference, scale = np.abs(got - values).max(), np.abs(values).max()
        print(f'{topic.name}: {difference:.2e} of {scale:.2e}')
        assert difference <= 1e-9 * scale + rounding[topic.name]


def test_twice_the_same_bits_once_under_load_in_any_order(ros_domain, tmp_path):
    first = lock_step(ros_domain, tmp_path)
    (tmp_path / 'again').mkdir()
    again = lock_step(ros_domain, tmp_path / 'again', tuple(reversed(FORWARD)), load=3)
    assert first == again
