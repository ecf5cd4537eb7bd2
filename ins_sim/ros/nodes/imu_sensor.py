"""Node imu_sensor: simulate the samples of an IMU from the streamed truth."""

from std_srvs.srv import SetBool

from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.numerics.units import DEG_H
from ins_sim.core.sensors.imu.sampling import Sampler
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.sensors.imu.with_errors import changed, reported_variances
from ins_sim.core.streams.grid import SampleGrid
from ins_sim.messages import topics
from ins_sim.messages.placements import imu_mounting
from ins_sim.messages.plausible import PlausibleReader
from ins_sim.settings.imu import ImuSensorSettings
from ..transport import qos
from ..transport.broadcaster import Broadcaster
from .stage import StageNode


class ImuSensorNode(StageNode):
    """
    Inertial measurement unit: truth/imu in; imu/data_raw and, with tuned gyros, imu/parity out.

    With magnetometer.publish or barometer.publish it also reads truth/odometry and publishes
    imu/mag or imu/pressure.
    """

    NAME = 'imu_sensor'
    SETTINGS = ImuSensorSettings
    DRIVER = TRUTH = topics.TRUTH_IMU

    def make_stage(self):
        """Return the simulated IMU."""
        settings = self.settings
        motion = None
        if settings.source == 'motion':
            # Imported lazily: a node that receives the motion as messages starts faster without
            # it.
            from ins_sim.io.motion import read_motion
            motion = read_motion(settings)
        return make_imu(settings, motion)

    def make_broadcaster(self):
        """Return the Broadcaster of the mounting of the IMU."""
        return Broadcaster(self, self.settings, fixed={'': imu_mounting(self.settings)})

    def make_outputs(self):
        """Make publishers, reader and writers."""
        settings = self.settings
        self._dt_ns = period_ns(settings.rate_hz)
        self._grid, self._reading_ns = SampleGrid(self._dt_ns), None
        self._take_sampling(settings)
        self._publisher = qos.make_publisher(self, topics.IMU_RAW, self.depth)
        topic = topics.imu_raw(*reported_variances(settings)).named(self.names)
        self._reader, self._writer = PlausibleReader(topics.TRUTH_IMU), topic.writer()
        self._environment = None
        if settings.magnetometer.publish or settings.barometer.publish:
            from .environment import EnvironmentPublisher
            self._environment = EnvironmentPublisher(self)
        self._parity = None
        if self.stage.pair is not None:
            self._watch_parity()

    def hand_queues(self):
        """Return {topic name: queue} of truth/odometry if magnetometer or barometer needs it."""
        return {topics.TRUTH_ODOMETRY.name: self._environment.queue} if self._environment else {}

    def start_anew(self):
        """Discard all received data."""
        super().start_anew()
        if self._environment:
            self._environment.reset()

    def _watch_parity(self):
        from ins_sim.core.sensors.tuned_gyro.parity import ParityTest
        self._parity, self._tested_ns = ParityTest(self.settings, self.stage.pair), None
        self._parity_publisher = qos.make_publisher(self, topics.IMU_PARITY, self.depth)
        self._parity_writer = topics.IMU_PARITY.named(self.names).writer()
        self.monitor.add(self._describe_parity)
        self.create_service(SetBool, '~/fault', self._on_fault)

    def on_message(self, data):
        """Process one truth message, and publish the IMU samples that it completes."""
        sample = self.read(self._reader, data)
        if sample is None:
            return
        for t_ns, omega, force, parity in self.push(self._push, sample):
            self._reading_ns = t_ns
            stamp_ns = self._sampler.stamp(t_ns // self._dt_ns, t_ns)
            if stamp_ns is None:
                continue
            stamp_ns += self.epoch_ns
            self._publisher.publish(self._writer.pack(stamp_ns, omega, force))
            self.monitor.sent += 1
            if parity is not None:
                self._test_parity(stamp_ns, t_ns, omega, force, parity)
        self.seen(sample[0])

    def _push(self, t_ns, *sample):
        self._grid.check(t_ns, self._reading_ns)
        return self.stage.push(t_ns, *sample)

    def _test_parity(self, stamp_ns, t_ns, omega, force, parity):
        if t_ns != self._tested_ns:
            # Lock-step may repeat sample 0; the parity test counts it once.
            self._tested_ns = t_ns
            self._parity.push(t_ns, omega, force, parity)
        if self._parity_publisher.get_subscription_count():
            self._parity_publisher.publish(
                self._parity_writer.pack(stamp_ns, self._parity.row(parity)))

    def _describe_parity(self):
        """Return a fault of the gyro channels, or '', and the values for /diagnostics."""
        test = self._parity
        mean, most = test.mean / DEG_H, test.threshold / DEG_H
        wrong = ''
        if test.exceeded:
            wrong = (f'parity of the gyro channels is {mean:.4g} deg/h; expected at most '
                     f'{most:.4g} deg/h: a channel has a fault')
        return wrong, (('parity deg/h', f'{mean:.6g}'), ('parity threshold deg/h', f'{most:.6g}'))

    def check_change(self, settings):
        """Refuse gyro.dtg.fault if the gyros are not tuned gyros."""
        gyro = settings.gyro
        if gyro.model != 'dtg' and gyro.dtg.fault != self.settings.gyro.dtg.fault:
            raise ValueError(f'gyro.model is {gyro.model}; expected dtg: gyro.dtg.fault applies '
                             'to tuned gyros only')

    def change(self, settings):
        """Apply new biases, faults of a tuned gyro and drop-outs from the next sample on."""
        self.stage = changed(self.stage, settings)
        self._take_sampling(settings)
        if self._parity is not None:
            self._parity.expect(settings, self.stage.pair)

    def _take_sampling(self, settings):
        self._sampler = Sampler(settings.sampling, settings.seed, settings.run, 'sampling',
                                self._dt_ns)

    def effective_ns(self, name):
        """
        Return the motion time from which a parameter counts, ns, or None before the first sample.

        That is the next sample; tuned gyros are computed ahead, so theirs is the next one not yet
        computed.
        """
        if self._reading_ns is None:
            return None
        if self.stage.pair is not None and name.startswith('gyro.'):
            return self.stage.next_made_ns
        return self._reading_ns + self._dt_ns

    def _on_fault(self, request, response):
        if not self.stage.pair.has_fault:
            response.message = ('gyro.dtg.fault.channel is none; expected the name of the channel '
                                'to be disturbed')
            return response
        self.stage.pair.force_fault(request.data)
        response.success = True
        response.message = (f'{self.settings.gyro.dtg.fault.channel} '
                            f'{"has a fault" if request.data else "is healthy"}')
        return response
