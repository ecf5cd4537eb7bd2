"""
Subscriptions that give bytes and are emptied by hand.

Each counts by the numbers of the publishers what was lost before it was taken.
"""

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
    """A raw subscription out of the wait set; profile: its QoS, by default that of data."""

    def __init__(self, node, topic, depth, profile=None):
        self.topic, self.gaps, self.dropped = topic.name, Gaps(), 0
        self._node, self._depth = node, depth
        self._group = NeverReady()
        self._class = qos.message_class(topic)
        self._subscribe(profile or qos.data_profile(depth))

    def _subscribe(self, profile):
        self.subscription = subscribe(self._node, self._class, self.topic, lambda data: None,
                                      profile, raw=True, callback_group=self._group)
        self._take = self.subscription.handle.take_message

    def read_best_effort(self):
        """Subscribe anew, so that a publisher that is no more than best effort is heard."""
        self._node.destroy_subscription(self.subscription)
        self._subscribe(qos.best_effort_profile(self._depth))

    def take(self):
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
        self._node, self.topic, self._depth = node, topic.name, depth
        self._class = qos.message_class(topic)
        self._subscribe(qos.data_profile(depth))

    def _subscribe(self, profile):
        self.subscription = subscribe(self._node, self._class, self.topic, self._wake, profile,
                                      raw=True)
        self._take = self.subscription.handle.take_message

    def read_best_effort(self):
        """Subscribe anew, as a HandQueue does."""
        self._node.destroy_subscription(self.subscription)
        self._subscribe(qos.best_effort_profile(self._depth))

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
