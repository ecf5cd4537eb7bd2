"""Record topics into a bag unchanged, and count messages, repetitions and losses."""

from dataclasses import dataclass
import time

from ins_sim.bags import qos as bag_qos
from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND, STAMP_END_NS, Writer
from ins_sim.messages.transforms import first_stamp
from ..transport import qos
from ..transport.backlog import HandQueue
from ..transport.gaps import Gaps
from ..transport.repairs import REPAIR_S
from .holes import Holes
from .run_clock import is_stamped, RunClock

BATCH = 200
FLUSH_S = 1.0
# Publishers that keep sending must not delay the end for longer than this, s.
FINISH_S = 2.0
NAP_S = 0.002
# Maximum number of messages without a stamp that wait for the first stamp of the run.
WAITING = 1000
# In lock-step the recorder acknowledges the first of these topics that it records.
ANSWERED = (topics.TRUTH_IMU, *topics.DATA)
# Topics that the generator sends with every sample; it ends when the last is acknowledged.
PACED = topics.TRUTH


@dataclass
class RecordedTopic:
    """A topic being recorded; ``repeated`` counts messages that were not written again."""

    name: str
    type_name: str
    queue: HandQueue
    gaps: Gaps
    stamped: bool
    seldom: bool
    holes: Holes
    count: int = 0
    repeated: int = 0
    unwritten: int = 0
    last: bytes = None
    last_ns: int = 0
    heard_ns: int = 0
    jumped: bool = False


class BagRecorder:
    """
    Writes the messages that a node receives into a bag.

    The owner calls ``poll`` until the end of the run, and closes the bag. A stamped message equal
    to the one before it is a sample repeated by lock-step and is written once.

    The stamps of the first topic of ANSWERED are acknowledged, but never later than the last
    stamp of each recorded topic of PACED. Acknowledgement starts when every stamped topic has
    been received (or, for topics.SELDOM, has a publisher) and ``settled`` is true; until then
    lock-step repeats sample 0.

    Parameters
    ----------
    node : Node with the subscriptions
    bag : BagWriter
    log_time : ``stamp`` or ``received`` (docs/design/bags.md)
    depth : depth of the subscriptions
    report : callable, called with a sentence about each fault, or None
    """

    def __init__(self, node, bag, log_time='stamp', depth=10000, report=None):
        self._node, self._bag, self._depth, self._report = node, bag, depth, report
        self._by_stamp = log_time == 'stamp'
        self._clock, self._waiting = RunClock(), []
        self.tracks = {}
        self._ack = Writer(topics.HEADER, node.get_name())
        self._ack_publisher = qos.ack_publisher(node)
        self._ack_name = node.resolve_topic_name(topics.ACK.name)
        self._answered, self._silent, self.settled = None, [], True
        self._first_ns, self._answered_ns, self._sent_ns, self._paced = None, None, None, []
        self._flushed = time.monotonic()

    def add(self, topic, profile=None, offered=None, definition=None, type_hash=''):
        """
        Subscribe to a Topic and declare it in the bag.

        Parameters
        ----------
        topic : Topic
        profile : QoS of the subscription, by default that of the topics of this package
        offered : QoS profiles of the publishers, in the YAML format of the bag
        definition, type_hash : see BagWriter.add_topic

        Returns
        -------
        RecordedTopic

        Raises
        ------
        ValueError : the type is unknown
        ImportError : the type is not installed
        """
        name = self._node.resolve_topic_name(topic.name)
        if topic.latched:
            profile = profile or qos.latched_profile()
        offered = offered or (bag_qos.LATCHED if topic.latched else bag_qos.RELIABLE)
        queue = HandQueue(self._node, topic, self._depth, profile)
        try:
            self._bag.add_topic(name, topic.type_name, offered, definition, type_hash)
        except BaseException:
            self._node.destroy_subscription(queue.subscription)
            raise
        seldom = self._is_one_of(name, topics.SELDOM)
        run = self._is_one_of(name, [topics.RUN])
        # Records of the velocity meter are DiagnosticArrays stamped with the time of the run,
        # unlike those on /diagnostics.
        by_stamp = is_stamped(topic.type_name) or run or self._is_one_of(
            name, [topics.METER_RECORD])
        track = RecordedTopic(name, topic.type_name, queue, Gaps(), by_stamp, seldom, Holes())
        self.tracks[name] = track
        # A run need not be announced, and a latched announcement cannot be missed.
        if (track.stamped or seldom) and name != self._ack_name and not run:
            self._silent.append(track)
        order = [self._node.resolve_topic_name(t.name) for t in ANSWERED]
        known = [n for n in order if n in self.tracks]
        self._answered = self.tracks[known[0]] if known else None
        paced = {self._node.resolve_topic_name(t.name) for t in PACED}
        self._paced = [t for n, t in self.tracks.items() if n in paced]
        return track

    def _is_one_of(self, name, wanted):
        """Return whether a resolved name is that of one of our Topics, of any vehicle."""
        return any(name == self._node.resolve_topic_name(topic.name)
                   or name.endswith(f'/{topic.name}') for topic in wanted)

    def subscribe_anew(self, track, profile):
        """Replace the subscription of a topic on which nothing has been received."""
        self._node.destroy_subscription(track.queue.subscription)
        track.queue = HandQueue(self._node, topics.Topic(track.name, track.type_name),
                                self._depth, profile)

    @property
    def counts(self):
        """Return {topic name: messages in the bag}."""
        return {name: track.count for name, track in self.tracks.items()}

    @property
    def length_s(self):
        """Return the time from the first to the last acknowledged message, s."""
        return 0.0 if self._answered_ns is None else (self._answered_ns - self._first_ns) / SECOND

    def poll(self):
        """Record the messages that have arrived; return their number."""
        taken = 0
        for track in self.tracks.values():
            take = track.queue.take_with_info
            for _ in range(BATCH):
                message = take()
                if message is None:
                    break
                self._on_message(track, *message)
                taken += 1
        self._acknowledge()
        if time.monotonic() - self._flushed > FLUSH_S:
            self._bag.flush()
            self._flushed = time.monotonic()
        return taken

    def _on_message(self, track, data, info):
        track.gaps.take(info['publication_sequence_number'])
        received_ns = info['received_timestamp'] or time.time_ns()
        if not track.stamped:
            self._take_unstamped(track, data, received_ns)
            return
        stamp_ns = self._clock.hear(data, received_ns)
        if track is self._answered and stamp_ns is not None:
            # Acknowledge a repeated sample too: the first acknowledgement may have been lost.
            self._answered_ns, self._sent_ns = stamp_ns, None
            self._first_ns = stamp_ns if self._first_ns is None else self._first_ns
        if stamp_ns is not None:
            track.heard_ns = stamp_ns
        if data == track.last:
            track.repeated += 1
            return
        track.last = data
        if stamp_ns is not None:
            track.holes.take(stamp_ns)
        if self._by_stamp and stamp_ns is not None:
            if stamp_ns < track.last_ns and not track.jumped:
                self._on_jump(track, stamp_ns)
            track.last_ns = stamp_ns
            self._write(track, stamp_ns, data)
            if self._waiting:
                self._write_waiting()
        else:
            self._write_unstamped(track, data, received_ns)

    def _take_unstamped(self, track, data, received_ns):
        stamp_ns = None
        if track.type_name == topics.TRANSFORMS and self._by_stamp:
            # /tf has many publishers, so its stamps are not sorted.
            if data == track.last:
                track.repeated += 1
                return
            track.last, stamp_ns = data, first_stamp(data)
        if stamp_ns is not None and 0 <= stamp_ns < STAMP_END_NS:
            self._write(track, stamp_ns, data)
        else:
            self._write_unstamped(track, data, received_ns)

    def _on_jump(self, track, stamp_ns):
        track.jumped = True
        if self._report is not None:
            self._report(f'{track.name} jumps back from {track.last_ns / SECOND:.9f} s to '
                         f'{stamp_ns / SECOND:.9f} s; the bag sorts its messages by these stamps '
                         '(record.log_time: received keeps the order of reception)')

    def _write(self, track, log_ns, data):
        self._bag.write(track.name, log_ns, data)
        track.count += 1

    def _write_unstamped(self, track, data, received_ns):
        log_ns = received_ns
        if self._by_stamp:
            log_ns = self._clock.now(received_ns)
            if log_ns is None and len(self._waiting) < WAITING and any(
                    t.stamped for t in self.tracks.values()):
                self._waiting.append((track, received_ns, data))
                return
        self._write(track, received_ns if log_ns is None else log_ns, data)

    def _write_waiting(self):
        """Write messages that waited for the first stamp, at that stamp or the time received."""
        for track, received_ns, data in self._waiting:
            log_ns = self._clock.now(received_ns)
            self._write(track, received_ns if log_ns is None else log_ns, data)
        self._waiting.clear()

    def _acknowledge(self):
        if self._silent:
            self._silent = [t for t in self._silent if t.last is None and not (
                t.seldom and t.queue.subscription.get_publisher_count())]
        if self._answered_ns is None or not self.settled or self._silent:
            return
        # Another topic of the same sample may still be in transit or being resent.
        stamp_ns = min([self._answered_ns, *(t.heard_ns for t in self._paced)])
        if stamp_ns != self._sent_ns:
            self._ack_publisher.publish(self._ack.pack(stamp_ns))
            self._sent_ns = stamp_ns

    def finish(self):
        """
        Record the messages in transit and in the queues; the bag stays open.

        Messages that cannot be written within FINISH_S are counted as ``unwritten``.
        """
        end_ns = time.time_ns() + round(REPAIR_S * SECOND)
        repaired = time.monotonic() + REPAIR_S
        while time.monotonic() < repaired:
            if not self.poll():
                time.sleep(NAP_S)
        while self.poll() and time.monotonic() < repaired + FINISH_S:
            pass
        self._write_waiting()
        for track in self.tracks.values():
            self._count_unwritten(track, end_ns)

    def _count_unwritten(self, track, end_ns):
        """Count the messages received before the end that are still in a queue."""
        for _ in range(self._depth):
            message = track.queue.take_with_info()
            if message is None or message[1]['received_timestamp'] > end_ns:
                return
            track.gaps.take(message[1]['publication_sequence_number'])
            track.unwritten += 1
