"""Messages between the nodes of one process: handed over in memory, beside their publication."""

from ins_sim.messages import topics


class HandOver:
    """
    Joins the publishers and the queues of the nodes of one process, by the names of the topics.

    A queue whose topic is published in this process gets the bytes of its messages at once, in
    the call that publishes them, and has no subscription: it hears nobody else.  All other queues
    subscribe, as they do in a process of their own.

    The nodes have it as their attribute ``hand_over``; ``connect`` follows when all are made.
    """

    def __init__(self):
        self._receivers, self._latched = {}, {}
        self._joining, self._patiences, self._drained = [], {}, []

    @staticmethod
    def serves(topic):
        """
        Return whether messages of a Topic are handed over.

        Those of the whole graph (an absolute name) and the acknowledgements come from any node,
        and are heard from all of them.
        """
        return not topic.name.startswith('/') and topic.name != topics.ACK.name

    def publisher(self, node, topic, publisher):
        """Return what publishes a Topic with a publisher of a node, and hands it over."""
        if not self.serves(topic):
            return publisher
        name = node.resolve_topic_name(topic.name)
        handing = HandingPublisher(publisher, self._receivers.setdefault(name, []))
        if topic.latched:
            self._latched[name] = handing
        return handing

    def join(self, node, topic, queue):
        """Let a queue of a node be connected: ``accept(patience)`` or ``subscribe()``."""
        self._joining.append((node, topic, queue))

    def add_patience(self, node, patience):
        """Let a Patience go on at once when something comes for its node."""
        self._patiences[node] = patience

    def add_drained(self, on_drained):
        """Call a function whenever a burst of messages is over."""
        self._drained.append(on_drained)

    def connect(self):
        """Connect every queue to the publishers here, or else to DDS."""
        for node, topic, queue in self._joining:
            receivers = self._receivers.get(node.resolve_topic_name(topic.name))
            if receivers is None:
                queue.subscribe()
            else:
                receivers.append(queue.accept(self._patiences.get(node)))
                latched = self._latched.get(node.resolve_topic_name(topic.name))
                if latched is not None and latched.last is not None:
                    receivers[-1](latched.last)
        self._joining.clear()

    def listen(self, node, topic, receive):
        """
        Let a function receive the bytes of a Topic, as a queue of a node does.

        Return whether it is published here.
        """
        receivers = self._receivers.get(node.resolve_topic_name(topic.name))
        if receivers is not None:
            receivers.append(receive)
        return receivers is not None

    def drained(self):
        """Say that a burst of messages is over: the nodes acknowledge."""
        for on_drained in self._drained:
            on_drained()


class HandingPublisher:
    """A publisher of bytes that gives them to receivers in this process as well; last: of them."""

    def __init__(self, publisher, receivers):
        # The handle itself: rclpy locks it for each call, and looks what kind of message it is.
        self._publish = publisher.handle.publish_raw
        self._count = publisher.handle.get_subscription_count
        self._receivers = receivers
        self.last = None

    def publish(self, data):
        """Publish a message and hand it over."""
        self.last = data
        self._publish(data)
        for receive in self._receivers:
            receive(data)

    def get_subscription_count(self):
        """Return how many read it, here and elsewhere."""
        return len(self._receivers) or self._count()
