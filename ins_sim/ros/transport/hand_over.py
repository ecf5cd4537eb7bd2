"""Pass messages between the nodes of one process in memory, in addition to publishing them."""

from ins_sim.messages import topics


class HandOver:
    """
    Connects the publishers and queues of the nodes of one process by topic name.

    A queue whose topic is published in this process receives the serialized messages within the
    call that publishes them. It has no subscription, so it does not receive messages from other
    processes. All other queues subscribe, as in separate processes.

    Each node has it as attribute ``hand_over``; call ``connect`` when all nodes are made.
    """

    def __init__(self):
        self._receivers, self._latched = {}, {}
        self._joining, self._patiences, self._drained = [], {}, []

    @staticmethod
    def serves(topic):
        """
        Return whether messages of a Topic are passed in memory.

        Topics with absolute names and acknowledgements are not: any node may publish them.
        """
        return not topic.name.startswith('/') and topic.name != topics.ACK.name

    def publisher(self, node, topic, publisher):
        """Return a publisher of a Topic that also passes the messages on in memory."""
        if not self.serves(topic):
            return publisher
        name = node.resolve_topic_name(topic.name)
        handing = HandingPublisher(publisher, self._receivers.setdefault(name, []))
        if topic.latched:
            self._latched[name] = handing
        return handing

    def join(self, node, topic, queue):
        """Register a queue; ``connect`` calls its ``accept(patience)`` or ``subscribe()``."""
        self._joining.append((node, topic, queue))

    def add_patience(self, node, patience):
        """Let a Patience continue as soon as a message for its node arrives."""
        self._patiences[node] = patience

    def add_drained(self, on_drained):
        """Register a function to be called after each burst of messages."""
        self._drained.append(on_drained)

    def connect(self):
        """Connect every queue to the publishers in this process, or else to DDS."""
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
        Let a function receive the serialized messages of a Topic, as a queue of a node does.

        Return whether the topic is published in this process.
        """
        receivers = self._receivers.get(node.resolve_topic_name(topic.name))
        if receivers is not None:
            receivers.append(receive)
        return receivers is not None

    def drained(self):
        """Signal the end of a burst of messages, so that the nodes acknowledge."""
        for on_drained in self._drained:
            on_drained()


class HandingPublisher:
    """
    Publisher of serialized messages that also calls the receivers in this process.

    ``last`` is the last message published.
    """

    def __init__(self, publisher, receivers):
        # Use the handle directly: publish() of rclpy locks it and checks the message type.
        self._publish = publisher.handle.publish_raw
        self._count = publisher.handle.get_subscription_count
        self._receivers = receivers
        self.last = None

    def publish(self, data):
        """Publish a message and pass it to the receivers."""
        self.last = data
        self._publish(data)
        for receive in self._receivers:
            receive(data)

    def get_subscription_count(self):
        """Return the number of readers: those in this process or, without any, those elsewhere."""
        return len(self._receivers) or self._count()
