"""Subscriptions that give bytes and are emptied by hand."""

import time

from rclpy.callback_groups import CallbackGroup

from . import qos

TURN_S = 0.01
LINGER_S = 0.003
NAP_S = 5e-4
BATCH = 50


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
        self._group = NeverReady()
        self._class = qos.message_class(topic)
        self.subscription = node.create_subscription(
            self._class, topic.name, lambda data: None, profile or qos.data_profile(depth),
            raw=True,
            callback_group=self._group)
        self._take = self.subscription.handle.take_message

    def take(self):
        """Return the oldest message as bytes, or None."""
        taken = self._take(self._class, True)
        return None if taken is None else taken[0]

    def take_with_info(self):
        """Return the oldest message as bytes and what DDS notes of it, or None."""
        return self._take(self._class, True)


class DrivingQueue:
    """
    A raw subscription whose wake-up drains its queue.

    A cycle of the executor costs more than a message.  So a wake-up takes all there are, and
    with linger_s waits that long for the next one before it goes back to the executor; it does
    so after TURN_S in any case, for timers and services.  on_data(bytes) takes each message,
    on_drained() follows when the queue is empty and every BATCH messages.
    """

    def __init__(self, node, topic, depth, on_data, on_drained, linger_s=0.0):
        self._on_data, self._on_drained, self._linger_s = on_data, on_drained, linger_s
        self._class = qos.message_class(topic)
        self.subscription = node.create_subscription(self._class, topic.name, self._wake,
                                                     qos.data_profile(depth), raw=True)
        self._take = self.subscription.handle.take_message

    def _wake(self, data):
        now = time.monotonic()
        turn_end, linger_end = now + TURN_S, now + self._linger_s
        self._on_data(data)
        count = 1
        while now < turn_end:
            taken = self._take(self._class, True)
            now = time.monotonic()
            if taken is not None:
                self._on_data(taken[0])
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
