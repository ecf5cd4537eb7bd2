"""Subscriptions that give bytes and are emptied by hand."""

from rclpy.callback_groups import CallbackGroup

from . import qos


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
    """A raw subscription out of the wait set."""

    def __init__(self, node, topic, depth):
        self._group = NeverReady()
        self._class = qos.message_class(topic)
        self.subscription = node.create_subscription(
            self._class, topic.name, lambda data: None, qos.data(depth), raw=True,
            callback_group=self._group)
        self._take = self.subscription.handle.take_message

    def take(self):
        """Return the oldest message as bytes, or None."""
        taken = self._take(self._class, True)
        return None if taken is None else taken[0]


class DrivingQueue:
    """
    A raw subscription whose wake-up drains its queue.

    The executor's cycle costs more than a message, hence one cycle serves up to ``most`` of them;
    the bound lets timers and services run.  on_data(bytes) takes each message, on_drained() ends
    the wake-up.
    """

    def __init__(self, node, topic, depth, on_data, on_drained, most=50):
        self._on_data, self._on_drained, self._most = on_data, on_drained, most
        self._class = qos.message_class(topic)
        self.subscription = node.create_subscription(self._class, topic.name, self._wake,
                                                     qos.data(depth), raw=True)
        self._take = self.subscription.handle.take_message

    def _wake(self, data):
        self._on_data(data)
        for _ in range(self._most - 1):
            taken = self._take(self._class, True)
            if taken is None:
                break
            self._on_data(taken[0])
        self._on_drained()
