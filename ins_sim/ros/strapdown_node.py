"""Node strapdown: readings of an IMU in, navigation solution and its errors out."""

from ins_sim.core.instants import period_ns
from ins_sim.core.map_frame import MapFrame
from ins_sim.core.navigator import Navigator
from ins_sim.core.sampling import SampleClock
from ins_sim.messages import topics
from ins_sim.messages.convert import fix_one, odometry_one

from . import qos
from .patience import MISSING_S, Patience
from .queue import HandQueue
from .stage import StageNode


class StrapdownNode(StageNode):
    """Reads imu/data_raw and truth/odometry, publishes ins/odometry, ins/fix, ins/error/*."""

    NAME = 'strapdown'
    DRIVER = topics.IMU_RAW

    def make_stage(self):
        """Return the navigator."""
        settings = self.settings
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._every, self._dt_ns = settings.output_every, period_ns(settings.rate_hz)
        self._sample_clock = SampleClock(settings, self._dt_ns)
        self._rates = {}
        self._first_ns = self._newest_ns = None
        return Navigator(settings)

    def make_outputs(self):
        """Make publishers, readers, writers and the queue of truth."""
        self._imu_reader = topics.IMU_RAW.reader()
        # the rate of the body is not needed: pose and velocity only
        self._truth_reader = topics.TRUTH_ODOMETRY.reader(((0, 3), (3, 7), (43, 46)))
        self._outputs = [(qos.publisher(self, topic, self.depth), topic.writer().pack)
                         for topic in (topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)]
        # Truth waits in its queue until a reading needs it; were it in the wait set, every truth
        # message would cost a cycle of the executor.
        self._truth = HandQueue(self, topics.TRUTH_ODOMETRY, self.depth)
        self._patience = Patience(
            self, lambda: self.stage.waiting, lambda: self.stage.processed_ns, self._take_truth,
            self._miss_truth, self._on_matched)

    def on_message(self, data):
        """Give one IMU message to the navigator, and the truth that it waits for."""
        sample = self.read(self._imu_reader, data)
        if sample is None:
            return
        sample = (self._sample_clock.instant(sample[0]), *sample[1:])
        self._newest_ns = sample[0]
        self._rates[sample[0]] = sample[1]
        # the truth first: it may have jumped back as the IMU is about to
        self._take_truth()
        self._publish(self.push(self.stage.push_imu, sample))
        self._patience.wait()

    def _take_truth(self):
        while not self.stop and (data := self._truth.take()) is not None:
            sample = self.read(self._truth_reader, data)
            if sample is not None:
                self._publish(self.push(self.stage.push_truth, sample))

    def _miss_truth(self):
        self.fault(f'no message on {topics.TRUTH_ODOMETRY.name} in {MISSING_S:g} s; expected the '
                   'truth of every reading')
        self.stage.reset()

    def _on_matched(self):
        self._rates.clear()
        if self._newest_ns is not None:
            self.seen(self._newest_ns)

    def _publish(self, outputs):
        for t_ns, solution, errors in outputs:
            if self._first_ns is None or t_ns < self._first_ns:
                self._first_ns = t_ns
            if (t_ns - self._first_ns + self._dt_ns // 2) // self._dt_ns % self._every:
                continue
            stamp_ns = t_ns + self.epoch_ns
            rate = self._rates.get(t_ns, (0.0, 0.0, 0.0))
            messages = (odometry_one(self._frame, solution, rate), (fix_one(solution),),
                        *((e,) for e in errors))
            for (publisher, pack), runs in zip(self._outputs, messages):
                # asking costs a fifth of packing and publishing what nobody hears
                if publisher.get_subscription_count():
                    publisher.publish(pack(stamp_ns, *runs))
            self.monitor.sent += 1
