"""A node in the test process that publishes given messages to a recorder or for a player."""

import time

from ins_sim.messages import topics
from support.live import GUARD_S


class Talker:
    """Publish bytes or messages on any topic, in a context of its own."""

    def __init__(self, domain):
        import rclpy
        self.context = rclpy.Context()
        self.context.init(domain_id=domain)
        self.node = rclpy.create_node('talker', context=self.context)
        self._writer = topics.IMU_RAW.writer()

    def publisher(self, message_class, name, reliability='reliable', durability='volatile',
                  depth=1000):
        """Return a publisher with the given quality of service."""
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
        return self.node.create_publisher(message_class, name, QoSProfile(
            depth=depth, reliability=ReliabilityPolicy[reliability.upper()],
            durability=DurabilityPolicy[durability.upper()]))

    def imu(self, name='imu'):
        """Return a publisher of Imu messages."""
        from sensor_msgs.msg import Imu
        return self.publisher(Imu, name)

    def imu_bytes(self, stamp_ns):
        """Return an Imu message whose values encode its stamp."""
        return self._writer.pack(stamp_ns, (stamp_ns * 1e-9, 0.0, 0.0), (0.0, 0.0, 9.8))

    def wait_matched(self, *publishers, timeout_s=GUARD_S):
        """Wait until each publisher has a subscriber."""
        end = time.monotonic() + timeout_s
        while not all(p.get_subscription_count() for p in publishers):
            assert time.monotonic() < end, [p.topic_name for p in publishers]
            time.sleep(0.02)
        # Discovery is not symmetric: a reader may discover its publisher a moment later.
        time.sleep(0.3)

    def close(self):
        """Shut down the context."""
        self.node.destroy_node()
        self.context.shutdown()
