"""
A process that replaces another simulator: it publishes only nav_msgs/Odometry.

Arguments: a motion of ``other_simulators.MOTIONS``, rate in Hz, length in s, and whether it uses
lock-step (it then waits for the acknowledgements of truth_adapter) or real time.
"""

import sys
import time

import rclpy

from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader
from ins_sim.ros.lock_step.pacing import LockStep, Pace
from ins_sim.ros.transport import qos
from ins_sim.ros.transport.backlog import HandQueue
from ins_sim.ros.transport.repairs import drain_publishers
from support.live import GUARD_S
from support.other_simulators import OtherSimulator

DEPTH = 10000
WINDOW = 50


def odometry(simulator):
    """Return the messages of an OtherSimulator, a list of bytes."""
    pack = topics.OTHER_ODOMETRY.writer().pack
    return [pack(t_ns, (*r, *q), (*v, *w)) for t_ns, r, q, v, w in simulator.samples()]


def main(name, rate_hz, length_s, lock_step):
    """Publish the motion; return the exit code."""
    simulator = OtherSimulator(name, rate_hz, length_s)
    messages, t_ns = odometry(simulator), simulator.t_ns.tolist()
    rclpy.init()
    node = rclpy.create_node('stand_in')
    publisher = qos.make_publisher(node, topics.OTHER_ODOMETRY, DEPTH)
    acks, reader = HandQueue(node, topics.ACK, DEPTH), Reader(topics.HEADER)
    lock = LockStep(('truth_adapter',), WINDOW, GUARD_S) if lock_step else None
    pace = Pace(0.0 if lock_step else 1.0, 1.0 / rate_hz)
    while not publisher.get_subscription_count():
        time.sleep(0.02)
    time.sleep(0.3)
    pace.anchor(0)
    sent = 0
    while sent < len(messages) or (lock and not lock.done(sent)):
        allowed = pace.allowed()
        if lock:
            while (data := acks.take()) is not None:
                stamp_ns, _ = reader.read(data)
                lock.ack(reader.strings(data)[0], t_ns.index(stamp_ns)
                         if stamp_ns in t_ns else -1, sent)
            allowed = lock.allowed()
            if lock.repeat_due(sent):
                publisher.publish(messages[0])
            if lock.overdue(sent):
                return 3
        for k in range(sent, int(min(allowed, len(messages)))):
            publisher.publish(messages[k])
            sent += 1
        time.sleep(1e-3)
    drain_publishers([publisher])
    node.destroy_node()
    rclpy.shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), sys.argv[4] == 'lock_step'))
