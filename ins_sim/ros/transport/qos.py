"""Quality of service: one profile for data, one for what late joiners must see."""

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from ins_sim.messages import topics

ACK_DEPTH = 1000
LATCHING = DurabilityPolicy.TRANSIENT_LOCAL


def data_profile(depth):
    """Return reliable, volatile, keep-last: no loss as long as a queue holds what is under way."""
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=depth,
                      reliability=ReliabilityPolicy.RELIABLE,
                      durability=DurabilityPolicy.VOLATILE)


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
    """Return a publisher of a Topic for bytes; depth: of its queue, unless it is latched."""
    publisher = node.create_publisher(message_class(topic), topic.name,
                                      latched_profile() if topic.latched else data_profile(depth))
    hand_over = hand_over_of(node)
    return publisher if hand_over is None else hand_over.publisher(node, topic, publisher)


def hand_over_of(node):
    """Return the HandOver of a node that shares its process with others, else None."""
    return getattr(node, 'hand_over', None)


def ack_publisher(node):
    """Return a publisher of acknowledgements."""
    return make_publisher(node, topics.ACK, ACK_DEPTH)


def offered_profile(infos):
    """
    Return the reliability and durability that suit all publishers (TopicEndpointInfo) of a topic.

    They are the most that every one of them offers.
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
    Return the profile that offers what all recorded offers did, so that it suits their readers.

    profiles: as ``bags.qos.read_profiles`` gives them; old bags have numbers for names.
    """
    weak = profiles and all(p.get('reliability') in ('best_effort', 2) for p in profiles)
    latching = any(p.get('durability') in ('transient_local', 1) for p in profiles)
    return keep_last(depth,
                     ReliabilityPolicy.BEST_EFFORT if weak else ReliabilityPolicy.RELIABLE,
                     DurabilityPolicy.TRANSIENT_LOCAL if latching else DurabilityPolicy.VOLATILE)
