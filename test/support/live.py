"""Node processes and a listener for the tests that communicate over DDS."""

import os
from pathlib import Path
import signal
import subprocess
import sys
import time

from ins_sim import graph, resources
from ins_sim.messages import topics
from ins_sim.messages.cdr import Writer
from support.places import ROOT

# Longest wait of a test for an expected event. Only a hang takes as long, so that no test fails on
# a busy machine.
GUARD_S = 120.0
# Warnings about late messages: on a busy machine, or at the start, when a navigator discovers the
# generator before the velocity meter does, and waits for a fix that is never measured. No message
# is lost by them.
LATENESS = ('no reader on truth/imu', 'waiting for a fix of', 'no fix of', 'continuing without',
            'no message on')


class Chain:
    """Node processes of one ROS domain; ``texts()`` ends them and returns their output."""

    def __init__(self, domain, folder):
        self.environment = {**os.environ, 'ROS_DOMAIN_ID': str(domain),
                            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
                            'PYTHONPATH': str(ROOT)}
        self._folder = Path(folder)
        self.processes = {}

    def start(self, node, parameters=(), arguments=()):
        """Start a node with {name: value} parameters and further ROS arguments."""
        command = [sys.executable, '-m', 'ins_sim.ros.main', node, '--ros-args', *arguments]
        if node == 'motion_generator':
            # Stamps are motion time, independent of the time of day.
            parameters = {'time.epoch': 'fixed', 'time.epoch_s': 0, **dict(parameters)}
        for name, value in dict(parameters).items():
            command += ['-p', f'{name}:={value}']
        return self.run(node, command)

    def start_verb(self, *words):
        """Start a verb of ``ins_sim``."""
        words = [str(word) for word in words]
        return self.run(words[0], [sys.executable, '-m', 'ins_sim', *words])

    def run(self, name, command):
        """Start any command."""
        key = f'{name}_{len(self.processes)}'
        with open(self._folder / key, 'wb') as log:
            self.processes[key] = subprocess.Popen(command, env=self.environment, stdout=log,
                                                   stderr=log)
        return self.processes[key]

    def text(self, process):
        """Return the output of a process so far."""
        key = next(k for k, p in self.processes.items() if p is process)
        return (self._folder / key).read_text()

    def wait_text(self, process, part, timeout_s=GUARD_S):
        """Wait until the output of a process contains a text."""
        end = time.monotonic() + timeout_s
        while part not in self.text(process):
            assert time.monotonic() < end, f'{part!r} not in: {self.text(process)}'
            time.sleep(0.05)

    def end(self):
        """Interrupt the processes that still run; return the exit codes."""
        for process in self.processes.values():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        try:
            return {key: p.wait(GUARD_S) for key, p in self.processes.items()}
        finally:
            for process in self.processes.values():
                process.kill()


def wait_handlers(process, timeout_s=GUARD_S):
    """Wait until a process handles SIGTERM: before that it cannot end cleanly."""
    end = time.monotonic() + timeout_s
    while time.monotonic() < end:
        for line in Path(f'/proc/{process.pid}/status').read_text().splitlines():
            if line.startswith('SigCgt:') and int(line.split()[1], 16) >> 14 & 1:
                return
        time.sleep(0.002)
    raise TimeoutError(f'no handler of SIGTERM within {timeout_s} s')


def warnings_of_loss(texts):
    """Return the warnings and errors in the texts of nodes, without those about lateness."""
    return [line for text in texts for line in text.splitlines()
            if ('WARN' in line or 'FATAL' in line)
            and not any(part in line for part in LATENESS)]


def run_in_real_time(chain, listener, awaited, values, names):
    """
    Run six nodes, the generator last, and record their messages until it has ended.

    awaited: Topics that must have publishers before the generator starts; values: parameters of
    all nodes; names: parameter files. Returns {name: process} of the other nodes, the process of
    the generator, and its running time, s.
    """
    files = [word for name in names for word in ('--params-file', str(resources.config(name)))]
    nodes = {process.name: chain.start(process.executable, values, files)
             for process in (*graph.AIDING, *graph.PROCESSES) if process.name != graph.MASTER}
    for node in nodes.values():
        wait_handlers(node)
    end = time.monotonic() + GUARD_S
    while not all(listener.node.count_publishers(topic.name) for topic in awaited):
        assert time.monotonic() < end, 'the nodes do not appear'
        time.sleep(0.1)
    time.sleep(2.0)
    began = time.monotonic()
    generator = chain.start(graph.MASTER, values, files)
    while generator.poll() is None:
        listener.poll()
        time.sleep(0.1)
    took_s = time.monotonic() - began
    time.sleep(3.5)
    listener.poll()
    return nodes, generator, took_s


class Listener:
    """
    Receive Topics as {topic name: {stamp_ns: doubles}} in a context of its own; raw: their bytes.

    The listener acknowledges, under the name 'listener', every stamp it has received on all
    topics. Topics in ``later`` are not awaited, because their first message follows the
    acknowledgement of sample 0; only their publishers must exist. ``repeats`` counts messages with
    a stamp that was received before.
    """

    def __init__(self, domain, wanted, namespace='', later=()):
        import rclpy
        from ins_sim.ros.transport.qos import ack_publisher
        from ins_sim.ros.transport.backlog import HandQueue
        self.context = rclpy.Context()
        self.context.init(domain_id=domain)
        self.node = rclpy.create_node('listener', context=self.context, namespace=namespace)
        self._queues = [(HandQueue(self.node, topic, 100000), topic.reader(), topic.name)
                        for topic in (*later, *wanted)]
        self.heard = {topic.name: {} for topic in (*later, *wanted)}
        self.raw = {name: {} for name in self.heard}
        self._later = {topic.name for topic in later}
        self.repeats = 0
        self._ack, self._publisher = Writer(topics.HEADER, 'listener'), ack_publisher(self.node)

    def poll(self):
        """Receive the waiting messages."""
        for queue, reader, name in self._queues:
            while (data := queue.take()) is not None:
                stamp_ns, *runs = reader.read(data)
                # Insert last, even if the stamp is repeated because the run was reset.
                self.repeats += self.heard[name].pop(stamp_ns, None) is not None
                self.heard[name][stamp_ns] = sum(runs, ())
                self.raw[name][stamp_ns] = data
        answered = [stamps for name, stamps in self.heard.items() if name not in self._later]
        if all(answered) and all(map(self.node.count_publishers, self._later)):
            common = min(next(reversed(stamps)) for stamps in answered)
            self._publisher.publish(self._ack.pack(common))

    def poll_until(self, condition, timeout_s=GUARD_S):
        """Receive messages until the condition holds."""
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, {k: len(v) for k, v in self.heard.items()}
            self.poll()
            time.sleep(0.02)

    def poll_for(self, length_s):
        """Receive messages for a time that exceeds the delay of a resent message."""
        end = time.monotonic() + length_s
        self.poll_until(lambda: time.monotonic() > end)

    def spin_until(self, condition, timeout_s=GUARD_S):
        """Serve the node's ordinary subscriptions and clients until the condition holds."""
        from rclpy.executors import SingleThreadedExecutor
        executor = SingleThreadedExecutor(context=self.context)
        executor.add_node(self.node)
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, 'timeout'
            executor.spin_once(timeout_sec=0.1)
        executor.remove_node(self.node)
        executor.shutdown()

    def call(self, cls, name, request=None):
        """Call a service and return the response."""
        client = self.node.create_client(cls, name)
        assert client.wait_for_service(GUARD_S)
        future = client.call_async(request or cls.Request())
        self.spin_until(future.done)
        self.node.destroy_client(client)
        return future.result()

    def diagnostics(self):
        """Return a list that is extended by (node, level, message) while the node spins."""
        from diagnostic_msgs.msg import DiagnosticArray
        seen = []
        self.node.create_subscription(
            DiagnosticArray, '/diagnostics',
            lambda array: seen.extend((s.name, s.level, s.message) for s in array.status), 10)
        return seen

    def close(self):
        """Leave the domain."""
        self.node.destroy_node()
        self.context.shutdown()
