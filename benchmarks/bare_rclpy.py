"""
CPU time of the three processes compared with three nodes of plain rclpy on the same topics.

Run it in an environment with rclpy: python benchmarks/bare_rclpy.py [--quick]

The plain nodes are written like the tutorials of ROS: typed messages, one callback for each
message, rclpy's executor. They send the topics of the three processes with nothing but stamps, and
compute nothing. The two alternate, so that other load on the machine affects both.
"""

import argparse
from contextlib import suppress
from statistics import median
import subprocess
import sys
import time

from live_chain import environment, run
import numpy as np

from ins_sim.messages import topics
from ins_sim.ros.transport.qos import message_class

DOMAIN, DEPTH = 92, 1000
# For each node: the topics it reads, the last of which it answers, and those it publishes.
ROLES = {
    'sensor': ((topics.TRUTH_IMU,), (topics.IMU_RAW,)),
    'strapdown': ((topics.TRUTH_ODOMETRY, topics.IMU_RAW),
                  (topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)),
    'generator': ((), topics.TRUTH),
}


class Bare:
    """
    One node of plain rclpy.

    role: key of ROLES.
    """

    def __init__(self, role):
        import rclpy
        rclpy.init()
        self._node = rclpy.create_node(f'bare_{role}')
        heard, sent = ROLES[role]
        self._sent = [(self._node.create_publisher(message_class(t), t.name, DEPTH),
                       message_class(t)()) for t in sent]
        for topic in heard:
            answer = topic is heard[-1]
            self._node.create_subscription(message_class(topic), topic.name,
                                           self._answer if answer else self._hear, DEPTH)

    def _hear(self, message):
        """Receive a message that is not answered."""

    def _answer(self, message):
        self.send(message.header.stamp)

    def send(self, stamp):
        """Publish every topic with a stamp."""
        for publisher, message in self._sent:
            message.header.stamp = stamp
            publisher.publish(message)

    def generate(self, rate_hz, duration_s):
        """Publish all samples that are due."""
        from builtin_interfaces.msg import Time
        start, sent, count = time.monotonic(), 0, round(rate_hz * duration_s) + 1
        while sent < count:
            due = min(count, int((time.monotonic() - start) * rate_hz) + 1)
            for n in range(sent, due):
                sec, rest = divmod(n, rate_hz)
                self.send(Time(sec=sec, nanosec=10**9 * rest // rate_hz))
            sent = due
            time.sleep(0.5 / rate_hz)
        time.sleep(1.0)

    def spin(self):
        """Answer messages until interrupted."""
        import rclpy
        from rclpy.executors import ExternalShutdownException
        with suppress(KeyboardInterrupt, ExternalShutdownException):
            rclpy.spin(self._node)


def start_bare(role, parameters, domain):
    """Start a plain node with the rate and the duration of the parameters."""
    return subprocess.Popen(
        [sys.executable, __file__, '--role', role, '--rate', str(parameters['rate_hz']),
         '--seconds', str(parameters['duration_s'])], env=environment(domain))


def compare(rate_hz, duration_s, rounds):
    """Print the CPU time of both per truth sample that was sent, and their ratio."""
    kinds = {'bare rclpy': {'nodes': tuple(ROLES), 'starter': start_bare}, 'ins_sim': {}}
    cpu, lost, late = ({kind: [] for kind in kinds} for _ in range(3))
    for k in range(rounds):
        for kind in reversed(kinds) if k % 2 else kinds:
            result = run(rate_hz, duration_s, 1, DOMAIN, **kinds[kind])
            cpu[kind].append(1e6 * sum(result.cpu_s.values()) / (rate_hz * duration_s))
            lost[kind].append(result.lost)
            late[kind].append(1e3 * np.percentile(result.latency_s, 99.9))
    for kind in kinds:
        print(f'{rate_hz:6} Hz {kind:11} {median(cpu[kind]):7.0f} us CPU a sample, lost '
              f'{lost[kind]}, p99.9 {median(late[kind]):.1f} ms')
    ratio = median(cpu['ins_sim']) / median(cpu['bare rclpy'])
    print(f'{rate_hz:6} Hz ratio {ratio:.2f} (at most 1.5 asked for)', flush=True)


def main():
    """Print the comparison, or run as one of the plain nodes."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('--quick', action='store_true', help='short runs')
    parser.add_argument('--role', choices=ROLES, help=argparse.SUPPRESS)
    parser.add_argument('--rate', type=float, help=argparse.SUPPRESS)
    parser.add_argument('--seconds', type=float, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.role == 'generator':
        Bare(arguments.role).generate(round(arguments.rate), arguments.seconds)
    elif arguments.role:
        Bare(arguments.role).spin()
    else:
        for rate_hz in (200, 1000, 4000):
            compare(rate_hz, 10 if arguments.quick else 30, 1 if arguments.quick else 3)


if __name__ == '__main__':
    main()
