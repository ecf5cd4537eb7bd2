"""Quality of service: one profile for data, one for what late joiners must see."""

from ins_sim.messages import topics
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

ACK_DEPTH = 1000


def data(depth):
    """Return reliable, volatile, keep-last: no loss as long as a queue holds what is under way."""
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=depth,
                      reliability=ReliabilityPolicy.RELIABLE,
                      durability=DurabilityPolicy.VOLATILE)


def latched():
    """Return reliable, transient local, depth 1: the last message reaches late joiners."""
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1,
                      reliability=ReliabilityPolicy.RELIABLE,
                      durability=DurabilityPolicy.TRANSIENT_LOCAL)


def message_class(topic):
    """Return the ROS class of a topic's messages."""
    from importlib import import_module
    package, _, name = topic.type_name.split('/')
    return getattr(import_module(package + '.msg'), name)


def publisher(node, topic, depth):
    """Return a publisher of a Topic for bytes."""
    return node.create_publisher(message_class(topic), topic.name, data(depth))


def ack_publisher(node):
    """Return a publisher of acknowledgements."""
    return publisher(node, topics.ACK, ACK_DEPTH)
