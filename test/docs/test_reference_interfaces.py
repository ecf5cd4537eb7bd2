"""The table of the topics and services of nodes agrees with the nodes themselves."""

from importlib.util import find_spec
import os
import sys
from types import ModuleType

from ins_sim.messages.interfaces import INTERFACES, quality
from ins_sim.messages.topic_contents import CONTENTS
from ins_sim.messages import topics
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

OF_ROS = ('/rosout', '/parameter_events')
GUIDED = {'motion.kind': 'guided', 'duration_s': 60.0,
          'motion.route.points.latitude_deg': [55.75, 55.75],
          'motion.route.points.longitude_deg': [37.62, 40.0]}
LOCK_STEP = {'pacing.lock_step': True}
# For each node sets of parameters that together give all topics and services of the table.
RUNS = {
    'motion_generator': ({}, LOCK_STEP, {'publish_clock': True, 'tf.source': 'truth'}, GUIDED),
    'imu_sensor': ({}, {'gyro.model': 'dtg', 'output': 'integrated'},
                   {'barometer.publish': True, 'tf.source': 'ins'},
                   {'magnetometer.publish': True}),
    'strapdown': ({}, {'imu_data': True, 'tf.source': 'ins'}, {'tf.source': 'aided'},
                  {'initial.source': 'alignment', 'input': 'instant'}),
    'velocity_meter': ({}, {'attack_angle': 'ins', 'tf.source': 'truth'}),
    'gnss': ({}, {'tf.source': 'truth'}),
    'aided_navigator': ({}, {'gnss_model.use': True, 'tf.source': 'aided'},
                        {'meter_model.use': False}),
    'truth_adapter': ({}, {'tf.source': 'truth', **LOCK_STEP}),
    'recorder': ({'record.topics': ['imu/data_raw']},)}


class Found:
    """Names and QoS of the topics and services of a node."""

    def __init__(self, node):
        self.publishes = {p.topic_name: p.qos_profile for p in node.publishers}
        self.subscribes = {s.topic_name: s.qos_profile for s in node.subscriptions}
        # Those that ROS gives every node have full names.
        self.services = {s.srv_name for s in node.services if s.srv_name.startswith('~/')}


@pytest.fixture
def graph(ros_domain, monkeypatch, tmp_path):
    """Return a function (node, parameters) -> Found; messages of tf2_msgs may be stand-ins."""
    import rclpy
    from rclpy.parameter import Parameter
    monkeypatch.chdir(tmp_path)
    if find_spec('tf2_msgs') is None:
        from std_msgs.msg import Header
        for name in ('tf2_msgs', 'tf2_msgs.msg'):
            monkeypatch.setitem(sys.modules, name, ModuleType(name))
        sys.modules['tf2_msgs.msg'].TFMessage = Header
    rclpy.init(domain_id=int(os.environ['ROS_DOMAIN_ID']))

    def made(name, parameters):
        from ins_sim.ros import main
        node = main._load(name)(parameter_overrides=[
            Parameter(key, value=value) for key, value in parameters.items()])
        try:
            return Found(node)
        finally:
            node.destroy_node()

    yield made
    rclpy.shutdown()


def listed(uses, always=False):
    """Return the full names of the topics of a table; if always, only the unconditional ones."""
    return {'/' + use.topic.name.lstrip('/') for use in uses if not (always and use.condition)}


@pytest.mark.parametrize('name', RUNS)
def test_the_table_is_what_the_node_has(name, graph):
    """Over some sets of parameters a node has exactly the topics and services of the table."""
    table, everything = INTERFACES[name], {'publishes': set(), 'subscribes': set()}
    served = set()
    for parameters in RUNS[name]:
        found = graph(name, parameters)
        for kind, names in everything.items():
            has = set(getattr(found, kind)) - set(OF_ROS)
            if name == 'recorder' and kind == 'subscribes':
                has -= {'/imu/data_raw'}
            assert has >= listed(getattr(table, kind), always=True)
            names |= has
        assert found.services >= {s.name for s in table.services if not s.condition}
        served |= found.services
    assert everything == {kind: listed(getattr(table, kind)) for kind in everything}
    standard = {s.name for s in table.services
                if s.type_name.startswith('simulation_interfaces')}
    assert served | standard == {s.name for s in table.services}


@pytest.mark.parametrize('name, parameters', [
    ('motion_generator', {'publish_clock': True, 'tf.source': 'truth'}),
    ('imu_sensor', {'tf.source': 'truth'}), ('truth_adapter', {})])
def test_quality_of_service_is_that_of_the_table(name, parameters, graph):
    """Durability, and depths that do not follow topics.depth, are those of the reference."""
    known = {'/' + topic.name.lstrip('/'): topic for topic in CONTENTS}
    for full, profile in graph(name, parameters).publishes.items():
        if full in known:
            durability = profile.durability.name.lower().replace('_', ' ')
            words = quality(known[full]).replace('topics.depth', '10000')
            assert words == f'{profile.reliability.name.lower()}, {durability}, ' \
                            f'depth {profile.depth}', full


def test_standard_services_are_those_that_are_offered():
    """The services of simulation_interfaces in the table are those that the node implements."""
    from ins_sim.ros.lock_step.standard_services import PACKAGE, StandardServices
    offered = {f'~/{name}' for name in vars(StandardServices) if not name.startswith('_')}
    table = INTERFACES['motion_generator'].services
    assert {s.name for s in table if s.type_name.startswith(PACKAGE)} == offered


def test_every_topic_has_its_contents_and_every_node_its_interface():
    """The tables hold each topic of messages.topics once, and each executable node."""
    from ins_sim.ros.main import NODES
    from ins_sim.settings.by_node import ALL_NODES
    found = {one for value in vars(topics).values()
             for one in (value if isinstance(value, tuple) else (value,))
             if isinstance(one, topics.Topic)}
    assert {topic.name for topic in found} | {'/diagnostics'} == {
        topic.name for topic in CONTENTS}
    assert set(INTERFACES) == set(NODES) >= set(ALL_NODES)
