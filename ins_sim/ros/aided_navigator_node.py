"""Node aided_navigator: readings of an IMU and fixes in, aided solution and its errors out."""

from ins_sim.core.aided_navigator import GNSS, METER
from ins_sim.core.aided_stream import AidedStream
from ins_sim.core.instants import period_ns
from ins_sim.core.map_frame import MapFrame
from ins_sim.core.orthodrome import Route
from ins_sim.messages import topics, velocity_record
from ins_sim.messages.convert import aided_fix_one, aided_odometry_one, SIGMAS
from ins_sim.messages.gnss_fixes import GnssPairs

from . import qos
from .aiding_health import AidingHealth
from .patience import MISSING_S, Patience
from .queue import HandQueue
from .stage import StageNode


class AidedNavigatorNode(StageNode):
    """Reads imu/data_raw, truth/odometry and fixes; publishes aided/*."""

    NAME = 'aided_navigator'
    DRIVER = topics.IMU_RAW

    def make_stage(self):
        """Return the navigator."""
        settings = self.settings
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._every, self._dt_ns = settings.output_every, period_ns(settings.rate_hz)
        self._route, self._leg = Route.of_points(settings.motion.route.points), 0
        self._rates = {}
        self._first_ns = self._newest_ns = None
        return AidedStream(settings)

    def make_outputs(self):
        """Make publishers, readers and the queues of what is taken by hand."""
        self._imu_reader = topics.IMU_RAW.reader()
        self._truth_reader = topics.TRUTH_ODOMETRY.reader(((0, 3), (3, 7), (43, 46)))
        self._outputs = [(qos.publisher(self, topic, self.depth), topic.writer().pack)
                         for topic in (topics.AIDED_ODOMETRY, topics.AIDED_FIX,
                                       *topics.AIDED_ERRORS, topics.AIDED_ORTHODROME)]
        self._fix_alone = topics.AIDED_FIX_ALONE.writer().pack
        self._sigmas = [(qos.publisher(self, topic, self.depth), topic.writer().pack)
                        for topic in topics.AIDED_SIGMAS]
        self._pairs = GnssPairs(self.epoch_ns, round(1e6 * self.settings.gnss.latency_ms))
        self._truth = HandQueue(self, topics.TRUTH_ODOMETRY, self.depth)
        sources, self._queues = self.stage.navigator.sources, []
        if METER in sources:
            self._queues.append((HandQueue(self, topics.METER_RECORD, self.depth), METER,
                                 lambda data: [velocity_record.read(data, self.epoch_ns)]))
        if GNSS in sources:
            # the velocity first, for the fix waits for it
            self._queues += [(HandQueue(self, topic, self.depth), GNSS, push) for topic, push in (
                (topics.GNSS_VELOCITY, self._pairs.push_velocity),
                (topics.GNSS_FIX, self._pairs.push_fix))]
        self._health = AidingHealth(self.stage)
        self.monitor.add(self._health.describe)
        self._patience = Patience(self, lambda: self.stage.waiting,
                                  lambda: self.stage.processed_ns, self._take, self._miss,
                                  self._on_matched)

    def on_message(self, data):
        """Give one IMU message to the navigator, and what it waits for."""
        sample = self.read(self._imu_reader, data)
        if sample is None:
            return
        self._newest_ns = sample[0]
        self._rates[sample[0]] = sample[1]
        # the rest first: it may have jumped back as the IMU is about to
        self._take()
        self._publish(self.push(self.stage.push_imu, sample))
        self._patience.wait()

    def _take(self):
        while not self.stop and (data := self._truth.take()) is not None:
            sample = self.read(self._truth_reader, data)
            if sample is not None:
                self._publish(self.push(self.stage.push_truth, sample))
        for queue, source, read in self._queues:
            while not self.stop and (data := queue.take()) is not None:
                self._take_fixes(source, read, data)

    def _take_fixes(self, source, read, data):
        try:
            fixes = read(data)
        except ValueError as error:
            self.fault(str(error))
            return
        for fix in fixes:
            self._health.came(source, fix)
            self._publish(self.push(self.stage.push_fix, (source, fix)))
            # where that fix was none, what it held up goes on without it
            self._publish(self.push(self.stage.match, ()))

    def _miss(self):
        awaited = self.stage.awaited
        for source in awaited:
            self.fault(f'no fix of {source} in {MISSING_S:g} s; expected one for every '
                       f'{"window" if source == METER else "instant"}: going on without it until '
                       'it delivers again')
            self._publish(self.push(self.stage.go_on_without, (source,)))
        if not awaited:
            self.fault(f'no message on {topics.TRUTH_ODOMETRY.name} in {MISSING_S:g} s; expected '
                       'the truth of every reading')
            self.stage.reset()

    def _on_matched(self):
        self._rates.clear()
        if self._newest_ns is not None:
            self.seen(self._newest_ns)

    def _publish(self, outputs):
        self._health.judge(self.stage.taken)
        for t_ns, solution, errors, sigmas in outputs:
            if self._first_ns is None or t_ns < self._first_ns:
                self._first_ns, self._leg = t_ns, 0
            if (t_ns - self._first_ns + self._dt_ns // 2) // self._dt_ns % self._every:
                continue
            stamp_ns = t_ns + self.epoch_ns
            rate = self._rates.get(t_ns, (0.0, 0.0, 0.0))
            messages = (aided_odometry_one(self._frame, solution, rate, sigmas),
                        aided_fix_one(solution, sigmas), *((e,) for e in errors),
                        (self._orthodrome(solution),))
            for (publisher, pack), runs in zip(self._outputs, messages):
                if publisher.get_subscription_count():
                    if sigmas is None and runs is messages[1]:
                        pack = self._fix_alone
                    publisher.publish(pack(stamp_ns, *runs))
            # attitude first, as the errors
            for (publisher, pack), sigma in zip(self._sigmas, sigmas[::-1] if sigmas else ()):
                if publisher.get_subscription_count():
                    publisher.publish(pack(stamp_ns, [SIGMAS * s for s in sigma]))
            self.monitor.sent += 1

    def _orthodrome(self, solution):
        lat, lon, height = solution[:3]
        self._leg = self._route.leg_at(lat, lon, self._leg)
        x, z = self._route.to_xz(lat, lon, self._leg)
        return x, height, z
