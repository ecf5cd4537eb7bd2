"""Quality of service: profiles for data, for latched topics, and for recording and playing."""

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from ins_sim.messages import topics
from .qos_overrides import advertise

ACK_DEPTH = 1000
LATCHING = DurabilityPolicy.TRANSIENT_LOCAL


def data_profile(depth):
    """Return reliable, volatile, keep-last: nothing is lost unless a queue overflows."""
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=depth,
                      reliability=ReliabilityPolicy.RELIABLE,
                      durability=DurabilityPolicy.VOLATILE)


def best_effort_profile(depth):
    """Return best effort, volatile, keep-last: compatible with publishers of any reliability."""
    return keep_last(depth, ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE)


def latched_profile():
    """Return reliable, transient local, depth 1: the last message reaches late joiners."""
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1,
                      reliability=ReliabilityPolicy.RELIABLE,
                      durability=DurabilityPolicy.TRANSIENT_LOCAL)


def message_class(topic):
    """Return the ROS class of a topic's messages."""
    from importlib import import_module
    package, _, name = topic.type_name.split('/')
    return getattr(import_module(package + '.msg'), name)


def make_publisher(node, topic, depth):
    """Return a publisher of serialized messages of a Topic; latched topics ignore ``depth``."""
    profile = latched_profile() if topic.latched else data_profile(depth)
    publisher = advertise(node, message_class(topic), topic.name, profile)
    hand_over = hand_over_of(node)
    return publisher if hand_over is None else hand_over.publisher(node, topic, publisher)


def hand_over_of(node):
    """Return the HandOver of a node that shares its process with other nodes, else None."""
    return getattr(node, 'hand_over', None)


def ack_publisher(node):
    """Return a publisher of acknowledgements."""
    return make_publisher(node, topics.ACK, ACK_DEPTH)


def offered_profile(infos):
    """
    Return the strongest reliability and durability that all publishers of a topic offer.

    ``infos`` are their TopicEndpointInfo.
    """
    profiles = [info.qos_profile for info in infos]
    reliable = all(p.reliability == ReliabilityPolicy.RELIABLE for p in profiles)
    latching = all(p.durability == DurabilityPolicy.TRANSIENT_LOCAL for p in profiles)
    return (ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
            DurabilityPolicy.TRANSIENT_LOCAL if latching else DurabilityPolicy.VOLATILE)


def keep_last(depth, reliability, durability):
    """Return a keep-last profile."""
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=depth, reliability=reliability,
                      durability=durability)


def recorded_profile(profiles, depth):
    """
    Return a profile that is compatible with the readers of all recorded publishers of a topic.

    ``profiles`` is the result of ``bags.qos.read_profiles``; old bags have numbers for names.
    """
    weak = profiles and all(p.get('reliability') in ('best_effort', 2) for p in profiles)
    latching = any(p.get('durability') in ('transient_local', 1) for p in profiles)
    return keep_last(depth,
                     ReliabilityPolicy.BEST_EFFORT if weak else ReliabilityPolicy.RELIABLE,
                     DurabilityPolicy.TRANSIENT_LOCAL if latching else DurabilityPolicy.VOLATILE)
