"""Node strapdown: compute the free inertial solution from IMU samples, and its errors."""

from std_srvs.srv import Trigger

from ins_sim.core.attitude import quaternion
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
from ..process.announced import Unannounced
from ..transport import qos
from ..transport.broadcaster import Broadcaster
from .following import NavigatorNode


class StrapdownNode(NavigatorNode):
    """
    Strapdown INS: imu/data_raw and truth/odometry in; ins/odometry, ins/fix, ins/error/* out.

    If initial.source is not ``truth``, the node needs no truth and publishes no errors, see
    ``StandaloneDrive``.
    """

    NAME = 'strapdown'
    SETTINGS = StrapdownSettings
    PUBLISHED = (topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)

    def make_broadcaster(self):
        """Return the Broadcaster of odom -> base_link."""
        return Broadcaster(self, self.settings, INS_MOVES, INS_FIXED)

    def make_navigator(self):
        """Return the navigator that processes the streams."""
        self._sample_clock = SampleClock(self.settings, period_ns(self.settings.rate_hz))
        self._drive = None
        if self.settings.standalone:
            self._drive = self._make_drive()
            return self._drive.stage
        return Navigator(self.settings, self.settings.topics.depth,
                         published_covariance(self.settings))

    def _make_drive(self):
        # Imported lazily: a strapdown that is given the truth starts faster without it.
        from .standalone import StandaloneDrive
        drive = StandaloneDrive(self)
        self.epoch_ns = 0
        self.DRIVER, self.PUBLISHED = drive.driver, (topics.INS_ODOMETRY, topics.INS_FIX)
        return drive

    def make_announced(self):
        """Return the AnnouncedRun; without truth, motion time is the stamp (Unannounced)."""
        return super().make_announced() if self._drive is None else Unannounced()

    def make_queues(self):
        """Make the queues of the inputs other than the IMU."""
        (super() if self._drive is None else self._drive).make_queues()

    def hand_queues(self):
        """Return {topic name: HandQueue} of the inputs other than the IMU."""
        return super().hand_queues() if self._drive is None else self._drive.queues

    def take(self):
        """Process the messages that have arrived on the other inputs."""
        (super() if self._drive is None else self._drive).take()

    def publish(self, outputs):
        """Publish solutions, and report the faults of the navigator."""
        (super() if self._drive is None else self._drive).publish(outputs)

    def make_outputs(self):
        """Make the publishers (with imu_data: true also imu/data) and the service ~/align."""
        super().make_outputs()
        self.create_service(Trigger, '~/align', self._on_align)
        self._imu_data, self._compared = None, False
        if self.settings.imu_data:
            self._imu_data = qos.make_publisher(self, topics.IMU_DATA, self.depth)

    def instant(self, stamp_ns):
        """Return the instant (motion time, ns) of an IMU sample, given its stamp."""
        return self._sample_clock.instant(stamp_ns)

    def on_message(self, data):
        """Process one IMU message; compare the noise that the first one states with settings."""
        if not self._compared:
            self._compared = True
            self._compare(data)
        super().on_message(data)

    def push_reading(self, sample, data):
        """Pass one IMU sample to the navigator, after the other inputs that have arrived."""
        if self._drive is None:
            super().push_reading(sample, data)
        else:
            self._drive.on_message(data, sample)

    def _on_align(self, request, response):
        if self._drive is None:
            response.success, response.message = False, (
                'initial.source is truth, so the solution starts from the truth without an '
                'alignment; expected alignment')
        else:
            response.success, response.message = self.stage.align()
        return response

    def describe_reset(self):
        """Return the answer to ~/reset."""
        return (super() if self._drive is None else self._drive).describe_reset()

    def _compare(self, data):
        try:
            _, rate, force = Reader(topics.IMU, ((16, 25), (28, 37))).read(data)
        except ValueError:
            # The fault is reported where the message is read.
            return
        sentence = disagreement(self.settings, (rate[::4], force[::4]))
        if sentence and min(*rate[::4], *force[::4]) > 0.0:
            self.get_logger().warning(sentence)

    def messages(self, rate, solution, errors, known):
        """Return the fields of each topic; no fix while the position on the Earth is unknown."""
        if self._drive is not None and not self.stage.located:
            return (ins_odometry_one(self.frame, solution, rate, known),)
        return (ins_odometry_one(self.frame, solution, rate, known),
                (fix_one(solution), known.place), *((e,) for e in errors))

    def publish_one(self, stamp_ns, rate, solution, errors, known):
        """Publish an output and, if asked for, imu/data."""
        super().publish_one(stamp_ns, rate, solution, errors, known)
        if self._imu_data is not None and self.reading is not None \
                and self._imu_data.get_subscription_count():
            pose, _ = odometry_one(self.frame, solution, rate)
            q, covariance = orientation_one(pose, known)
            if self._drive is not None:
                # imu/data has the orientation of the IMU, not of the vehicle.
                q = quaternion.multiply(q, self.stage.q_bs)
            self._imu_data.publish(with_orientation(self.reading, stamp_ns, q, covariance))
