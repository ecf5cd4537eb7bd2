"""Receive the announcement of the run on sim/run; earlier messages wait until it is known."""

from collections import deque
import time

from ins_sim.core.numerics.instants import seconds
from ins_sim.messages import topics
from ins_sim.messages.run_announcement import read_announcement, UNANNOUNCED
from ..transport import qos
from ..transport.patience import MISSING_S
from ..transport.qos_overrides import subscribe

# How long to wait for an announcement whose publisher is known: a busy machine may be slow, s.
PATIENCE_S = 30.0
# IMU samples may be stamped later than the truth by their latency, ns.
LATER_NS = 10_000_000_000


class Unannounced:
    """Replaces AnnouncedRun in a node that needs no announced run: motion time is the stamp."""

    run = UNANNOUNCED

    def holds(self, data):
        """Return False: no message has to wait."""
        return False


class AnnouncedRun:
    """
    Epoch and end of the run, as announced by the generator.

    If no run is announced, as with a recorded or a real IMU, motion time is the stamp. A generator
    creates its publisher of sim/run before all others; if the truth is discovered without a
    publisher of sim/run, there is no announcement to wait for.

    Parameters
    ----------
    node : Node with a ``monitor`` and ``guarded``
    truth : Topic of the generator that the node reads
    depth : maximum number of messages that wait for the announcement
    begin : callable
        Called with the first RunAnnouncement, and with each one that has another epoch.
    give : callable
        Called with each message that had to wait.
    """

    def __init__(self, node, truth, depth, begin, give):
        self._node, self._truth, self._begin, self._give = node, truth, begin, give
        self._held, self._dropped, self._since = deque(), 0, None
        self._depth, self.run = depth, None
        hand_over = qos.hand_over_of(node)
        if hand_over is None:
            self.subscribe()
        else:
            hand_over.join(node, topics.RUN, self)

    def subscribe(self):
        """Subscribe to the announcements."""
        subscribe(self._node, qos.message_class(topics.RUN), topics.RUN.name,
                  self._node.guarded(self.take), qos.latched_profile(), raw=True)

    def accept(self, patience):
        """Return the function that receives announcements of a node in this process."""
        return self._node.guarded(self.take)

    def holds(self, data):
        """Return whether a message has to wait for the announcement; if so, store it."""
        if self.run is not None:
            return False
        now = time.monotonic()
        self._since = now if self._since is None else self._since
        if self._may_come(now - self._since):
            if len(self._held) < self._depth:
                self._held.append(data)
            else:
                self._dropped += 1
            return True
        self._settle(UNANNOUNCED)
        return False

    def _may_come(self, waited_s):
        """Return whether an announcement may still arrive; log if the node stops waiting."""
        node = self._node
        known, truth = (node.count_publishers(node.resolve_topic_name(topic.name))
                        for topic in (topics.RUN, self._truth))
        # Without either publisher wait too: the sensor may have discovered the generator earlier.
        if waited_s < (PATIENCE_S if known else 0.0 if truth else MISSING_S):
            return True
        if known:
            node.monitor.fault(f'no message on {topics.RUN.name} in {PATIENCE_S:g} s, though it '
                               'has a publisher; expected the announcement of the run: motion '
                               'time is the stamp of the messages')
        else:
            node.get_logger().info(f'no node announces a run on {topics.RUN.name}: motion time is '
                                   'the stamp of the messages')
        return False

    def take(self, data):
        """Process a message of sim/run."""
        try:
            run = read_announcement(bytes(data))
        except ValueError as error:
            self._node.monitor.fault(f'{error}; the message was dropped')
            return
        before = self.run
        if before is not None and run.epoch_ns != before.epoch_ns:
            self._node.monitor.fault(
                f'{topics.RUN.name} announces a run with the epoch {seconds(run.epoch_ns)} after '
                f'{seconds(before.epoch_ns)}; expected one generator: restarting with the new '
                'epoch')
        self._settle(run)

    def _settle(self, run):
        before, self.run = self.run, run
        if before is None or run.epoch_ns != before.epoch_ns:
            self._begin(run)
        if self._dropped:
            self._node.monitor.fault(f'{self._dropped} messages were dropped, because more than '
                                     f'topics.depth waited for {topics.RUN.name}')
        held, self._held, self._dropped = self._held, deque(), 0
        for data in held:
            self._give(data)

    def check(self, stamp_ns):
        """Raise ValueError for a stamp outside the announced run, ns."""
        run = self.run
        first_ns, end_ns = run.epoch_ns, run.epoch_ns + run.end_ns + LATER_NS
        if not first_ns <= stamp_ns <= end_ns:
            late = stamp_ns > end_ns
            raise ValueError(
                f'a message has the stamp {seconds(stamp_ns)}, '
                f'{seconds(stamp_ns - end_ns if late else first_ns - stamp_ns)} '
                f'{"after the end" if late else "before the epoch"} of the run announced on '
                f'{topics.RUN.name}, {seconds(end_ns if late else first_ns)}; expected a stamp '
                'within that run, from one generator; the message was dropped')
