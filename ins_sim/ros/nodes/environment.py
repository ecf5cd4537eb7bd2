"""What imu_sensor publishes beside the IMU: imu/mag and imu/pressure."""

from collections import deque

from ins_sim.io.environment import EnvironmentSensors
from ins_sim.messages import topics
from ins_sim.messages.plausible import PlausibleReader
from ..transport import qos
from ..transport.backlog import DrivingQueue


class EnvironmentPublisher:
    """Reads truth/odometry beside a StageNode, whose epoch, faults and depth it takes."""

    def __init__(self, node):
        self._node, self._sensors = node, EnvironmentSensors(node.settings)
        self._held = deque(maxlen=node.depth)
        self._reader = PlausibleReader(topics.TRUTH_ODOMETRY, ((0, 3), (3, 7), (43, 46)))
        self._publish = {
            topic: (qos.make_publisher(node, topic, node.depth).publish, own.writer().pack)
            for topic, own in self._sensors.topics.items()}
        self.queue = DrivingQueue(node, topics.TRUTH_ODOMETRY, node.depth,
                                  node.guarded(self._on_truth), lambda: None, node.nobody_waits)

    def reset(self):
        """Start anew with the next sample."""
        self._sensors.reset()

    def _on_truth(self, data):
        # what comes before the epoch is known waits for it
        self._held.append(data)
        while self._held and self._node.knows_run:
            self._take(self._held.popleft())

    def _take(self, data):
        node = self._node
        sample = None if node.stop else node.read(self._reader, data)
        if sample is None:
            return
        for topic, run in self._sensors.read(*sample):
            publish, pack = self._publish[topic]
            publish(pack(sample[0] + node.epoch_ns, run))
