"""Base class of nodes driven by a stream: parameters, faults, acknowledgements, reset."""

from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger

from ins_sim.core.streams.faults import StreamFault
from ins_sim.messages import topics
from ins_sim.messages.cdr import Writer
from ..process.announced import AnnouncedRun
from ..process.diagnostics import Monitor
from ..process.live_parameters import LiveParameters
from ..process.net import caught
from ..process.parameters import declare_settings
from ..process.publishers import MessageLosses, SolePublishers
from ..process.runtime import EXIT_FAULT, Stop
from ..process.told import told
from ..transport import qos
from ..transport.backlog import DrivingQueue, LINGER_S
from ..transport.broadcaster import Broadcaster
from ..transport.qos_overrides import subscribe


class StageNode(Node):
    """
    Base class of the nodes that process one input topic.

    All computation uses the time stamps of the messages, never a clock, so that a live run gives
    the same numbers as an offline one.

    A subclass defines

    * ``NAME``, ``SETTINGS`` (its settings class) and ``DRIVER`` (the input Topic);
    * ``make_stage()``, whose result has ``reset()`` and raises StreamFault on bad input;
    * ``on_message(data)``, called with the bytes of each input message;
    * ``change(settings)`` and ``effective_ns(name)`` if SETTINGS.SETTABLE is not empty, see
      ``LiveParameters``.

    Any other exception in a callback is reported as a fault, and the node restarts.

    Attributes
    ----------
    CHECKS_STAMPS : whether messages with stamps outside the announced run are refused
    TRUTH : Topic of the generator that the node reads
    """

    CHECKS_STAMPS = True
    TRUTH = topics.TRUTH_ODOMETRY

    def __init__(self, stop=None, hand_over=None, **kwargs):
        super().__init__(self.NAME, **kwargs)
        self.hand_over = hand_over
        self.stop = Stop() if stop is None else stop
        self.settings = declare_settings(self, self.SETTINGS)
        self.names = self.settings.frames.names()
        self.stage = self.make_stage()
        self.depth = self.settings.topics.depth
        self._stops = self.settings.on_fault == 'stop'
        self._ack = Writer(topics.HEADER, self.get_name())
        self._ack_publisher = qos.ack_publisher(self)
        self._last_stamp = self._seen_ns = None
        self.monitor = Monitor(self, self.DRIVER.name, max(2.0, 5.0 / self.settings.rate_hz))
        self._announced = self.make_announced()
        self.broadcaster = self.make_broadcaster()
        self.make_outputs()
        self.create_service(Trigger, '~/reset', self._on_reset)
        subscribe(self, String, topics.STATUS.name, self._on_status, qos.latched_profile())
        # Messages may be dropped as too old only while no node waits for acknowledgements.
        self._queue = DrivingQueue(self, self.DRIVER, self.depth, self.guarded(self._on_data),
                                   self.guarded(self.on_drained),
                                   self.nobody_waits,
                                   LINGER_S)
        queues = {self.DRIVER.name: self._queue, **self.hand_queues()}
        self.monitor.add(SolePublishers(self, {topics.RUN.name: None, **queues}).describe)
        self.monitor.add(MessageLosses(queues, self.depth).describe)
        if self.SETTINGS.SETTABLE:
            LiveParameters(self)
        self.get_logger().info(told(self.NAME, self.settings))

    def make_announced(self):
        """Return the AnnouncedRun of this node, or Unannounced."""
        return AnnouncedRun(self, self.TRUTH, self.depth, self._begin_announced, self._give_held)

    @property
    def knows_run(self):
        """Return whether the run and its epoch are known."""
        return self._announced.run is not None

    def nobody_waits(self):
        """Return whether no node waits for the acknowledgements of this node."""
        return not self._ack_publisher.get_subscription_count()

    def hand_queues(self):
        """Return {topic name: HandQueue} of the inputs other than the driving topic."""
        return {}

    def taken_of(self, queue):
        """Yield the messages of a HandQueue, at most its depth, so that the loop always ends."""
        for _ in range(self.depth):
            if self.stop or (data := queue.take()) is None:
                return
            yield data

    def guarded(self, callback):
        """Return the callback wrapped so that an exception is reported and restarts the node."""
        return caught(callback, self._rescue)

    def _rescue(self, sentence):
        self.fault(sentence)
        self.start_anew()

    def start_anew(self):
        """Discard all received data."""
        self.stage.reset()

    def check_change(self, settings):
        """Raise ValueError if new settings cannot be applied during a run."""

    def make_broadcaster(self):
        """Return the Broadcaster of the transforms that this node publishes."""
        return Broadcaster(self, self.settings)

    def _begin_announced(self, run):
        """Restart for a run with another epoch."""
        self.epoch_ns = run.epoch_ns
        self.start_anew()
        self.begin_announced()
        self.broadcaster.send_fixed(run.first_stamp_ns)

    def begin_announced(self):
        """Adapt to a new ``epoch_ns``; subclasses override this."""

    def _on_data(self, data):
        if not self.stop and not self._announced.holds(data):
            self.monitor.received += 1
            self.on_message(data)

    def _give_held(self, data):
        self._on_data(data)
        if self.hand_over is None:
            self.on_drained()
        else:
            # The message may have led to messages in other nodes of this process.
            self.hand_over.drained()

    def read(self, reader, data):
        """Return motion time (ns) and fields of a message; report a bad one and return None."""
        try:
            stamp_ns, *runs = reader.read(data)
            if self.CHECKS_STAMPS:
                self._announced.check(stamp_ns)
        except ValueError as error:
            self.fault(str(error))
            return None
        return (stamp_ns - self.epoch_ns, *runs)

    def push(self, push, sample):
        """
        Return the outputs of push(*sample).

        A StreamFault is reported; the stage is reset and the sample pushed again, or the node
        stops, according to ``on_fault``.
        """
        try:
            return push(*sample)
        except StreamFault as fault:
            self.fault(str(fault))
            if not fault.restart or self.stop:
                return []
        self.stage.reset()
        try:
            return push(*sample)
        except StreamFault as fault:
            self.fault(str(fault))
            return []

    def fault(self, sentence):
        """Report a fault; end the node if on_fault is ``stop``."""
        self.monitor.fault(sentence, fatal=self._stops)
        if self._stops:
            self.stop.request(EXIT_FAULT)

    def seen(self, t_ns):
        """Store the motion time (ns) up to which everything is processed, to acknowledge it."""
        self._seen_ns, self._last_stamp = t_ns, t_ns + self.epoch_ns

    def seen_so_far(self, t_ns):
        """Store, once, how far processing has come while later samples have to wait."""
        if t_ns is not None and t_ns != self._seen_ns:
            self.seen(t_ns)

    def on_drained(self):
        """Acknowledge what was processed; called once per burst of messages."""
        if self._last_stamp is not None:
            self._ack_publisher.publish(self._ack.pack(self._last_stamp))
            self._last_stamp = None

    def _on_status(self, message):
        # Do not report silence while the generator is paused or has finished.
        self.monitor.awaited = message.data == 'running'

    def _on_reset(self, request, response):
        self.start_anew()
        response.success, response.message = True, self.describe_reset()
        return response

    def describe_reset(self):
        """Return the answer to ~/reset."""
        return 'started anew'
