"""Node motion_generator: publish the truth of a motion; this node sets the pace of a run."""

import math
import time

from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

from ins_sim.core.numerics.instants import seconds
from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader
from ins_sim.messages.placements import TRUTH_MOVES
from ins_sim.settings.motion import MotionGeneratorSettings
from ..lock_step.pacing import LivePace, LockStep
from ..lock_step.standard_services import offer_standard_services
from ..lock_step.steerer import Steerer
from ..lock_step.truth_source import STAMP_END_S, TruthSource
from ..process.diagnostics import Monitor
from ..process.live_parameters import LiveParameters
from ..process.parameters import declare_settings
from ..process.publishers import MessageLosses, SolePublishers
from ..process.runtime import EXIT_CONSUMER
from ..process.serving import serve_ready
from ..process.told import clock_needed, told
from ..transport import qos
from ..transport.backlog import HandQueue
from ..transport.broadcaster import Broadcaster
from ..transport.qos_overrides import advertise

SERVE_S = 0.01
POLL_S = 2e-4
# Serving callbacks may use 1/SHARE of the time, with pauses of at most REST_S in between.
SHARE, REST_S = 30.0, 0.2
BURST = 50
CLOCK_HZ = 100.0


class MotionGeneratorNode(Node):
    """
    Publishes truth/*, /tf, /clock, sim/run, sim/status, paced by the wall clock or by sim/ack.

    A guided motion is steered by the Odometry on guidance.topic; see also guidance/command.
    """

    NAME = 'motion_generator'

    def __init__(self, stop=None, hand_over=None, **kwargs):
        super().__init__(self.NAME, **kwargs)
        self.hand_over, self._stop = hand_over, stop
        self.settings = declare_settings(self, MotionGeneratorSettings)
        pacing, depth = self.settings.pacing, self.settings.topics.depth
        self._source = TruthSource(self.settings)
        # Created first: a node that has discovered the truth then knows that a run is announced.
        self._announcements = qos.make_publisher(self, topics.RUN, depth)
        self._announcements.publish(self._source.announcement.pack())
        self._lock = None
        self._pace = LivePace(pacing, self._source, lambda: self._next, self._tell_time)
        if pacing.waits:
            self._lock = LockStep(pacing.required, pacing.window, pacing.timeout_s)
            self._acks, self._ack_reader = HandQueue(self, topics.ACK, qos.ACK_DEPTH), Reader(
                topics.HEADER)
        self._truth_publishers = [qos.make_publisher(self, topic, depth) for topic in topics.TRUTH]
        self.monitor = Monitor(self)
        self._publish = [p.publish for p in self._truth_publishers]
        self.broadcaster = Broadcaster(self, self.settings, TRUTH_MOVES)
        if self.broadcaster.publish is not None:
            self._publish.append(self.broadcaster.publish)
        self._clock_every = 0
        if self.settings.publish_clock:
            self._clock_every = math.ceil(self.settings.rate_hz / CLOCK_HZ)
            self._clock_publisher = qos.make_publisher(self, topics.CLOCK_TOPIC, depth)
            self._clock_writer = topics.CLOCK_TOPIC.writer()
        self._status = advertise(self, String, topics.STATUS.name, qos.latched_profile())
        self._queues, self._steerer = {}, None
        if self._source.guided:
            self._make_steerer()
        alone = [topics.TRUTH_IMU, *([topics.CLOCK_TOPIC] if self._clock_every else ())]
        self.monitor.add(SolePublishers(self, {**{topic.name: None for topic in alone},
                                               **self._queues}).describe)
        self.create_service(SetBool, '~/pause', self._on_pause)
        self.create_service(Trigger, '~/step', self._on_step)
        self.create_service(Trigger, '~/reset', self._on_reset)
        offer_standard_services(self)
        self._paused, self._single, self._next = False, 0, 0
        LiveParameters(self, self._pace)
        self.get_logger().info(f'{told(self.NAME, self.settings)}; the first stamp is '
                               f'{seconds(self._source.stamp_ns(0))}')

    def _make_steerer(self):
        name, depth = self.settings.guidance.topic, self.settings.topics.depth
        queue = HandQueue(self, topics.Topic(name, topics.ODOMETRY), depth)
        self._queues[name] = queue
        publisher = qos.make_publisher(self, topics.GUIDANCE_COMMAND, depth)
        self._steerer = Steerer(self.settings, self._source, queue, publisher.publish,
                                self.monitor.fault)
        self.monitor.add(self._steerer.describe)
        self.monitor.add(MessageLosses(self._queues, depth).describe)
        self.create_service(SetBool, '~/engage', self._on_engage)

    def hand_queues(self):
        """Return {topic name: HandQueue} of the steering solution, empty for other motions."""
        return self._queues

    def run(self, executor, stop):
        """Publish until the end or until stop is set."""
        self._announce('running')
        if not self._lock and not self._truth_publishers[-1].get_subscription_count():
            self.get_logger().warning(
                f'no reader on {topics.TRUTH_IMU.name} yet; samples are lost until one joins '
                '(pacing.lock_step: true waits for the consumers and loses none)')
        self._tell_time()
        self._pace.anchor(0)
        serve_s = 0.0
        while not stop:
            wait_s = self._advance(stop)
            now = time.monotonic()
            if now > serve_s:
                serve_ready(executor)
                served = time.monotonic()
                # If serving is slow on this machine, serve less often.
                serve_s = served + min(REST_S, max(SERVE_S, SHARE * (served - now)))
            elif wait_s > 0.0:
                time.sleep(min(wait_s, SERVE_S))

    def _tell_time(self):
        """Log what other nodes need if the stamps do not follow the wall clock."""
        if sentence := clock_needed(self.settings):
            self.get_logger().info(sentence)

    def _advance(self, stop):
        """Publish the samples that are due; return the time until the next one, s."""
        if self.monitor.state == 'finished':
            return SERVE_S
        lock, source = self._lock, self._source
        allowed = self._pace.allowed() if not self._paused else self._next + self._single
        if lock:
            self._take_acks()
            allowed = min(allowed, lock.allowed())
            late = lock.overdue(self._next)
            if late and not self._paused:
                self.monitor.fault(lock.complaint(late, 'the consumers of pacing.required'),
                                   fatal=True)
                stop.request(EXIT_CONSUMER)
            if lock.repeat_due(self._next, self._steerer is None or self._steerer.heard):
                self._send(0)
                self._drained()
        if self._next >= source.count:
            if not lock or lock.done(source.count):
                self._finish(stop)
            return POLL_S
        allowed = min(allowed, source.count)
        if self._steerer:
            allowed = self._steerer.reach(self._next, allowed, waits=lock is not None)
        if self._next >= allowed:
            due_s = self._pace.wait_s(self._next)
            quiet = lock is None or self._paused or time.monotonic() - lock.moved > 0.05
            return max(due_s, 10 * POLL_S if quiet else POLL_S) if lock or self._paused else due_s
        for _ in range(self._next, min(allowed, self._next + BURST)):
            self._send_next()
        self._drained()
        return 0.0

    def step(self):
        """
        Send the next sample without waiting for acknowledgements; return its stamp, ns, or None.

        The node whose solution steers a guided motion must be in this process. None: end of run.
        """
        k = self._next
        if k == 0:
            # Announce a pause, so that other nodes do not report the silence between two steps.
            self._announce('paused')
        if k >= self._source.count:
            self._announce('finished')
            return None
        if self._steerer:
            while self._steerer.reach(k, k + 1, waits=True) <= k:
                time.sleep(POLL_S)
        self._send_next()
        return self._source.stamp_ns(k)

    def repeat_first(self):
        """Send sample 0 again, for a consumer that has joined since."""
        self._send(0)

    def _drained(self):
        """Let the other nodes of this process acknowledge the samples they have processed."""
        if self.hand_over is not None:
            self.hand_over.drained()

    def _send_next(self):
        self._send(self._next)
        self._next += 1
        self._single = max(0, self._single - 1)

    def _send(self, k):
        if self._clock_every and k % self._clock_every == 0:
            self._clock_publisher.publish(self._clock_writer.pack(self._source.stamp_ns(k)))
        for publish, message in zip(self._publish, self._source.messages(k)):
            publish(message)
        self.monitor.sent += 1

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
            k = (stamp_ns - self._source.stamp_ns(0)) // self._source.dt_ns
            self._lock.ack(name, k, self._next)
            self.monitor.received += 1

    def _announce(self, state):
        self.monitor.state = state
        self._status.publish(String(data=state))

    def _finish(self, stop):
        self._announce('finished')
        self.get_logger().info(f'finished after {self._next} samples')
        if self._source.endless:
            self.get_logger().warning(
                f'the run has reached the largest stamp of ROS, {STAMP_END_S} s (2038-01-19, '
                'counted from 1970), and ends; expected an earlier time.epoch_s for a longer run')
        if self.settings.exit_at_end:
            stop.request()

    def pause(self, on):
        """Pause (``on`` true) or resume the run."""
        self._paused = on
        self._restart_clocks()
        if self.monitor.state != 'finished':
            self._announce('paused' if on else 'running')

    def reset(self):
        """Go back to sample 0."""
        self._next = self._single = 0
        if self._steerer:
            self._steerer.restart()
        if self._lock:
            self._lock.restart()
        self._restart_clocks()
        self._announce('paused' if self._paused else 'running')

    def send(self, steps):
        """
        Send ``steps`` samples while paused; return how many were sent.

        Fewer are sent at the end of the run, or if a consumer is silent for pacing.timeout_s.
        """
        first, moved = self._next, time.monotonic()
        self._single = steps
        self._restart_clocks()
        while self._single and self.monitor.state == 'paused' and not self._stop:
            before, wait_s = self._next, self._advance(self._stop)
            if self._next > before:
                moved = time.monotonic()
            elif time.monotonic() - moved > self.settings.pacing.timeout_s:
                break
            time.sleep(max(0.0, min(wait_s, SERVE_S)))
        self._single = 0
        return self._next - first

    def end(self):
        """End the process."""
        self._stop.request()

    def _on_pause(self, request, response):
        self.pause(request.data)
        response.success, response.message = True, self.monitor.state
        return response

    def _on_step(self, request, response):
        response.success = self._paused and self.monitor.state != 'finished'
        response.message = f'sample {self._next}' if response.success else \
            f'{self.monitor.state}; expected paused'
        self._single += response.success
        return response

    def _on_engage(self, request, response):
        response.success, response.message = True, self._steerer.engage(request.data)
        self.get_logger().info(response.message)
        return response

    def _on_reset(self, request, response):
        self.reset()
        response.success, response.message = True, 'back at sample 0'
        return response

    def _restart_clocks(self):
        self._pace.anchor(self._next)
        if self._steerer:
            self._steerer.wait_anew()
        if self._lock:
            self._lock.moved = time.monotonic()
