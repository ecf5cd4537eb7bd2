"""Node truth_adapter: convert the odometry of another simulator to truth messages."""

from std_msgs.msg import String

from ins_sim.core.streams.adapter.stage import TruthAdapter
from ins_sim.core.timeseries.bounds import LATEST_NS
from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader
from ins_sim.messages.convert import truth_one
from ins_sim.messages.placements import TRUTH_MOVES
from ins_sim.messages.plausible import PlausibleReader
from ins_sim.messages.run_announcement import RunAnnouncement
from ins_sim.messages.world_frames import WorldFrames
from ins_sim.settings.truth_adapter import TruthAdapterSettings
from ..lock_step.release import Release
from ..process.publishers import SolePublishers
from ..process.runtime import EXIT_CONSUMER
from ..transport import qos
from ..transport.backlog import HandQueue
from ..transport.broadcaster import Broadcaster
from ..transport.qos_overrides import advertise
from ..transport.wall_timer import wall_timer
from .stage import StageNode

LOOK_S = 0.005


class TruthAdapterNode(StageNode):
    """
    Subscribes to odom; publishes truth/*, sim/run and sim/status.

    It replaces motion_generator: the truth has the stamps of the input, and the announced run has
    the epoch zero. The pace is that of the input and, in lock-step, of the acknowledgements on
    sim/ack. docs/design/other_simulators.md describes how it and the simulator wait for each
    other.
    """

    NAME = 'truth_adapter'
    SETTINGS = TruthAdapterSettings
    DRIVER = topics.OTHER_ODOMETRY

    def make_stage(self):
        """Return the adapter that computes the truth."""
        return TruthAdapter(self.settings, topics.OTHER_ODOMETRY.name)

    def make_broadcaster(self):
        """Return the Broadcaster of map -> base_link."""
        return Broadcaster(self, self.settings, TRUTH_MOVES)

    def make_outputs(self):
        """Make publishers, readers and writers, and in lock-step the queue of sim/ack."""
        # Created before the truth publishers: a node that has discovered the truth can then rely
        # on discovering the announcement as well.
        announcement = RunAnnouncement(0, 0, self.settings.truth_hz, LATEST_NS).pack()
        qos.make_publisher(self, topics.RUN, self.depth).publish(announcement)
        name, pacing = topics.OTHER_ODOMETRY.name, self.settings.pacing
        self._reader = PlausibleReader(topics.OTHER_ODOMETRY, ((0, 3), (3, 7), (43, 46), (46, 49)))
        self._frames = WorldFrames(name)
        self._packs = [topic.named(self.names).writer().pack for topic in topics.TRUTH]
        self._publish = [qos.make_publisher(self, topic, self.depth).publish
                         for topic in topics.TRUTH]
        self._release = Release(pacing, self._send, self.seen)
        self._acks = None
        if pacing.waits:
            self._acks = HandQueue(self, topics.ACK, qos.ACK_DEPTH)
            self._ack_reader = Reader(topics.HEADER)
            wall_timer(self, LOOK_S, self.guarded(self._look))
        self.monitor.add(SolePublishers(self, {topics.TRUTH_IMU.name: None}).describe)
        self.monitor.add(self._describe)
        status = advertise(self, String, topics.STATUS.name, qos.latched_profile())
        status.publish(String(data='running'))
        self._announced.take(announcement)

    def start_anew(self):
        """Discard all received data and what was learned about the input."""
        self._release.clear()
        self._frames.forget()
        self.stage.begin()

    def on_message(self, data):
        """Process one odometry message, and send the truth that it completes."""
        sample = self.read(self._reader, data)
        if sample is None:
            return
        try:
            note = self._frames.check(data)
        except ValueError as error:
            self.fault(str(error))
            return
        if note:
            self.get_logger().info(note)
        if len(self._release) > self.depth:
            self.fault(f'{len(self._release)} samples wait for the consumers of pacing.required '
                       f'to answer; expected at most topics.depth: {topics.OTHER_ODOMETRY.name} '
                       'must wait for the acknowledgements of truth_adapter, or be slower')
            self._release.clear()
            self.stage.reset()
        for truth in self.push(self.stage.push, sample):
            stamp_ns = truth.t_ns + self.epoch_ns
            values = truth_one(truth)
            messages = [pack(stamp_ns, *runs) for pack, runs in zip(self._packs, values)]
            self._release.add(stamp_ns, (messages, stamp_ns, values[0][0]))
        while self.stage.notes:
            self.get_logger().info(self.stage.notes.pop(0))
        self._release.finish(sample[0])

    def _send(self, sample):
        messages, stamp_ns, pose = sample
        for publish, message in zip(self._publish, messages):
            publish(message)
        self.broadcaster.send(stamp_ns, pose)
        self.monitor.sent += 1

    def on_drained(self):
        """Process acknowledgements, send the samples that are due, and acknowledge the input."""
        if self._acks is not None:
            self._take_acks()
            self._release.advance()
        super().on_drained()

    def _take_acks(self):
        for data in self.taken_of(self._acks):
            try:
                stamp_ns, _ = self._ack_reader.read(data)
                name = self._ack_reader.strings(data)[0]
            except ValueError as error:
                self.monitor.fault(f'{topics.ACK.name}: {error}; the message was dropped')
            else:
                self._release.ack(name, stamp_ns)

    def _look(self):
        self.on_drained()
        late = self._release.look('the consumers of pacing.required')
        if late and not self.stop:
            self.monitor.fault(late, fatal=True)
            self.stop.request(EXIT_CONSUMER)

    def _describe(self):
        """Return '' (this never reports a fault) and the values for /diagnostics."""
        return '', (('input', self.stage.state), ('waiting', len(self._release)))
