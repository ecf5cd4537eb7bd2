"""Two vehicles in one graph, with separate namespaces, frame prefixes and epochs."""

import importlib.util
import time

from ins_sim.messages import topics
from ins_sim.messages.run_announcement import read_announcement
import pytest
from support.live import Listener

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

SECOND = 10**9
HEARD = (topics.TRUTH_ODOMETRY, topics.IMU_RAW, topics.INS_ODOMETRY, topics.ERROR_POSITION)
VALUES = {'motion.kind': 'racetrack', 'duration_s': 4.0, 'tf.source': 'ins',
          'gyro.errors.angle_random_walk_deg_sqrt_h': '[0.1, 0.1, 0.1]',
          'pacing.real_time_factor': 0.0, 'pacing.required': '[strapdown, listener]'}
EPOCHS = {'left': {'time.epoch': 'fixed', 'time.epoch_s': 1735689600}, 'right': {
    'time.epoch': 'now'}}


def runs_of(listener):
    """Return a list that receives the runs announced to a node."""
    from ins_sim.ros.transport import qos
    found = []
    listener.node.create_subscription(
        qos.message_class(topics.RUN), topics.RUN.name,
        lambda data: found.append(read_announcement(bytes(data))), qos.latched_profile(), raw=True)
    return found


def test_each_vehicle_has_its_frames_and_its_time(ros_domain, chain):
    """
    No node uses a message of the other vehicle; each learns the epoch of its own generator.

    With ROS from PyPI, which has no tf2_msgs, each node logs this once and runs without
    transforms.
    """
    before_ns = time.time_ns()
    listeners = {name: Listener(ros_domain, HEARD, name) for name in EPOCHS}
    try:
        runs = {name: runs_of(listener) for name, listener in listeners.items()}
        started = {}
        for number, (name, epoch) in enumerate(EPOCHS.items(), 1):
            for node in ('strapdown', 'imu_sensor', 'motion_generator'):
                more = epoch if node == 'motion_generator' else {}
                started[name, node] = chain.start(
                    node, {**VALUES, **more, 'frames.prefix': f'uav{number}'},
                    ['-r', f'__ns:=/{name}'])
        ends = [process for (_, node), process in started.items() if node == 'motion_generator']
        # While one vehicle ends the other continues.
        for listener in listeners.values():
            listener.poll_until(lambda: [other.poll() for other in listeners.values()] and all(
                end.poll() is not None for end in ends))
        # The end of the run is still in the queues.
        for listener in listeners.values():
            listener.poll_until(lambda: len(listener.heard['ins/error/position']) >= 400)
        listeners['right'].spin_until(lambda: runs['right'])
        assert set(chain.end().values()) == {0}
        heard = {name: listener.heard for name, listener in listeners.items()}
        raw = {name: listener.raw for name, listener in listeners.items()}
    finally:
        for listener in listeners.values():
            listener.close()
    for number, name in enumerate(EPOCHS, 1):
        for topic in HEARD:
            data = next(iter(raw[name][topic.name].values()))
            assert topic.reader().strings(data) == tuple(
                f'uav{number}/{frame}' for frame in topic.frames)
        text = chain.text(started[name, 'strapdown'])
        missing = 'tf.source is ins, but tf2_msgs cannot be imported; expected that ROS package'
        assert text.count(missing) == (importlib.util.find_spec('tf2_msgs') is None)
        assert 'no node announces' not in text and 'Traceback' not in text
    left, right = ([*heard[name]['ins/odometry']] for name in EPOCHS)
    assert left[0] == 1735689600 * SECOND and left[-1] == left[0] + 4 * SECOND
    run, = runs['right']
    assert before_ns - 10**6 < run.first_stamp_ns < time.time_ns()
    assert right[0] == run.first_stamp_ns and run.end_ns == 4 * SECOND
    # The flights are equal: the epoch changes only the stamps.
    for topic in HEARD:
        assert [*heard['left'][topic.name].values()] == [*heard['right'][topic.name].values()]
