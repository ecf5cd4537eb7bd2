"""What the nodes that follow a stream share: parameters, faults, acknowledgements, reset."""

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
    A node driven by one topic, which reads no clock and computes from the messages alone.

    A subclass sets NAME, SETTINGS and DRIVER, makes ``self.stage`` with ``reset()`` and whose
    pushes raise StreamFault, and has ``on_message(bytes)``.  What a callback raises beside that
    is a fault too, after which the node starts anew.  CHECKS_STAMPS: whether stamps outside the
    announced run are refused; TRUTH: what the node reads of the generator.  Where the SETTINGS
    have SETTABLE ones, the node has ``change(settings)`` and ``effective_ns(name)``, as a part of
    LiveParameters.
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
        # whoever waits for an answer waits for every one of them: only then nothing may be lost
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
        """Return the AnnouncedRun, or Unannounced."""
        return AnnouncedRun(self, self.TRUTH, self.depth, self._begin_announced, self._give_held)

    @property
    def knows_run(self):
        """Return whether the run, and so its epoch, is known."""
        return self._announced.run is not None

    def nobody_waits(self):
        """Return whether nobody waits for the acknowledgements of this node."""
        return not self._ack_publisher.get_subscription_count()

    def hand_queues(self):
        """Return {topic name: HandQueue} of what is taken beside the driver."""
        return {}

    def taken_of(self, queue):
        """Yield the messages of a HandQueue, no more than it may have held: never for ever."""
        for _ in range(self.depth):
            if self.stop or (data := queue.take()) is None:
                return
            yield data

    def guarded(self, callback):
        """Return a callback that raises nothing: an exception is a fault, after it all is new."""
        return caught(callback, self._rescue)

    def _rescue(self, sentence):
        self.fault(sentence)
        self.start_anew()

    def start_anew(self):
        """Forget all that has come."""
        self.stage.reset()

    def check_change(self, settings):
        """Raise ValueError on new settings that cannot be taken amid a run."""

    def make_broadcaster(self):
        """Return the Broadcaster of what the node places."""
        return Broadcaster(self, self.settings)

    def _begin_announced(self, run):
        """Follow a run of another epoch from its begin."""
        self.epoch_ns = run.epoch_ns
        self.start_anew()
        self.begin_announced()
        self.broadcaster.send_fixed(run.first_stamp_ns)

    def begin_announced(self):
        """Take note of another epoch_ns."""

    def _on_data(self, data):
        if not self.stop and not self._announced.holds(data):
            self.monitor.received += 1
            self.on_message(data)

    def _give_held(self, data):
        self._on_data(data)
        if self.hand_over is None:
            self.on_drained()
        else:
            # what it led to may be in the other nodes of this process
            self.hand_over.drained()

    def read(self, reader, data):
        """Return motion time and runs of a message, or None after reporting that it is bad."""
        try:
            stamp_ns, *runs = reader.read(data)
            if self.CHECKS_STAMPS:
                self._announced.check(stamp_ns)
        except ValueError as error:
            self.fault(str(error))
            return None
        return (stamp_ns - self.epoch_ns, *runs)

    def push(self, push, sample):
        """Return the outputs of a push; report a fault, start anew or stop, as on_fault says."""
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
        """Report a fault; end the node if on_fault says so."""
        self.monitor.fault(sentence, fatal=self._stops)
        if self._stops:
            self.stop.request(EXIT_FAULT)

    def seen(self, t_ns):
        """Remember the motion time up to which all is done, for the acknowledgement."""
        self._seen_ns, self._last_stamp = t_ns, t_ns + self.epoch_ns

    def seen_so_far(self, t_ns):
        """Remember, once, up to where all is done while what comes behind has to wait."""
        if t_ns is not None and t_ns != self._seen_ns:
            self.seen(t_ns)

    def on_drained(self):
        """Acknowledge once a wake-up."""
        if self._last_stamp is not None:
            self._ack_publisher.publish(self._ack.pack(self._last_stamp))
            self._last_stamp = None

    def _on_status(self, message):
        # silence of a generator that has paused or finished is no fault
        self.monitor.awaited = message.data == 'running'

    def _on_reset(self, request, response):
        self.start_anew()
        response.success, response.message = True, self.describe_reset()
        return response

    def describe_reset(self):
        """Return the answer to ~/reset."""
        return 'started anew'
