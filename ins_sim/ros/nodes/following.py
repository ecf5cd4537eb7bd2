"""Base class of the navigating nodes: match IMU samples with the truth and publish solutions."""

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.navigation.loop import Decimation
from ins_sim.core.numerics.instants import period_ns
from ins_sim.messages import topics
from ins_sim.messages.plausible import PlausibleReader
from ..transport import qos
from ..transport.backlog import HandQueue
from ..transport.patience import MISSING_S, Patience
from .stage import StageNode

# Angular rate and message used when the IMU sample of an output is no longer stored.
NO_READING = (0.0, 0.0, 0.0), None


class NavigatorNode(StageNode):
    """
    Base class of nodes driven by imu/data_raw whose stage is a MatchedStreams.

    A subclass defines

    * ``PUBLISHED``: the Topics it publishes, beginning with an Odometry;
    * ``make_navigator()``: returns the stage;
    * ``messages(rate, *output)``: returns the fields of each published topic for one output of
      the stage (without its instant).

    A subclass with further inputs extends ``take`` (process what has arrived), ``waits`` (is
    something still missing?) and ``miss`` (report it and continue).
    """

    DRIVER = topics.IMU_RAW
    # A solution starts at its first IMU sample, so stamps outside the announced run are accepted.
    CHECKS_STAMPS = False

    def make_stage(self):
        """Return the navigator that processes the streams."""
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
        # Read pose and velocity only; the angular rate is not needed.
        self._truth_reader = PlausibleReader(topics.TRUTH_ODOMETRY, ((0, 3), (3, 7), (43, 46)))
        # Truth messages stay in their queue until an IMU sample needs them: in the executor's
        # wait set, each would cost one cycle of the executor.
        self._truth = HandQueue(self, topics.TRUTH_ODOMETRY, self.depth)

    def hand_queues(self):
        """Return the queue of truth."""
        return {topics.TRUTH_ODOMETRY.name: self._truth}

    def start_anew(self):
        """Discard all received data, and match the two streams afresh."""
        self._readings.clear()
        self._newest_ns = None
        self.stage.rejoin()

    def instant(self, stamp_ns):
        """Return the instant (motion time, ns) of an IMU sample, given its stamp."""
        return stamp_ns

    def read_imu(self, data):
        """Return instant, angular rate and specific force of a message, None if it is bad."""
        sample = self.read(self._imu_reader, data)
        return None if sample is None else (self.instant(sample[0]), *sample[1:])

    def on_message(self, data):
        """Process one IMU message, and wait for the messages that it needs."""
        sample = self.read_imu(data)
        if sample is None:
            return
        self._newest_ns = sample[0]
        self.push_reading(sample, data)
        self._patience.wait()

    def push_reading(self, sample, data):
        """Pass one IMU sample to the navigator, after the other inputs that have arrived."""
        if len(self._readings) > self.depth:
            # The stored samples were refused by the stage and will never be needed.
            self._readings.clear()
        self._readings[sample[0]] = sample[1], data
        # Read the other queues first: if the simulation was reset, their stamps jump back before
        # those of the IMU.
        self.take()
        self.publish(self.push(self.stage.push_imu, sample))

    def waits(self):
        """Return whether the samples received so far still need another message."""
        return self.stage.waiting

    def progress(self):
        """Return a value that changes whenever an awaited message arrives."""
        return self.stage.processed_ns

    def take(self):
        """Process the truth messages that have arrived."""
        for data in self.taken_of(self._truth):
            sample = self.read(self._truth_reader, data)
            if sample is not None:
                self.publish(self.push(self.stage.push_truth, sample))

    def miss(self):
        """Report what has not arrived in time, and continue without it."""
        if self.stage.parted:
            self.fault(f'the stamps of one of {topics.IMU_RAW.name} and '
                       f'{topics.TRUTH_ODOMETRY.name} have jumped back, and those of the other '
                       f'have not followed within {MISSING_S:g} s; expected both topics from one '
                       'run: from now on they are treated as belonging to one run')
        else:
            self.fault(f'no message on {topics.TRUTH_ODOMETRY.name} in {MISSING_S:g} s; expected '
                       'the truth of every IMU sample: is motion_generator or truth_adapter '
                       'running? (strapdown needs no truth if initial.source is given, fix or '
                       'alignment)')
        self.stage.rejoin()

    def _settle(self):
        if self.waits():
            self.seen_so_far(self.stage.processed_ns)
            return
        self._readings.clear()
        if self._newest_ns is not None:
            self.seen(self._newest_ns)

    def publish(self, outputs):
        """Publish every output_every-th output of the stage, and report the stage's faults."""
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
        """Prepare for the first output of a new run; subclasses override this."""

    def publish_one(self, stamp_ns, rate, *output):
        """
        Publish one output of the stage.

        Parameters
        ----------
        stamp_ns : stamp of the messages, ns
        rate : angular rate measured by the gyros at this instant, rad/s, shape (3,)
        output : output of the stage without its instant

        ``self.reading`` is the IMU message of this instant, or None.
        """
        # Skip topics without subscribers: checking costs a fifth of packing and publishing.
        heard = [publisher.get_subscription_count() for publisher, _ in self._outputs]
        if not any(heard) and not self.places:
            return
        messages = self.messages(rate, *output)
        for (publisher, pack), runs, count in zip(self._outputs, messages, heard):
            if count:
                publisher.publish(pack(stamp_ns, *runs))
        # The first message is the Odometry; it begins with the pose.
        self.place(stamp_ns, messages[0][0])

    @property
    def places(self):
        """Return whether the node broadcasts a transform."""
        return self.broadcaster.publish is not None

    def place(self, stamp_ns, pose):
        """Broadcast the pose of the vehicle on /tf."""
        self.broadcaster.send(stamp_ns, pose)
