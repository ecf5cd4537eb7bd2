"""Node strapdown: readings of an IMU in, navigation solution and its errors out."""

import time

from ins_sim.core.imu import period_ns
from ins_sim.core.map_frame import MapFrame
from ins_sim.core.navigator import Navigator
from ins_sim.messages import topics
from ins_sim.messages.convert import fix_one, odometry_one

from . import qos
from .queue import HandQueue
from .stage import StageNode

RETRY_S = 0.005
PATIENCE_S = 0.001


class StrapdownNode(StageNode):
    """Reads imu/data_raw and truth/odometry, publishes ins/odometry, ins/fix, ins/error/*."""

    NAME = 'strapdown'
    DRIVER = topics.IMU_RAW

    def make_stage(self):
        """Return the navigator."""
        settings = self.settings
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._every, self._dt_ns = settings.output_every, period_ns(settings.rate_hz)
        self._rates = {}
        self._first_ns = self._newest_ns = None
        return Navigator(settings)

    def make_outputs(self):
        """Make publishers, readers, writers and the queue of truth."""
        self._imu_reader = topics.IMU_RAW.reader()
        # the rate of the body is not needed: pose and velocity only
        self._truth_reader = topics.TRUTH_ODOMETRY.reader(((0, 3), (3, 7), (43, 46)))
        self._outputs = [(qos.publisher(self, topic, self.depth).publish, topic.writer().pack)
                         for topic in (topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)]
        # Truth waits in its queue until a reading needs it; were it in the wait set, every truth
        # message would cost a cycle of the executor.
        self._truth = HandQueue(self, topics.TRUTH_ODOMETRY, self.depth)
        self._retry = self.create_timer(RETRY_S, self._on_retry)
        self._retry.cancel()

    def on_message(self, data):
        """Give one IMU message to the navigator, and the truth that it waits for."""
        sample = self.read(self._imu_reader, data)
        if sample is None:
            return
        self._newest_ns = sample[0]
        self._rates[sample[0]] = sample[1]
        self._publish(self.push(self.stage.push_imu, sample))
        self._fetch_truth(PATIENCE_S)

    def _fetch_truth(self, patience_s):
        until = None
        while self.stage.waiting_for_truth and not self.stop:
            data = self._truth.take()
            if data is not None:
                sample = self.read(self._truth_reader, data)
                if sample is not None:
                    self._publish(self.push(self.stage.push_truth, sample))
                continue
            now = time.monotonic()
            until = now + patience_s if until is None else until
            if now >= until:
                self._retry.reset()
                return
            time.sleep(5e-5)
        self._rates.clear()
        if self._newest_ns is not None:
            self.seen(self._newest_ns)

    def _on_retry(self):
        self._retry.cancel()
        self._fetch_truth(0.0)
        self.on_drained()

    def _publish(self, outputs):
        for t_ns, solution, errors in outputs:
            if self._first_ns is None or t_ns < self._first_ns:
                self._first_ns = t_ns
            if (t_ns - self._first_ns) // self._dt_ns % self._every:
                continue
            stamp_ns = t_ns + self.epoch_ns
            rate = self._rates.get(t_ns, (0.0, 0.0, 0.0))
            messages = (odometry_one(self._frame, solution, rate), (fix_one(solution),),
                        *((e,) for e in errors))
            for (publish, pack), runs in zip(self._outputs, messages):
                publish(pack(stamp_ns, *runs))
            self.monitor.sent += 1
