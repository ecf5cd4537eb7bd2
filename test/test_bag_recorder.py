"""The recorder writes every message once, byte for byte, and a bag is whole or not there."""

from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader
from live import Chain
import pytest

rclpy = pytest.importorskip('rclpy')
rosbag2 = pytest.importorskip('rosbags.rosbag2')
pytestmark = pytest.mark.live


@pytest.mark.parametrize('storage', ['sqlite3', 'mcap'])
def test_a_lock_step_run_is_recorded_whole(storage, ros_domain, tmp_path):
    from ins_sim.ros.bag_recorder import BagRecorder
    from rclpy.executors import SingleThreadedExecutor
    context = rclpy.Context()
    context.init(domain_id=ros_domain)
    path = tmp_path / 'bag'
    recorder = BagRecorder(path, storage=storage, context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(recorder)
    chain = Chain(ros_domain, tmp_path)
    parameters = {'rate_hz': 100.0, 'duration_s': 5.0, 'pacing.real_time_factor': 0.0,
                  'pacing.required': '[strapdown, recorder]'}
    try:
        for node in ('motion_generator', 'imu_sensor', 'strapdown'):
            chain.start(node, parameters)
        generator = chain.processes['motion_generator_0']
        while generator.poll() is None:
            executor.spin_once(timeout_sec=0.1)
        for _ in range(50):
            executor.spin_once(timeout_sec=0.02)
        assert generator.returncode == 0, chain.text(generator)
        assert not path.exists()
    finally:
        recorder.close()
        recorder.destroy_node()
        context.shutdown()
        chain.end()
    expected = {topic.name: 501 for topic in topics.DATA}
    assert recorder.counts == expected
    with rosbag2.Reader(path) as bag:
        got = {}
        for connection, t_ns, data in bag.messages():
            stamp_ns, *_ = Reader(connection.msgtype).read(bytes(data))
            assert stamp_ns == t_ns
            got.setdefault(connection.topic.lstrip('/'), []).append(stamp_ns)
    assert {k: len(v) for k, v in got.items()} == expected
    assert all(sorted(set(v)) == sorted(v) for v in got.values())


def test_an_existing_path_is_refused(ros_domain, tmp_path):
    from ins_sim.ros.bag_recorder import BagRecorder
    context = rclpy.Context()
    context.init(domain_id=ros_domain)
    try:
        with pytest.raises(ValueError, match='expected a new path'):
            BagRecorder(tmp_path, context=context)
    finally:
        context.shutdown()
