"""What the nodes that follow a stream share: parameters, faults, acknowledgements, reset."""

from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger

from ins_sim.core.numerics.instants import seconds
from ins_sim.core.streams.faults import StreamFault
from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND, Writer
from ..process.diagnostics import Monitor
from ..process.net import caught
from ..process.parameters import declare_settings
from ..process.publishers import MessageLosses, SolePublishers
from ..process.runtime import EXIT_FAULT, Stop
from ..transport import qos
from ..transport.backlog import DrivingQueue, LINGER_S


class StageNode(Node):
    """
    A node driven by one topic, which reads no clock and computes from the messages alone.

    A subclass sets NAME, SETTINGS and DRIVER, makes ``self.stage`` with ``reset()`` and whose
    pushes raise StreamFault, and has ``on_message(bytes)``.  What a callback raises beside that
    is a fault too, after which the node starts anew.  FIRST_NS: the earliest motion time.
    """

    FIRST_NS = 0

    def __init__(self, stop=None, hand_over=None, **kwargs):
        super().__init__(self.NAME, **kwargs)
        self.hand_over = hand_over
        self.stop = Stop() if stop is None else stop
        self.settings = declare_settings(self, self.SETTINGS)
        self.epoch_ns = self.settings.time.epoch_s * SECOND
        self.stage = self.make_stage()
        self.depth = self.settings.topics.depth
        self._stops = self.settings.on_fault == 'stop'
        self._ack = Writer(topics.HEADER, self.get_name())
        self._ack_publisher = qos.ack_publisher(self)
        self._last_stamp = self._seen_ns = None
        self.monitor = Monitor(self, self.DRIVER.name, max(2.0, 5.0 / self.settings.rate_hz))
        self.make_outputs()
        self.create_service(Trigger, '~/reset', self._on_reset)
        self.create_subscription(String, topics.STATUS.name, self._on_status,
                                 qos.latched_profile())
        # whoever waits for an answer waits for every one of them: only then nothing may be lost
        self._queue = DrivingQueue(self, self.DRIVER, self.depth, self.guarded(self._on_data),
                                   self.guarded(self.on_drained),
                                   lambda: not self._ack_publisher.get_subscription_count(),
                                   LINGER_S)
        queues = {self.DRIVER.name: self._queue, **self.hand_queues()}
        self.monitor.add(SolePublishers(self, queues).describe)
        self.monitor.add(MessageLosses(queues, self.depth).describe)

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

    def _on_data(self, data):
        if not self.stop:
            self.monitor.received += 1
            self.on_message(data)

    def read(self, reader, data):
        """Return motion time and runs of a message, or None after reporting that it is bad."""
        try:
            stamp_ns, *runs = reader.read(data)
        except ValueError as error:
            self.fault(str(error))
            return None
        t_ns = stamp_ns - self.epoch_ns
        if t_ns < self.FIRST_NS:
            self.fault(f'a message has the stamp {seconds(stamp_ns)}, {seconds(-t_ns)} before '
                       f'time.epoch_s {self.settings.time.epoch_s}; expected none before it: '
                       'time.epoch_s must be the same in all nodes; the message was dropped')
            return None
        return (t_ns, *runs)

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
        response.success, response.message = True, 'started anew'
        return response
