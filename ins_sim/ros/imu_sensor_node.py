"""Node imu_sensor: streamed truth in, readings of the IMU out."""

from ins_sim.core.imu_stream import make_imu
from ins_sim.core.instrument import with_errors
from ins_sim.messages import topics

from . import qos
from .stage import StageNode


class ImuSensorNode(StageNode):
    """Reads truth/imu, publishes imu/data_raw."""

    NAME = 'imu_sensor'
    DRIVER = topics.TRUTH_IMU

    def make_stage(self):
        """Return the IMU."""
        return make_imu(self.settings)

    def make_outputs(self):
        """Make publisher, reader and writer."""
        self._publisher = qos.publisher(self, topics.IMU_RAW, self.depth)
        errors = with_errors(self.settings)
        topic = topics.IMU_RAW if errors is None else topics.imu_raw(*errors.variances)
        self._reader, self._writer = topics.TRUTH_IMU.reader(), topic.writer()

    def on_message(self, data):
        """Give one truth message to the IMU and publish what it completes."""
        sample = self.read(self._reader, data)
        if sample is None:
            return
        for t_ns, omega, force in self.push(self.stage.push, sample):
            self._publisher.publish(self._writer.pack(t_ns + self.epoch_ns, omega, force))
            self.monitor.sent += 1
        self.seen(sample[0])
