"""Node player: publish the messages of a bag, unchanged, by their log times or in lock-step."""

from array import array
from bisect import bisect_right
import time

from rclpy.exceptions import NameValidationException
from rclpy.node import Node

from ins_sim.bags import qos as bag_qos
from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader, SECOND, stamp_of
from ..lock_step.pacing import LockStep, Pace
from ..process.diagnostics import Monitor
from ..process.parameter_requests import answer_requests
from ..process.runtime import EXIT_CONSUMER, EXIT_FAULT
from ..recording.playing import ABSOLUTE, PlaybackStart, Playing
from ..recording.run_clock import JUMP_NS
from ..transport import qos
from ..transport.qos_overrides import advertise
from ..transport.backlog import HandQueue

SERVE_S = 0.01
SETTLE_S = 0.2
POLL_S = 2e-4
DEPTH = 2000
# Number of messages of a latched topic that a late joiner receives at most.
LATCHED_DEPTH = 1000
# A gap in the bag that takes longer than this to play is logged, s of wall time.
GAP_S = 10.0
# In lock-step without a rate, /clock jumps over gaps longer than this.
LEAP_NS = 10 * SECOND


class PlayerNode(Node):
    """Publishes the messages of a bag on the topics of the bag, in the namespace of the node."""

    NAME = 'player'

    def __init__(self, stop=None, path=None, options=None, **kwargs):
        super().__init__(self.NAME, **kwargs)
        answer_requests(self)
        self._options = options
        self._playing = playing = Playing(path, options)
        log = self.get_logger()
        if playing.bag.cut:
            log.warning(f'{path} is incomplete: {playing.bag.cut}')
        for name in playing.left_out:
            log.info(f'{name} is not played, because the player itself publishes or reads it')
        self._data_publishers, self._publish = [], {}
        for name, channel in list(playing.channels.items()):
            try:
                publisher = self._make_publisher(channel)
            except (ValueError, ImportError, AttributeError, NameValidationException) as error:
                why = ' '.join(str(error).split())
                if options.topics is not None or name == playing.driver:
                    raise ValueError(f'{name} cannot be played: {why}') from None
                log.warning(f'{name} is not played: {why}')
                del playing.channels[name]
            else:
                if name not in playing.runs:
                    self._data_publishers.append(publisher)
                self._publish[name] = publisher.publish
        if not self._publish:
            raise ValueError(f'no topic of {path} can be played')
        self._lock = None
        if options.required:
            self._lock = LockStep(options.required, options.window, options.timeout_s)
            self._acks, self._ack_reader = HandQueue(self, topics.ACK, qos.ACK_DEPTH), Reader(
                topics.HEADER)
        self._clock_publisher = None
        if options.clock_hz is not None:
            self._clock_publisher = qos.make_publisher(self, topics.CLOCK_TOPIC, DEPTH)
            self._clock_writer = topics.CLOCK_TOPIC.writer()
            self._tick_ns = max(1, round(SECOND / options.clock_hz * (options.rate or 1.0)))
        # The samples that the pace counts are nanoseconds of the bag.
        self._pace = Pace(options.rate, 1e-9)
        self._stamps, self._repeated = array('q'), []
        self.monitor = Monitor(self)

    def _make_publisher(self, channel):
        if channel.encoding != 'cdr':
            raise ValueError(f'messages are serialized as {channel.encoding!r}; expected cdr')
        name = channel.name if channel.name in ABSOLUTE else channel.name.lstrip('/')
        profile = qos.recorded_profile(bag_qos.read_profiles(channel.qos), DEPTH)
        if profile.durability == qos.LATCHING:
            profile.depth = min(max(1, self._playing.counts[channel.name]), LATCHED_DEPTH)
        return advertise(self, qos.message_class(topics.Topic(name, channel.type_name)), name,
                         profile)

    def run(self, executor, stop):
        """Play until the end or until stop is set."""
        self._executor, self._stop, self._served = executor, stop, 0.0
        for name, data in self._playing.announcements():
            self._send(name, data)
        if not self._lock:
            self._wait_readers()
        try:
            self._play()
            while self._options.loop and not stop:
                self.get_logger().info('begins again')
                self._play()
        except ValueError as error:
            self.monitor.fault(str(error), fatal=True)
            stop.request(EXIT_FAULT)
        stop.request()
        self._playing.close()
        self.get_logger().info(f'played {self.monitor.sent} messages on {len(self._publish)} '
                               'topics')

    def _wait_readers(self):
        """Wait until every topic has a reader, then a little until the readers know it too."""
        end = time.monotonic() + self._options.wait_s
        heard = False
        while not self._stop and (left_s := end - time.monotonic()) > 0.0:
            if not heard and all(p.get_subscription_count() for p in self._data_publishers):
                heard, end = True, min(end, time.monotonic() + SETTLE_S)
            self._serve(left_s)

    def _play(self):
        first_ns = self._playing.first_ns
        self._next_tick_ns, self._allowed_ns = first_ns, -1
        self._pace.anchor(0)
        messages = self._playing.messages()
        if self._lock:
            self._begin()
            messages = self._messages
        before_ns = first_ns
        for name, log_ns, data in messages:
            self._tell_gap(before_ns, log_ns)
            before_ns = log_ns
            if self._clock_publisher:
                self._tick(log_ns)
            if log_ns - first_ns > self._allowed_ns:
                self._wait_due(log_ns - first_ns)
            if self._lock and name == self._playing.driver:
                self._wait_answers(data)
            if self._stop:
                return
            self._send(name, data)
        if self._lock:
            self._wait_all_answered()

    def _tell_gap(self, before_ns, log_ns):
        """Log that a long gap in the bag is played in real time, and how to skip it."""
        wait_s = (log_ns - before_ns) / SECOND / self._options.rate if self._options.rate else 0.0
        if wait_s > GAP_S:
            begin_ns = self._playing.first_ns - round(self._options.start_s * SECOND)
            start_s = (log_ns - begin_ns) // 1_000_000 / 1000
            self.get_logger().warning(
                f'the bag has no message for {(log_ns - before_ns) / SECOND:.3f} s from '
                f'{before_ns / SECOND:.3f} s on: waiting {wait_s:.0f} s (--start {start_s:.3f} '
                'begins after the gap, --duration ends before it, --rate shortens it)')

    def _send(self, name, data):
        publish = self._publish.get(name)
        if publish is not None:
            publish(data)
            self.monitor.sent += 1
            if self.monitor.sent % 50 == 0:
                self._serve(0.0)

    def _wait_due(self, t_ns):
        """Wait until it is time to play a message logged t_ns after the first one."""
        while not self._stop:
            self._allowed_ns = self._pace.allowed() - 1
            if t_ns <= self._allowed_ns:
                return
            self._serve(self._pace.wait_s(t_ns))

    def _tick(self, log_ns):
        """Publish /clock up to a log time."""
        if not self._options.rate and log_ns - self._next_tick_ns > LEAP_NS:
            self._next_tick_ns = log_ns
        while self._next_tick_ns <= log_ns and not self._stop:
            self._wait_due(self._next_tick_ns - self._playing.first_ns)
            self._clock_publisher.publish(self._clock_writer.pack(self._next_tick_ns))
            self._next_tick_ns += self._tick_ns

    def _serve(self, wait_s):
        """Serve the callbacks of the node, at most every SERVE_S; otherwise sleep."""
        now = time.monotonic()
        if now - self._served > SERVE_S:
            self._executor.spin_once(timeout_sec=0.0)
            self._served = now
        elif wait_s > 0.0:
            time.sleep(min(wait_s, SERVE_S))

    def _begin(self):
        """Send the first sample repeatedly until all consumers have acknowledged it."""
        beginning = PlaybackStart(self._playing, stamp_of)
        for name, _, data in beginning.early:
            self._send(name, data)
        self._start_sample(beginning.stamp_ns)
        self._repeated = [(name, data) for name, _, data in beginning.repeated]
        for name, data in self._repeated:
            self._send(name, data)
        self._await(lambda: self._lock.slowest >= 0)
        held, rest = beginning.held, beginning.rest
        self._messages = (message for part in (held, rest) for message in part)

    def _start_sample(self, stamp_ns):
        self._lock.restart()
        self._stamps = array('q', [stamp_ns])

    def _wait_answers(self, data):
        """Wait until a sample of the driver may be sent."""
        stamp_ns = stamp_of(data)
        if stamp_ns is None:
            return
        if stamp_ns > self._stamps[-1]:
            self._await(lambda: self._lock.allowed() > len(self._stamps))
            self._stamps.append(stamp_ns)
        elif stamp_ns < self._stamps[-1]:
            # The stamps jump back: the consumers restart as well.
            self._wait_all_answered()
            self._start_sample(stamp_ns)
            self._repeated = []

    def _wait_all_answered(self):
        self._await(lambda: self._lock.done(len(self._stamps)))

    def _await(self, condition):
        """Take acknowledgements until the condition holds or a consumer is overdue."""
        lock = self._lock
        while not self._stop:
            self._take_acks()
            if condition():
                return
            late = lock.overdue(len(self._stamps))
            if late:
                self.monitor.fault(lock.complaint(late, 'the consumers of --lock-step'),
                                   fatal=True)
                self._stop.request(EXIT_CONSUMER)
            if lock.repeat_due(len(self._stamps)):
                for name, data in self._repeated:
                    self._send(name, data)
            self._serve(POLL_S if time.monotonic() - lock.moved < 0.05 else 10 * POLL_S)

    def _take_acks(self):
        for _ in range(qos.ACK_DEPTH):
            if (data := self._acks.take()) is None:
                return
            try:
                stamp_ns, _ = self._ack_reader.read(data)
                name = self._ack_reader.strings(data)[0]
            except ValueError as error:
                self.monitor.fault(f'{topics.ACK.name}: {error}; the message was dropped')
                continue
            if stamp_ns > self._stamps[-1] + JUMP_NS:
                # This acknowledges a sample from before the jump.
                continue
            # Because of sensor latency the acknowledged stamp may lie between two samples or
            # before the first.
            k = max(0, bisect_right(self._stamps, stamp_ns) - 1)
            self._lock.ack(name, k, len(self._stamps))
            self.monitor.received += 1
