"""
Subscriptions that give bytes and are emptied by hand.

Each counts by the numbers of the publishers what was lost before it was taken.
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
# what has waited for longer is dropped where nobody waits for its answer
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
    A raw subscription out of the wait set; profile: its QoS, by default that of data.

    In a process of several nodes it may be a queue in memory, see ``hand_over``.
    """

    def __init__(self, node, topic, depth, profile=None):
        self.topic, self.gaps, self.dropped = topic.name, Gaps(), 0
        self._node, self._depth, self._profile = node, depth, profile or qos.data_profile(depth)
        self._group, self.subscription = NeverReady(), None
        self._class = qos.message_class(topic)
        hand_over = qos.hand_over_of(node)
        if hand_over is not None and profile is None and hand_over.serves(topic):
            # nothing comes before it is joined
            self.take = lambda: None
            hand_over.join(node, topic, self)
        else:
            self.subscribe()

    def subscribe(self):
        """Hear the topic by DDS."""
        self.take = self._take_counted
        self.subscription = subscribe(self._node, self._class, self.topic, lambda data: None,
                                      self._profile, raw=True, callback_group=self._group)
        self._take = self.subscription.handle.take_message

    def read_best_effort(self):
        """
        Subscribe anew, so that a publisher that is no more than best effort is heard.

        Nothing is to be done where the messages come in memory, without a subscription.
        """
        if self.subscription is None:
            return
        self._node.destroy_subscription(self.subscription)
        self._profile = qos.best_effort_profile(self._depth)
        self.subscribe()

    def accept(self, patience):
        """Return the function that takes a message; patience: goes on when one has come."""
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
        """Return the oldest message as bytes and what DDS notes of it, or None."""
        return self._take(self._class, True)


class DrivingQueue:
    """
    A raw subscription whose wake-up drains its queue.

    A cycle of the executor costs more than a message.  So a wake-up takes all there are, and
    with linger_s waits that long for the next one before it goes back to the executor; it does
    so after TURN_S in any case, for timers and services.  on_data(bytes) takes each message,
    on_drained() follows when the queue is empty and every BATCH messages.  What has waited for
    BACKLOG_NS is ``dropped``, and counted, where may_drop() says so: in real time, what is late
    is worth less than what is new.
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
            # what is sent elsewhere is served beside the run of this process
            self._linger_s = 0.0
            hand_over.join(node, topic, self)
            hand_over.add_drained(on_drained)

    def subscribe(self):
        """Hear the topic by DDS."""
        self.subscription = subscribe(self._node, self._class, self.topic, self._wake,
                                      self._profile, raw=True)
        self._take = self.subscription.handle.take_message

    def read_best_effort(self):
        """Subscribe anew, as a HandQueue does."""
        if self.subscription is None:
            return
        self._node.destroy_subscription(self.subscription)
        self._profile = qos.best_effort_profile(self._depth)
        self.subscribe()

    def accept(self, patience):
        """Return the function that takes a message in this process."""
        return self._on_data

    def _give(self, data, info, late_ns):
        self.gaps.take(info['publication_sequence_number'])
        # a middleware that notes no time gives zero
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
