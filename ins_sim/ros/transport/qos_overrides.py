"""
Quality of service by parameters: qos_overrides./topic.publisher.depth and the like.

rclpy declares such parameters for every entity that asks for it, which takes a node's start
milliseconds; here they are declared for those alone of which one is given.
"""

from rclpy.qos import QoSPolicyKind
from rclpy.qos_overriding_options import QoSOverridingOptions

from ins_sim.settings.shown import shown
from ins_sim.settings.suggest import nearest_name

# What each policy may be; of a depth the bounds.
POLICIES = {'history': ('keep_last', 'keep_all'), 'depth': (1, 1_000_000),
            'reliability': ('reliable', 'best_effort'),
            'durability': ('volatile', 'transient_local')}
PREFIX = 'qos_overrides.'


def advertise(node, message_class, name, profile):
    """Return a publisher with a profile, or what the parameters make of it."""
    return node.create_publisher(message_class, name, profile,
                                 qos_overriding_options=_options(node, name, 'publisher'))


def subscribe(node, message_class, name, callback, profile, **options):
    """Return a subscription likewise; options: further ones of ``create_subscription``."""
    return node.create_subscription(message_class, name, callback, profile,
                                    qos_overriding_options=_options(node, name, 'subscription'),
                                    **options)


def given(node, name, kind):
    """
    Return {policy: value} of the parameters for a topic; kind: publisher or subscription.

    Raises ValueError, one sentence, for a policy that cannot be set, or not to that value.
    """
    overrides = {key: parameter.value for key, parameter in node._parameter_overrides.items()
                 if key.startswith(PREFIX)}
    if not overrides:
        return {}
    try:
        prefix = f'{PREFIX}{node.resolve_topic_name(name)}.{kind}.'
    except RuntimeError:
        # a name that is none: rclpy refuses it in its own words when the entity is made
        return {}
    return {key[len(prefix):]: _checked(key, key[len(prefix):], value)
            for key, value in overrides.items() if key.startswith(prefix)}


def _checked(key, policy, value):
    if policy not in POLICIES:
        raise ValueError(f'{key}: no policy {policy!r} can be set; expected one of '
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
    """Return the given names that belong to no publisher and no subscription of a node."""
    known = tuple(f'{PREFIX}{node.resolve_topic_name(entity.topic_name)}.{kind}.'
                  for entities, kind in ((node.publishers, 'publisher'),
                                         (node.subscriptions, 'subscription'))
                  for entity in entities)
    return [key for key in node._parameter_overrides
            if key.startswith(PREFIX) and not key.startswith(known)]
