"""
Subscriptions that deliver serialized messages and are emptied explicitly.

Each counts lost messages from the sequence numbers that the publishers assign.
"""

from collections import deque
import time

from rclpy.callback_groups import CallbackGroup

from . import qos
from .gaps import Gaps
from .qos_overrides import subscribe

TURN_S = 0.01
LINGER_S = 0.003
NAP_S = 5e-4
BATCH = 50
# A message that has waited longer than this, ns, is dropped if no node waits for its
# acknowledgement.
BACKLOG_NS = 5_000_000_000


class NeverReady(CallbackGroup):
    """Keeps an entity out of the executor's wait set; its owner takes the messages."""

    def can_execute(self, entity):
        """Tell the executor that there is nothing to wait for."""
        return False

    def beginning_execution(self, entity):
        """Refuse to execute."""
        return False

    def ending_execution(self, entity):
        """Do nothing."""


class HandQueue:
    """
    A raw subscription that is not in the executor's wait set; its owner takes the messages.

    In a process with several nodes it may be a queue in memory, see ``hand_over``.

    Parameters
    ----------
    node, topic, depth : Node, Topic and depth of the queue
    profile : QoS of the subscription, by default reliable, volatile, keep-last
    """

    def __init__(self, node, topic, depth, profile=None):
        self.topic, self.gaps, self.dropped = topic.name, Gaps(), 0
        self._node, self._depth, self._profile = node, depth, profile or qos.data_profile(depth)
        self._group, self.subscription = NeverReady(), None
        self._class = qos.message_class(topic)
        hand_over = qos.hand_over_of(node)
        if hand_over is not None and profile is None and hand_over.serves(topic):
            # Nothing arrives before the queue is connected.
            self.take = lambda: None
            hand_over.join(node, topic, self)
        else:
            self.subscribe()

    def subscribe(self):
        """Subscribe to the topic over DDS."""
        self.take = self._take_counted
        self.subscription = subscribe(self._node, self._class, self.topic, lambda data: None,
                                      self._profile, raw=True, callback_group=self._group)
        self._take = self.subscription.handle.take_message

    def read_best_effort(self):
        """
        Replace the subscription by one with best effort, to match publishers with best effort.

        If the messages are passed in memory there is no subscription, and nothing is done.
        """
        if self.subscription is None:
            return
        self._node.destroy_subscription(self.subscription)
        self._profile = qos.best_effort_profile(self._depth)
        self.subscribe()

    def accept(self, patience):
        """Return the function that receives a message; a waiting Patience then continues."""
        waiting = deque()
        self.take = lambda: waiting.popleft() if waiting else None

        def receive(data):
            if len(waiting) == self._depth:
                waiting.popleft()
                self.gaps.lost += 1
            waiting.append(data)
            if patience is not None and patience.waits:
                patience.go_on()

        return receive

    def _take_counted(self):
        """Return the oldest message as bytes, or None."""
        taken = self._take(self._class, True)
        if taken is None:
            return None
        self.gaps.take(taken[1]['publication_sequence_number'])
        return taken[0]

    def take_with_info(self):
        """Return the oldest message as bytes with its DDS information, or None."""
        return self._take(self._class, True)


class DrivingQueue:
    """
    A raw subscription whose callback processes all messages in its queue.

    One cycle of the executor costs more than one message. The callback therefore takes all
    messages and waits linger_s for another one before it returns to the executor. After TURN_S
    it returns in any case, so that timers and services are served.

    Messages that have waited for BACKLOG_NS are dropped and counted if may_drop() is true: in
    real time a late message is worth less than a new one.

    Parameters
    ----------
    node, topic, depth : Node, Topic and depth of the queue
    on_data : callable, called with the bytes of each message
    on_drained : callable, called when the queue is empty and after every BATCH messages
    may_drop : callable that returns whether old messages may be dropped
    linger_s : time to wait for a further message, s
    """

    def __init__(self, node, topic, depth, on_data, on_drained, may_drop, linger_s=0.0):
        self.gaps, self.dropped, self._may_drop = Gaps(), 0, may_drop
        self._on_data, self._on_drained, self._linger_s = on_data, on_drained, linger_s
        self._node, self._depth = node, depth
        self.topic, self._profile, self.subscription = topic.name, qos.data_profile(depth), None
        self._class = qos.message_class(topic)
        hand_over = qos.hand_over_of(node)
        if hand_over is None:
            self.subscribe()
        else:
            # Do not linger: the main loop of this process also serves the other nodes.
            self._linger_s = 0.0
            hand_over.join(node, topic, self)
            hand_over.add_drained(on_drained)

    def subscribe(self):
        """Subscribe to the topic over DDS."""
        self.subscription = subscribe(self._node, self._class, self.topic, self._wake,
                                      self._profile, raw=True)
        self._take = self.subscription.handle.take_message

    def read_best_effort(self):
        """Replace the subscription by one with best effort, as a HandQueue does."""
        if self.subscription is None:
            return
        self._node.destroy_subscription(self.subscription)
        self._profile = qos.best_effort_profile(self._depth)
        self.subscribe()

    def accept(self, patience):
        """Return the function that receives messages of nodes in this process."""
        return self._on_data

    def _give(self, data, info, late_ns):
        self.gaps.take(info['publication_sequence_number'])
        # A middleware that does not record the time of reception reports zero.
        if 0 < info['received_timestamp'] < late_ns and self._may_drop():
            self.dropped += 1
        else:
            self._on_data(data)

    def _wake(self, data, info):
        now, late_ns = time.monotonic(), time.time_ns() - BACKLOG_NS
        turn_end, linger_end = now + TURN_S, now + self._linger_s
        self._give(data, info, late_ns)
        count = 1
        while now < turn_end:
            taken = self._take(self._class, True)
            now = time.monotonic()
            if taken is not None:
                self._give(*taken, late_ns)
                count += 1
                linger_end = now + self._linger_s
                if count < BATCH:
                    continue
            if count:
                self._on_drained()
                count = 0
            if taken is None:
                if now >= linger_end:
                    break
                time.sleep(NAP_S)
        if count:
            self._on_drained()
