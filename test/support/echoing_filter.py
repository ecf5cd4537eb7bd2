"""A filter of somebody else, as a process: answers each reading with its stamp."""

import sys

from geometry_msgs.msg import Vector3Stamped
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Imu


class EchoingFilter(Node):
    """Publishes the rate of every reading on filter/rate."""

    def __init__(self, **options):
        super().__init__('echoing_filter', **options)
        self._publisher = self.create_publisher(Vector3Stamped, 'filter/rate', 10)
        self.create_subscription(Imu, 'imu/data_raw', self._on_imu, 10)

    def _on_imu(self, reading):
        self._publisher.publish(Vector3Stamped(header=reading.header,
                                               vector=reading.angular_velocity))


def main():
    """Run until the context ends."""
    rclpy.init(args=sys.argv)
    try:
        rclpy.spin(EchoingFilter())
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
