"""Node aided_navigator: estimate the aided navigation solution from IMU samples and fixes."""

import time

from ins_sim.core.aiding.live import AidedStream
from ins_sim.core.aiding.navigator import GNSS, METER
from ins_sim.core.aiding.reading_noise import rate_variance
from ins_sim.core.earth.great_circle import GreatCircleRoute
from ins_sim.messages import topics, velocity_record
from ins_sim.messages.convert import aided_fix_one, aided_odometry_one, SIGMAS
from ins_sim.messages.gnss_fixes import GnssPairs
from ins_sim.messages.placements import AIDED_MOVES
from ins_sim.settings.aided_navigator import AidedNavigatorSettings
from ..process.aiding_health import AidingHealth
from ..transport import qos
from ..transport.backlog import HandQueue
from ..transport.broadcaster import Broadcaster
from ..transport.map_to_odom import MapToOdom
from ..transport.patience import MISSING_S
from .following import NavigatorNode


class AidedNavigatorNode(NavigatorNode):
    """
    Aided navigation: subscribes to imu/data_raw, truth/odometry and the fixes, publishes aided/*.

    The truth is used for the errors of the solution and, as in strapdown, for the initial state.
    """

    NAME = 'aided_navigator'
    SETTINGS = AidedNavigatorSettings
    PUBLISHED = (topics.AIDED_ODOMETRY, *topics.AIDED_ERRORS, topics.AIDED_ORTHODROME)

    def make_navigator(self):
        """Return the aided navigator that processes the streams."""
        self._route = GreatCircleRoute.of_points(self.settings.motion.route.points)
        return AidedStream(self.settings, self.settings.topics.depth)

    def make_broadcaster(self):
        """Return the Broadcaster of map -> odom."""
        return Broadcaster(self, self.settings, AIDED_MOVES)

    def begin_announced(self):
        """Convert the stamps of fixes to motion time with the announced epoch."""
        self._pairs.epoch_ns = self.epoch_ns

    def make_outputs(self):
        """Make publishers and readers, and the queues of the fixes."""
        super().make_outputs()
        self._rate_variance = rate_variance(self.settings)
        self._odom = None
        if self.broadcaster.publish is not None:
            self._odom = MapToOdom(self, self.broadcaster, self.depth)
        self._fix = qos.make_publisher(self, topics.AIDED_FIX, self.depth)
        self._fix_pack = topics.AIDED_FIX.named(self.names).writer().pack
        self._fix_alone = topics.AIDED_FIX_ALONE.named(self.names).writer().pack
        self._sigmas = [(qos.make_publisher(self, topic, self.depth),
                         topic.named(self.names).writer().pack) for topic in topics.AIDED_SIGMAS]
        self._pairs = GnssPairs(0, round(1e6 * self.settings.gnss.latency_ms))
        sources, self._queues = self.stage.navigator.sources, []
        if METER in sources:
            self._queues.append((HandQueue(self, topics.METER_RECORD, self.depth), METER,
                                 lambda data: [velocity_record.read_fix(data, self.epoch_ns)]))
        if GNSS in sources:
            # Read the velocity first: a fix is complete only with the velocity of its instant.
            self._queues += [(HandQueue(self, topic, self.depth), GNSS, push) for topic, push in (
                (topics.GNSS_VELOCITY, self._pairs.push_velocity),
                (topics.GNSS_FIX, self._pairs.push_fix))]
        self._joined, self._asked_s = not self._queues, None
        self._health = AidingHealth(self.stage)
        self.monitor.add(self._health.describe)

    def hand_queues(self):
        """Return {topic name: HandQueue} of the truth, the fixes and, for TF, ins/odometry."""
        queues = [queue for queue, *_ in self._queues]
        if self._odom is not None:
            queues.append(self._odom.queue)
        return {**super().hand_queues(), **{queue.topic: queue for queue in queues}}

    def start_anew(self):
        """Discard all received data, including the free INS solutions kept for map -> odom."""
        super().start_anew()
        if self._odom is not None:
            self._odom.clear()

    def waits(self):
        """Return whether a truth message, a fix or a free INS solution is still missing."""
        return super().waits() or self._odom is not None and self._odom.waiting

    def progress(self):
        """Return a value that changes whenever an awaited message arrives."""
        return super().progress() if super().waits() else self._odom.reached_ns

    def place(self, stamp_ns, pose):
        """Broadcast map -> odom as soon as the free INS solution of this instant has arrived."""
        if self._odom is not None:
            self._odom.solved(stamp_ns, pose)

    def on_drained(self):
        """
        Acknowledge the samples processed so far.

        The first acknowledgement is held back until the publishers of the expected fixes have
        been discovered: what a node publishes before discovery is lost. Until then lock-step
        repeats sample 0. After MISSING_S the node no longer waits for publishers.
        """
        if not self._joined:
            now = time.monotonic()
            self._asked_s = now if self._asked_s is None else self._asked_s
            self._joined = now - self._asked_s > MISSING_S or all(
                self.count_publishers(self.resolve_topic_name(queue.topic))
                for queue, *_ in self._queues)
        if self._joined:
            super().on_drained()

    def begin_run(self):
        """Reset the route to its first leg."""
        self._leg = 0

    def take(self):
        """Process the truth messages and fixes that have arrived."""
        super().take()
        for queue, source, read in self._queues:
            for data in self.taken_of(queue):
                self._take_fixes(source, read, data)
        if self._odom is not None:
            self._odom.take()

    def _take_fixes(self, source, read, data):
        try:
            fixes = read(data)
        except ValueError as error:
            self.fault(str(error))
            return
        if source in self.stage.silent:
            self.get_logger().info(f'fixes of {source} arrive again')
        for fix in fixes:
            self._health.came(source, fix)
            self.publish(self.push(self.stage.push_fix, (source, fix)))
            # If the fix is invalid, the samples that waited for it can be processed now.
            self.publish(self.push(self.stage.match, ()))

    def miss(self):
        """Report what has not arrived in time (a fix or the truth), and continue without it."""
        awaited = self.stage.awaited
        for source in awaited:
            self.fault(f'no fix of {source} in {MISSING_S:g} s; expected one for every '
                       f'{"window" if source == METER else "instant"}; continuing without this '
                       'sensor until its fixes arrive again')
            self.publish(self.push(self.stage.go_on_without, (source,)))
        if not awaited and not self.stage.waiting:
            self._odom.miss()
        elif not awaited:
            super().miss()

    def publish(self, outputs):
        """Publish outputs, and count the fixes that the filter used and rejected."""
        self._health.count(self.stage.judged)
        super().publish(outputs)

    def messages(self, rate, solution, errors, sigmas):
        """Return the fields of the topics that are published with every filter."""
        return (aided_odometry_one(self.frame, solution, rate, sigmas, self._rate_variance),
                *((e,) for e in errors), (self._orthodrome(solution),))

    def publish_one(self, stamp_ns, rate, solution, errors, sigmas):
        """Publish an output, with three-sigma bounds if the filter estimates covariances."""
        super().publish_one(stamp_ns, rate, solution, errors, sigmas)
        if self._fix.get_subscription_count():
            pack = self._fix_alone if sigmas is None else self._fix_pack
            self._fix.publish(pack(stamp_ns, *aided_fix_one(solution, sigmas)))
        # The topics begin with attitude, like those of the errors; the filter ends with it.
        for (publisher, pack), sigma in zip(self._sigmas, sigmas[::-1] if sigmas else ()):
            if publisher.get_subscription_count():
                publisher.publish(pack(stamp_ns, [SIGMAS * s for s in sigma]))

    def _orthodrome(self, solution):
        lat, lon, height = solution[:3]
        self._leg = self._route.leg_at(lat, lon, self._leg)
        x, z = self._route.to_xz(lat, lon, self._leg)
        return x, height, z
