"""A node of the test process that publishes given messages, for recorder and player."""

import time

from ins_sim.messages import topics
from support.live import GUARD_S


class Talker:
    """Publishes bytes or messages on any topics, in a context of its own."""

    def __init__(self, domain):
        import rclpy
        self.context = rclpy.Context()
        self.context.init(domain_id=domain)
        self.node = rclpy.create_node('talker', context=self.context)
        self._writer = topics.IMU_RAW.writer()

    def publisher(self, message_class, name, reliability='reliable', durability='volatile',
                  depth=1000):
        """Return a publisher of such a quality of service."""
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
        return self.node.create_publisher(message_class, name, QoSProfile(
            depth=depth, reliability=ReliabilityPolicy[reliability.upper()],
            durability=DurabilityPolicy[durability.upper()]))

    def imu(self, name='imu'):
        """Return a publisher of Imu."""
        from sensor_msgs.msg import Imu
        return self.publisher(Imu, name)

    def imu_bytes(self, stamp_ns):
        """Return an Imu message that knows its stamp in its values."""
        return self._writer.pack(stamp_ns, (stamp_ns * 1e-9, 0.0, 0.0), (0.0, 0.0, 9.8))

    def wait_matched(self, *publishers, timeout_s=GUARD_S):
        """Wait until each publisher has a reader."""
        end = time.monotonic() + timeout_s
        while not all(p.get_subscription_count() for p in publishers):
            assert time.monotonic() < end, [p.topic_name for p in publishers]
            time.sleep(0.02)
        # discovery is not symmetric: a reader may know of its publisher a moment later
        time.sleep(0.3)

    def close(self):
        """Leave the domain."""
        self.node.destroy_node()
        self.context.shutdown()
