"""
Check the publishers of topics, and count lost messages.

Most topics should have one publisher; a second one is reported. If a publisher offers only best
effort, as sensor drivers do, the subscription is changed to best effort.
"""

from rclpy.qos import ReliabilityPolicy

from ..transport.backlog import BACKLOG_NS
from ..transport.qos_overrides import given
from .said import short

# Number of publishers that a message names at most.
NAMED = 4


class SolePublishers:
    """
    Watches the publishers of topics that should have only one.

    Parameters
    ----------
    node : Node
    queues : {topic name: queue with ``gaps``, or None if the node itself publishes the topic}
    """

    def __init__(self, node, queues):
        self._node, self._suited = node, set()
        self._queues = {node.resolve_topic_name(name): queue for name, queue in queues.items()}

    def describe(self):
        """Return a fault, or '', and no values, as expected by ``Monitor.add``."""
        wrong = ''
        for name, queue in self._queues.items():
            count = self._node.count_publishers(name)
            if queue is not None:
                queue.gaps.publishers = max(1, count)
                self._suit(name, queue)
            if count > 1 and not wrong:
                wrong = (f'{name} has {count} publishers, {self._names(name)}; expected one: two '
                         'of them (two generators, the same node twice, or a player together with '
                         'a simulation) make its readers restart repeatedly')
        return wrong, ()

    def _suit(self, name, queue):
        """Subscribe with best effort if a publisher offers no more, unless a parameter is set."""
        if queue.subscription is None or name in self._suited:
            return
        if 'reliability' in given(self._node, name, 'subscription'):
            return
        infos = self._node.get_publishers_info_by_topic(name)
        weak = [info for info in infos
                if info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT]
        if weak:
            self._suited.add(name)
            queue.read_best_effort()
            self._node.get_logger().info(
                f'{name} is published with best effort: it is read with best effort from now on, '
                'and lost messages are not sent again')

    def _names(self, name):
        infos = self._node.get_publishers_info_by_topic(name)
        names = sorted(f'{info.node_namespace.rstrip("/")}/{info.node_name}' for info in infos)
        more = f' and {len(names) - NAMED} more' if len(names) > NAMED else ''
        return ', '.join(short(name, 80) for name in names[:NAMED]) + more


class MessageLosses:
    """
    Reports messages that were lost in transport or dropped as too old.

    Losses are found from the sequence numbers that the publishers assign.

    Parameters
    ----------
    queues : {topic name: queue with ``gaps`` and ``dropped``}
    depth : depth of these queues
    """

    def __init__(self, queues, depth):
        self._queues, self._depth = queues, depth
        self._lost, self._dropped = dict.fromkeys(queues, 0), dict.fromkeys(queues, 0)

    def describe(self):
        """Return a fault about losses since the previous call, or '', and the counts."""
        wrong, values = '', []
        for name, queue in self._queues.items():
            lost, dropped = queue.gaps.lost, queue.dropped
            if dropped > self._dropped[name]:
                wrong = (f'{dropped - self._dropped[name]} messages of {name} were dropped: they '
                         f'had waited for more than {BACKLOG_NS // 1_000_000_000} s because this '
                         'node cannot keep up; expected a lower rate_hz or real_time_factor, or '
                         'pacing.lock_step')
            elif lost > self._lost[name]:
                wrong = (f'{lost - self._lost[name]} messages of {name} were lost: this node '
                         'or the transport cannot keep up; expected a lower rate_hz or '
                         f'real_time_factor, pacing.lock_step, or a topics.depth above '
                         f'{self._depth}')
            self._lost[name], self._dropped[name] = lost, dropped
            values += [(f'{name} lost', lost), (f'{name} dropped', dropped)]
        return wrong, values
