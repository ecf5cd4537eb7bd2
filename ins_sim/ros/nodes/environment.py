"""Magnetometer and barometer of the node imu_sensor: publish imu/mag and imu/pressure."""

from collections import deque

from ins_sim.io.environment import EnvironmentSensors
from ins_sim.messages import topics
from ins_sim.messages.plausible import PlausibleReader
from ..transport import qos
from ..transport.backlog import DrivingQueue


class EnvironmentPublisher:
    """
    Publishes magnetometer and barometer samples computed from truth/odometry.

    It belongs to a StageNode and uses that node's epoch, fault reports and queue depth.
    """

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
        """Restart the sensors with the next sample."""
        self._sensors.reset()

    def _on_truth(self, data):
        # Messages that arrive before the epoch is known wait for the announcement.
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
