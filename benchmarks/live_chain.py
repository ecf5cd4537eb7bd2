"""
The live chain as three processes: loss, latency, CPU seconds, steps a second.

Run it in an environment with rclpy: python benchmarks/live_chain.py [--quick]
"""

import argparse
from dataclasses import dataclass
import os
from pathlib import Path
import signal
import subprocess
import sys
import time

from core_step import EVERYTHING
import numpy as np

from ins_sim.messages import topics

ROOT = Path(__file__).resolve().parent.parent
NODES = ('imu_sensor', 'strapdown', 'motion_generator')
# Name, rate in Hz, seconds of motion, real-time factor.
RUNS = (('real time', 100, 20, 1), ('real time', 1000, 60, 1), ('real time', 2000, 60, 1),
        ('tuned gyros', 1000, 60, 1), ('lock-step', 100, 600, 0))
QUICK = (('real time', 1000, 10, 1), ('real time', 2000, 10, 1), ('tuned gyros', 1000, 10, 1),
         ('lock-step', 100, 200, 0))
# Two tuned gyros and every error term except drop-outs, which would count as losses.
TUNED = {**{key: list(value) if isinstance(value, tuple) else value
            for key, value in EVERYTHING.items() if 'drop_out' not in key},
         'input': 'integrated', 'imu_time': 'nominal', 'imu_latency_us': 50.0}


@dataclass
class Result:
    """
    Results of one run, counted from the first solution on.

    expected, received: solutions; latency_s: from the publication of a truth sample to the
    reception of its solution in this process; cpu_s: by process; wall_s: first to last solution.
    """

    expected: int
    received: int
    latency_s: np.ndarray
    cpu_s: dict
    wall_s: float
    codes: dict

    @property
    def lost(self):
        """Return the number of missing solutions."""
        return self.expected - self.received

    @property
    def steps_per_s(self):
        """Return solutions per second of wall time."""
        return (self.received - 1) / self.wall_s


def environment(domain):
    """Return the environment of a private ROS domain on this machine."""
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get('PYTHONPATH'))))
    return {**os.environ, 'ROS_DOMAIN_ID': str(domain), 'PYTHONPATH': path,
            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}


def start(node, parameters=(), domain=91, arguments=(), **kwargs):
    """Start a node process with {name: value} parameters and further ROS arguments."""
    command = [sys.executable, '-m', 'ins_sim.ros.main', node, '--ros-args', *arguments]
    if node == 'motion_generator':
        # Stamps are motion time.
        parameters = {'time.epoch': 'fixed', 'time.epoch_s': 0, **dict(parameters)}
    for name, value in dict(parameters).items():
        command += ['-p', f'{name}:={value}']
    return subprocess.Popen(command, env=environment(domain), **kwargs)


def stop(process, number=signal.SIGINT):
    """End a process; return its exit code and CPU seconds."""
    # Not send_signal, which would reap an ended process and lose its CPU time.
    os.kill(process.pid, number)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_utime + usage.ru_stime


class Listener:
    """
    Receive ins/odometry, and truth/imu if latency is measured, or the Topics named.

    DDS stores when a message was published and when it was received. The queues can therefore be
    read seldom, and this process uses little of the two cores on which the chain runs.
    """

    def __init__(self, domain, truth=True, heard=None):
        import rclpy
        from ins_sim.ros.transport.backlog import HandQueue
        self._context = rclpy.Context()
        self._context.init(domain_id=domain)
        self.node = rclpy.create_node('listener', context=self._context)
        self._heard = heard or (topics.TRUTH_IMU, topics.INS_ODOMETRY)[not truth:]
        self._queues = [(HandQueue(self.node, topic, 100000), topic.reader(()), {})
                        for topic in self._heard]

    def poll(self):
        """Empty the queues."""
        for queue, reader, times in self._queues:
            take, cls = queue.subscription.handle.take_message, queue.subscription.msg_type
            while (taken := take(cls, True)) is not None:
                stamp_ns, = reader.read(taken[0])
                info = taken[1]
                times.setdefault(stamp_ns, (info['source_timestamp'], info['received_timestamp']))

    def stamps(self, topic):
        """Return the received stamps of a Topic."""
        return list(self._queues[list(self._heard).index(topic)][2])

    def wait_for(self, *wanted):
        """Wait until these topics have a publisher and a subscription in addition to this one."""
        end = time.monotonic() + 20.0
        while time.monotonic() < end:
            if all(self.node.count_publishers(t) for t in wanted):
                time.sleep(1.0)
                return
            time.sleep(0.05)
        raise TimeoutError(f'no publisher of {wanted} within 20 s')

    def result(self, dt_ns, samples, ends):
        """Return the Result."""
        truth, solved = self._queues[0][2], self._queues[-1][2]
        stamps = np.array(sorted(solved))
        expected = samples - int(stamps[0] // dt_ns) if len(stamps) else samples
        both = [s for s in solved if s in truth]
        latency = np.array([solved[s][1] - truth[s][0] for s in both]) * 1e-9
        wall_s = (max(r for _, r in solved.values()) - min(s for s, _ in solved.values())) * 1e-9 \
            if solved else float('nan')
        return Result(expected, len(stamps), latency, {n: cpu for n, (_, cpu) in ends.items()},
                      wall_s, {n: code for n, (code, _) in ends.items()})

    def close(self):
        """Shut down the context."""
        self.node.destroy_node()
        self._context.shutdown()


def run(rate_hz, duration_s, real_time_factor, domain=91, nodes=NODES, starter=start,
        **parameters):
    """
    Run the chain once and return its Result.

    nodes: the executables, the one with the generator last, because it starts when the others have
    been discovered. starter: function that starts one of them.
    """
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    parameters = {'rate_hz': float(rate_hz), 'duration_s': float(duration_s),
                  'pacing.real_time_factor': float(real_time_factor), **parameters}
    # In lock-step there is no latency to measure, and a second reader of truth costs time.
    listener, running, ends = Listener(domain, real_time_factor > 0), {}, {}
    try:
        for node in nodes[:-1]:
            running[node] = starter(node, parameters, domain)
        if running:
            listener.wait_for(topics.IMU_RAW.name, topics.INS_ODOMETRY.name)
        generator = running[nodes[-1]] = starter(nodes[-1], parameters, domain)
        while os.waitid(os.P_PID, generator.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
            listener.poll()
            time.sleep(0.1)
        time.sleep(1.0)
        listener.poll()
    finally:
        for node in reversed(list(running)):
            try:
                ends[node] = stop(running[node])
            except ChildProcessError:
                ends[node] = running[node].returncode, float('nan')
    result = listener.result(round(1e9 / rate_hz), round(duration_s * rate_hz) + 1, ends)
    listener.close()
    return result


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--quick', action='store_true', help='short runs')
    arguments = parser.parse_args()
    print(f'{"run":12} {"Hz":>6} {"steps":>8} {"lost":>5} {"p50":>7} {"p99":>7} {"p99.9":>7} '
          f'{"max ms":>7} {"steps/s":>8}   CPU s: generator, sensor, strapdown')
    for name, rate_hz, duration_s, factor in QUICK if arguments.quick else RUNS:
        r = run(rate_hz, duration_s, factor, **(TUNED if name == 'tuned gyros' else {}))
        latency = 4 * '      - '
        if factor:
            latency = ' '.join(f'{1e3 * v:7.2f}' for v in np.percentile(
                r.latency_s, (50, 99, 99.9, 100)))
        print(f'{name:12} {rate_hz:6} {r.received:8} {r.lost:5} {latency} {r.steps_per_s:8.0f}   '
              + ', '.join(f'{r.cpu_s[n]:.1f}' for n in (NODES[2], *NODES[:2])), flush=True)


if __name__ == '__main__':
    main()
