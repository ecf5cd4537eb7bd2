"""Node strapdown: readings of an IMU in, navigation solution and its errors out."""

from ins_sim.core.navigation.live import Navigator
from ins_sim.core.navigation.sample_clock import SampleClock
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.simulation.free_covariance import disagreement, published_covariance
from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader
from ins_sim.messages.convert import fix_one, ins_odometry_one, odometry_one, orientation_one
from ins_sim.messages.imu_data import with_orientation
from ins_sim.messages.placements import INS_FIXED, INS_MOVES
from ins_sim.settings.strapdown import StrapdownSettings
from ..transport import qos
from ..transport.broadcaster import Broadcaster
from .following import NavigatorNode


class StrapdownNode(NavigatorNode):
    """Reads imu/data_raw and truth/odometry, publishes ins/odometry, ins/fix, ins/error/*."""

    NAME = 'strapdown'
    SETTINGS = StrapdownSettings
    PUBLISHED = (topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)

    def make_broadcaster(self):
        """Return the Broadcaster of odom -> base_link."""
        return Broadcaster(self, self.settings, INS_MOVES, INS_FIXED)

    def make_navigator(self):
        """Return the navigator."""
        self._sample_clock = SampleClock(self.settings, period_ns(self.settings.rate_hz))
        return Navigator(self.settings, self.settings.topics.depth,
                         published_covariance(self.settings))

    def make_outputs(self):
        """Make publishers, that of imu/data too if it is asked for."""
        super().make_outputs()
        self._imu_data, self._compared = None, False
        if self.settings.imu_data:
            self._imu_data = qos.make_publisher(self, topics.IMU_DATA, self.depth)

    def instant(self, stamp_ns):
        """Return the instant of a reading by its stamp, motion time."""
        return self._sample_clock.instant(stamp_ns)

    def on_message(self, data):
        """Give one IMU message to the navigator; of the first one, look whose IMU it is from."""
        if not self._compared:
            self._compared = True
            self._compare(data)
        super().on_message(data)

    def _compare(self, data):
        try:
            _, rate, force = Reader(topics.IMU, ((16, 25), (28, 37))).read(data)
        except ValueError:
            # said where the message is read
            return
        sentence = disagreement(self.settings, (rate[::4], force[::4]))
        if sentence and min(*rate[::4], *force[::4]) > 0.0:
            self.get_logger().warning(sentence)

    def messages(self, rate, solution, errors, known):
        """Return the runs of each topic."""
        return (ins_odometry_one(self.frame, solution, rate, known),
                (fix_one(solution), known.place), *((e,) for e in errors))

    def publish_one(self, stamp_ns, rate, solution, errors, known):
        """Publish an output, and imu/data."""
        super().publish_one(stamp_ns, rate, solution, errors, known)
        if self._imu_data is not None and self.reading is not None \
                and self._imu_data.get_subscription_count():
            pose, _ = odometry_one(self.frame, solution, rate)
            self._imu_data.publish(with_orientation(self.reading, stamp_ns,
                                                    *orientation_one(pose, known)))
