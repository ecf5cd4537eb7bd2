"""What the nodes that navigate share: readings of an IMU, and the truth that each waits for."""

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.navigation.loop import Decimation
from ins_sim.core.numerics.instants import period_ns
from ins_sim.messages import topics
from ins_sim.messages.plausible import PlausibleReader
from ..transport import qos
from ..transport.backlog import HandQueue
from ..transport.patience import MISSING_S, Patience
from .stage import StageNode

# rate and message of a reading that is not known any more
NO_READING = (0.0, 0.0, 0.0), None


class NavigatorNode(StageNode):
    """
    A node driven by imu/data_raw whose stage is a core.streams.matching.MatchedStreams.

    A subclass has PUBLISHED, its Topics, an Odometry first; make_navigator(), and messages(rate,
    *output) -> the runs of each of these, output being one of the stage without its instant.  It
    may have more to take, ``take``, to wait for, ``waits``, and to miss, ``miss``.
    """

    DRIVER = topics.IMU_RAW
    # a solution counts from its first reading, wherever the epoch is
    CHECKS_STAMPS = False

    def make_stage(self):
        """Return the navigator."""
        settings = self.settings
        self.frame = MapFrame(settings.datum, settings.earth.rotation)
        self._decimation = Decimation(settings.output_every, period_ns(settings.rate_hz))
        self._readings = {}
        self._newest_ns = None
        return self.make_navigator()

    def make_outputs(self):
        """Make publishers, readers, writers and the queue of truth."""
        self._imu_reader = PlausibleReader(self.DRIVER)
        self._outputs = [(qos.make_publisher(self, topic, self.depth),
                          topic.named(self.names).writer().pack) for topic in self.PUBLISHED]
        self.make_queues()
        self._patience = Patience(self, self.waits, self.progress, self.take, self.miss,
                                  self._settle)

    def make_queues(self):
        """Make the queue of truth."""
        # the rate of the body is not needed: pose and velocity only
        self._truth_reader = PlausibleReader(topics.TRUTH_ODOMETRY, ((0, 3), (3, 7), (43, 46)))
        # Truth waits in its queue until a reading needs it; were it in the wait set, every truth
        # message would cost a cycle of the executor.
        self._truth = HandQueue(self, topics.TRUTH_ODOMETRY, self.depth)

    def hand_queues(self):
        """Return the queue of truth."""
        return {topics.TRUTH_ODOMETRY.name: self._truth}

    def start_anew(self):
        """Forget all that has come, and which stream is ahead of the other."""
        self._readings.clear()
        self._newest_ns = None
        self.stage.rejoin()

    def instant(self, stamp_ns):
        """Return the instant of a reading by its stamp, motion time."""
        return stamp_ns

    def read_imu(self, data):
        """Return instant, rate and specific force of a message, or None after a report."""
        sample = self.read(self._imu_reader, data)
        return None if sample is None else (self.instant(sample[0]), *sample[1:])

    def on_message(self, data):
        """Give one IMU message to the navigator, and what it waits for."""
        sample = self.read_imu(data)
        if sample is None:
            return
        self._newest_ns = sample[0]
        self.push_reading(sample, data)
        self._patience.wait()

    def push_reading(self, sample, data):
        """Give one reading to the navigator, and what it waits for."""
        if len(self._readings) > self.depth:
            # of readings that are refused, none is ever needed
            self._readings.clear()
        self._readings[sample[0]] = sample[1], data
        # the rest first: it may have jumped back as the IMU is about to
        self.take()
        self.publish(self.push(self.stage.push_imu, sample))

    def waits(self):
        """Return whether something has to come before what was taken is done."""
        return self.stage.waiting

    def progress(self):
        """Return what changes when something comes that is waited for."""
        return self.stage.processed_ns

    def take(self):
        """Take what has come beside the readings."""
        for data in self.taken_of(self._truth):
            sample = self.read(self._truth_reader, data)
            if sample is not None:
                self.publish(self.push(self.stage.push_truth, sample))

    def miss(self):
        """Say what has not come, and go on without."""
        if self.stage.parted:
            self.fault(f'of {topics.IMU_RAW.name} and {topics.TRUTH_ODOMETRY.name} one has jumped '
                       f'back and the other has not followed in {MISSING_S:g} s; expected both '
                       'from one run: they are taken as of one run from now on')
        else:
            self.fault(f'no message on {topics.TRUTH_ODOMETRY.name} in {MISSING_S:g} s; expected '
                       'the truth of every reading')
        self.stage.rejoin()

    def _settle(self):
        if self.waits():
            self.seen_so_far(self.stage.processed_ns)
            return
        self._readings.clear()
        if self._newest_ns is not None:
            self.seen(self._newest_ns)

    def publish(self, outputs):
        """Publish every output_every-th of the stage's outputs, and report what ended them."""
        while self.stage.faults:
            self.fault(str(self.stage.faults.pop(0)))
        for t_ns, *output in outputs:
            if self._decimation.begins(t_ns):
                self.begin_run()
            if not self._decimation.due(t_ns):
                continue
            rate, self.reading = self._readings.get(t_ns, NO_READING)
            self.publish_one(t_ns + self.epoch_ns, rate, *output)
            self.monitor.sent += 1

    def begin_run(self):
        """Start anew at the first instant of a run."""

    def publish_one(self, stamp_ns, rate, *output):
        """
        Publish an output; rate: the reading of the gyros at its instant, rad/s.

        ``reading`` is the message that it is from, or None.
        """
        # asking costs a fifth of packing and publishing what nobody hears
        heard = [publisher.get_subscription_count() for publisher, _ in self._outputs]
        if not any(heard) and not self.places:
            return
        messages = self.messages(rate, *output)
        for (publisher, pack), runs, count in zip(self._outputs, messages, heard):
            if count:
                publisher.publish(pack(stamp_ns, *runs))
        # of the Odometry, which is the first of them
        self.place(stamp_ns, messages[0][0])

    @property
    def places(self):
        """Return whether a frame is placed on TF."""
        return self.broadcaster.publish is not None

    def place(self, stamp_ns, pose):
        """Place the vehicle on TF."""
        self.broadcaster.send(stamp_ns, pose)
