"""
Set the quality of service by parameters such as qos_overrides./topic.publisher.depth.

rclpy declares these parameters for every publisher and subscription that allows overrides, which
costs milliseconds at the start of a node. Here they are declared only if the user has set one.
"""

from rclpy.qos import QoSPolicyKind
from rclpy.qos_overriding_options import QoSOverridingOptions

from ins_sim.settings.shown import shown
from ins_sim.settings.suggest import nearest_name

# Allowed values of each policy; for depth, the bounds.
POLICIES = {'history': ('keep_last', 'keep_all'), 'depth': (1, 1_000_000),
            'reliability': ('reliable', 'best_effort'),
            'durability': ('volatile', 'transient_local')}
PREFIX = 'qos_overrides.'


def advertise(node, message_class, name, profile):
    """Return a publisher with a QoS profile, modified by the parameters."""
    return node.create_publisher(message_class, name, profile,
                                 qos_overriding_options=_options(node, name, 'publisher'))


def subscribe(node, message_class, name, callback, profile, **options):
    """Return a subscription likewise; ``options`` are passed to ``create_subscription``."""
    return node.create_subscription(message_class, name, callback, profile,
                                    qos_overriding_options=_options(node, name, 'subscription'),
                                    **options)


def given(node, name, kind):
    """
    Return {policy: value} of the parameters set for a topic.

    Parameters
    ----------
    node : Node
    name : name of the topic
    kind : ``publisher`` or ``subscription``

    Raises
    ------
    ValueError : the policy does not exist or cannot have that value; the message is one sentence
    """
    overrides = {key: parameter.value for key, parameter in node._parameter_overrides.items()
                 if key.startswith(PREFIX)}
    if not overrides:
        return {}
    try:
        prefix = f'{PREFIX}{node.resolve_topic_name(name)}.{kind}.'
    except RuntimeError:
        # The name is invalid; rclpy reports this when the publisher or subscription is made.
        return {}
    return {key[len(prefix):]: _checked(key, key[len(prefix):], value)
            for key, value in overrides.items() if key.startswith(prefix)}


def _checked(key, policy, value):
    if policy not in POLICIES:
        raise ValueError(f'{key}: the policy {policy!r} cannot be set; expected one of '
                         f'{", ".join(POLICIES)} (nearest: {nearest_name(policy, POLICIES)})')
    allowed = POLICIES[policy]
    if policy == 'depth':
        if isinstance(value, bool) or not isinstance(value, int) or not (
                allowed[0] <= value <= allowed[1]):
            raise ValueError(f'{key} is {shown(value)}; expected a whole number from '
                             f'{allowed[0]} to {allowed[1]}')
    elif value not in allowed:
        raise ValueError(f'{key} is {shown(value)}; expected one of {", ".join(allowed)}')
    return value


def _options(node, name, kind):
    policies = given(node, name, kind)
    return QoSOverridingOptions([QoSPolicyKind[p.upper()] for p in policies]) if policies else None


def unused(node):
    """Return the override parameters that belong to no publisher or subscription of a node."""
    known = tuple(f'{PREFIX}{node.resolve_topic_name(entity.topic_name)}.{kind}.'
                  for entities, kind in ((node.publishers, 'publisher'),
                                         (node.subscriptions, 'subscription'))
                  for entity in entities)
    return [key for key in node._parameter_overrides
            if key.startswith(PREFIX) and not key.startswith(known)]
