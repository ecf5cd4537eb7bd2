"""Our transforms over DDS, received as tf2_msgs by a node of another package."""

import importlib.util
import json
import signal
import sys

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.definitions import TABLE
from ins_sim.messages.transforms import read_transforms
import pytest
from support.nodes.built_interfaces import build_interfaces
from support.live import GUARD_S

pytest.importorskip('rclpy')
pytestmark = [pytest.mark.live, pytest.mark.slow]

# A node as a user writes it, with the QoS of a tf2 listener. It prints the received transforms and
# then publishes one of our frames until it is ended.
LISTENER = """
import json, time
from geometry_msgs.msg import TransformStamped
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage
rclpy.init()
node = rclpy.create_node('somebody')
heard = {'/tf': [], '/tf_static': []}

def listen(name, durability):
    def take(message):
        for one in message.transforms:
            p, q = one.transform.translation, one.transform.rotation
            heard[name].append((one.header.frame_id, one.child_frame_id, one.header.stamp.sec,
                                (p.x, p.y, p.z), (q.x, q.y, q.z, q.w)))
    node.create_subscription(TFMessage, name, take, QoSProfile(depth=100, durability=durability))

listen('/tf', DurabilityPolicy.VOLATILE)
listen('/tf_static', DurabilityPolicy.TRANSIENT_LOCAL)
while len(heard['/tf']) < 200 or len(heard['/tf_static']) < 2:
    rclpy.spin_once(node, timeout_sec=0.1)
print('HEARD ' + json.dumps(heard), flush=True)
publisher = node.create_publisher(TFMessage, '/tf', 100)
other = TransformStamped(child_frame_id='uav1/base_link')
other.header.frame_id = 'uav1/map'
while True:
    publisher.publish(TFMessage(transforms=[other]))
    time.sleep(0.02)
"""


def definitions():
    """Return {file: text} of the two public definitions of the package."""
    table = json.loads(TABLE.read_text(encoding='utf-8'))
    return {f'msg/{name}.msg': '\n'.join(table[f'tf2_msgs/msg/{name}']['lines']) + '\n'
            for name in ('TF2Error', 'TFMessage')}


def test_a_listener_of_tf_hears_us(chain, tmp_path):
    """
    A listener receives frames, poses and static transforms; a second publisher is reported.

    A recorder logs every transform at its own stamp, and static ones as latched.
    """
    environment = {} if importlib.util.find_spec('tf2_msgs') else build_interfaces(
        tmp_path / 'tf2_msgs', 'tf2_msgs', definitions(), 'geometry_msgs')
    for name, value in environment.items():
        rest = chain.environment.get(name)
        chain.environment[name] = f'{value}:{rest}' if rest else value
    values = {'motion.kind': 'static', 'duration_s': 0.0, 'tf.source': 'ins',
              'frames.prefix': 'uav1', 'time.epoch': 'now'}
    recorder = chain.start_verb('record', '/tf', '/tf_static', '-o', tmp_path / 'bag')
    chain.wait_text(recorder, 'waiting for')
    nodes = {node: chain.start(node, values)
             for node in ('strapdown', 'imu_sensor', 'motion_generator')}
    (tmp_path / 'listener.py').write_text(LISTENER, encoding='utf-8')
    listener = chain.run('listener', [sys.executable, str(tmp_path / 'listener.py')])
    chain.wait_text(listener, 'HEARD ', GUARD_S)
    line, = [text for text in chain.text(listener).splitlines() if text.startswith('HEARD ')]
    heard = json.loads(line.removeprefix('HEARD '))
    assert all(one[:2] == ['uav1/odom', 'uav1/base_link'] and one[2] > 1735689600
               for one in heard['/tf'])
    assert abs(sum(x * x for x in heard['/tf'][-1][4]) - 1.0) < 1e-12
    fixed = {tuple(one[:2]): one[3:] for one in heard['/tf_static']}
    assert fixed == dict.fromkeys([('uav1/map', 'uav1/odom'), ('uav1/base_link', 'uav1/imu_link')],
                                  [[0.0] * 3, [0.0, 0.0, 0.0, 1.0]])
    chain.wait_text(nodes['strapdown'], "/tf: another node publishes 'uav1/base_link' in "
                    "'uav1/map', and this node publishes it in 'uav1/odom'; expected one source "
                    'for each frame', GUARD_S)
    said = chain.text(nodes['strapdown'])
    assert said.count('another node publishes') == 1 and 'tf2_msgs' not in said
    listener.kill()
    listener.wait()
    assert all(process.poll() is None for process in nodes.values())
    recorder.send_signal(signal.SIGINT)
    assert recorder.wait(GUARD_S) == 0, chain.text(recorder)
    with open_bag(tmp_path / 'bag') as bag:
        found = [(name, log_ns, *read_transforms(bytes(data)))
                 for name, log_ns, data in bag.messages()]
        assert 'transient_local' in bag.topics['/tf_static'].qos
    assert {one[1] for name, _, one in found if name == '/tf_static'} == {
        'uav1/odom', 'uav1/imu_link'}
    # The other node uses a stamp of zero.
    assert len(found) > 200 and all(log_ns == one[2] for _, log_ns, one in found)
