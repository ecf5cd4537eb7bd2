"""Quality of service: overrides by parameters work, and best-effort publishers are received."""

import time

from ins_sim.messages import topics
import pytest
from support.live import GUARD_S

pytest.importorskip('rclpy')


@pytest.fixture
def make_node(ros_domain):
    """Return a function that makes a node of ins_sim in this process from its parameters."""
    import rclpy
    from rclpy.parameter import Parameter
    from ins_sim.ros.main import _load
    context, made = rclpy.Context(), []
    context.init(domain_id=ros_domain)

    def make(name, **parameters):
        made.append(_load(name)(context=context, parameter_overrides=[
            Parameter(key, value=value) for key, value in parameters.items()]))
        return made[-1]

    yield make
    for node in made:
        node.destroy_node()
    context.shutdown()


def wait_for(condition):
    """Wait until DDS discovery has found something; return it."""
    end = time.monotonic() + GUARD_S
    while not (found := condition()):
        assert time.monotonic() < end
        time.sleep(0.02)
    return found


@pytest.mark.live
def test_a_reader_sees_the_overrides(make_node, talker):
    """A reader sees the reliability set by the parameters; other settings are unchanged."""
    from rclpy.qos import ReliabilityPolicy
    own = {f'qos_overrides./{name}.{key}': value for name, key, value in (
        ('ins/odometry', 'publisher.reliability', 'best_effort'),
        ('ins/odometry', 'publisher.depth', 7),
        ('imu/data_raw', 'subscription.reliability', 'best_effort'),
        ('diagnostics', 'publisher.durability', 'transient_local'))}
    node = make_node('strapdown', **own)
    reader = talker.node
    for name, look, expected in (
            ('/ins/odometry', reader.get_publishers_info_by_topic, ReliabilityPolicy.BEST_EFFORT),
            ('/ins/fix', reader.get_publishers_info_by_topic, ReliabilityPolicy.RELIABLE),
            ('/imu/data_raw', reader.get_subscriptions_info_by_topic,
             ReliabilityPolicy.BEST_EFFORT),
            ('/truth/odometry', reader.get_subscriptions_info_by_topic,
             ReliabilityPolicy.RELIABLE)):
        info, = wait_for(lambda: look(name))
        assert info.qos_profile.reliability == expected, name
    info, = wait_for(lambda: reader.get_publishers_info_by_topic('/diagnostics'))
    assert info.qos_profile.durability.name == 'TRANSIENT_LOCAL'
    assert {key: node.get_parameter(key).value for key in own} == own


@pytest.mark.live
def test_a_best_effort_publisher_is_heard(make_node, talker):
    """When a best-effort publisher appears, subscriptions are made anew and receive it."""
    from nav_msgs.msg import Odometry
    from rclpy.executors import SingleThreadedExecutor
    from sensor_msgs.msg import Imu
    node = make_node('strapdown')
    said = []
    node.get_logger = lambda: Told(said)
    publishers = [talker.publisher(cls, name, 'best_effort') for cls, name in (
        (Imu, 'imu/data_raw'), (Odometry, 'truth/odometry'))]
    for publisher in publishers:
        wait_for(lambda: node.get_publishers_info_by_topic(publisher.topic_name))
    node.monitor.publish()
    assert sum('is published with best effort: it is read with best effort' in text
               for text in said) == 2
    talker.wait_matched(*publishers)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    stamp_ns, end = 0, time.monotonic() + GUARD_S
    truth = topics.TRUTH_ODOMETRY.writer().pack(0, (0.0,) * 6 + (1.0,), (0.0,) * 6)
    queue, heard = node.hand_queues()['truth/odometry'], None
    while not (node.monitor.received and heard):
        assert time.monotonic() < end
        stamp_ns += 10_000_000
        publishers[0].publish(talker.imu_bytes(stamp_ns))
        publishers[1].publish(truth)
        executor.spin_once(timeout_sec=0.02)
        heard = heard or queue.take()


class Told:
    """A logger that stores its messages."""

    def __init__(self, said):
        self.info = self.warning = said.append


@pytest.mark.live
def test_the_announcement_is_read_as_the_parameters_say(make_node, talker):
    """Overrides apply to the subscription of sim/run as to every other one."""
    key = 'qos_overrides./sim/run.subscription.durability'
    node, said = make_node('strapdown', **{key: 'volatile'}), []
    info, = wait_for(lambda: talker.node.get_subscriptions_info_by_topic('/sim/run'))
    assert info.qos_profile.durability.name == 'VOLATILE'
    assert node.get_parameter(key).value == 'volatile'
    node.get_logger = lambda: Told(said)
    node.monitor.publish()
    assert not any('qos_overrides' in text for text in said)


@pytest.mark.live
def test_what_is_handed_over_in_memory_is_not_subscribed_to(make_node, talker):
    """A best-effort publisher changes nothing for topics that are passed in memory."""
    simulation = make_node('simulation', **{
        f'qos_overrides./{name}.publisher.reliability': 'best_effort'
        for name in ('truth/imu', 'truth/odometry', 'imu/data_raw')})
    talker.publisher(import_odometry(), 'truth/odometry', 'best_effort')
    wait_for(lambda: talker.node.count_publishers('/truth/odometry') == 2)
    for member in simulation.members[1:]:
        said = []
        member.get_logger = lambda said=said: Told(said)
        for name in ('/truth/imu', '/truth/odometry', '/imu/data_raw'):
            wait_for(lambda: member.get_publishers_info_by_topic(name))
        member.monitor.publish()
        assert not any('best effort' in text or 'Error' in text for text in said), said
        for queue in (member._queue, *member.hand_queues().values()):
            queue.read_best_effort()
            assert queue.subscription is None
        heard = [s.topic_name for s in member.subscriptions]
        assert not any('truth' in name or 'imu' in name for name in heard), heard
    assert simulation.step() is not None


def import_odometry():
    """Return the message class, imported only where ROS is available."""
    from nav_msgs.msg import Odometry
    return Odometry


@pytest.mark.live
@pytest.mark.parametrize('key, value, sentence', [
    ('ins/odometry.publisher.depht', 5, "the policy 'depht' cannot be set; expected one of "
     r'history, depth, reliability, durability \(nearest: depth\)'),
    ('ins/odometry.publisher.depth', 0, 'is 0; expected a whole number from 1 to 1000000'),
    ('ins/odometry.publisher.depth', 2.5, 'is 2.5; expected a whole number from 1 to 1000000'),
    ('imu/data_raw.subscription.reliability', 'best-effort', "is 'best-effort'; expected one of "
     'reliable, best_effort')])
def test_an_override_that_cannot_be(key, value, sentence, make_node):
    """
    An invalid override gives one message before anything is published.

    It has place, key, value and expectation.
    """
    with pytest.raises(ValueError, match=f'^qos_overrides./{key}:? {sentence}$'):
        make_node('strapdown', **{f'qos_overrides./{key}': value})


@pytest.mark.live
def test_overrides_of_other_nodes_are_told_once(make_node):
    """Overrides for other nodes, as in a file for all nodes, are reported once in /diagnostics."""
    node, said = make_node('strapdown', **{'qos_overrides./no/topic.publisher.depth': 3}), []
    node.get_logger = lambda: Told(said)
    sent = []
    node.monitor._publisher = type('Publisher', (), {'publish': staticmethod(sent.append)})
    node.monitor.publish()
    node.monitor.publish()
    assert sum('1 qos_overrides belong to no publisher or subscription of this node '
               'and have no effect here; the first is qos_overrides./no/topic.publisher.depth'
               in text for text in said) == 1
    assert {array.status[0].hardware_id for array in sent} == {'/strapdown'}
