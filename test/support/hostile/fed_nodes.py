"""
Real node objects joined by a message bus in this process, which replaces DDS at its interfaces.

No test waits: the tests advance the clock. Messages published by the nodes are checked, and
delivered to the nodes that read them.
"""

from collections import defaultdict, deque
from contextlib import ExitStack
from dataclasses import replace
from functools import lru_cache
import math
import struct
import sys
from types import SimpleNamespace
from unittest import mock

from ins_sim.messages import topics, velocity_record
from ins_sim.messages.cdr import LAYOUTS, Reader, stamp_of

# Replaces tf2_msgs, which the ROS packages of PyPI lack; the bus carries only bytes.
STAND_IN = 'std_msgs/msg/Header'
TOPICS = {topic.name: topic for topic in (
    *topics.DATA, *topics.BESIDE, *topics.AIDING, *topics.GUIDANCE, topics.ACK,
    topics.CLOCK_TOPIC)}


class ToldClock:
    """Replaces the module ``time``: time passes by ``pass_by`` and ``sleep`` only."""

    def __init__(self):
        self.now_s, self.timers = 1e6, []

    def monotonic(self):
        """Return the time, s."""
        return self.now_s

    def time_ns(self):
        """Return the time, ns."""
        return round(1e9 * self.now_s)

    def sleep(self, nap_s):
        """Advance the time by a sleep."""
        self.now_s += nap_s

    def pass_by(self, step_s):
        """Advance the time and call the timers that are due."""
        self.now_s += step_s
        for timer in self.timers:
            timer.call_if_due()


class ToldTimer:
    """Replaces a wall timer."""

    def __init__(self, clock, period_s, callback):
        self._clock, self._period_s, self._callback = clock, period_s, callback
        self.reset()
        clock.timers.append(self)

    def reset(self):
        """Start a new period at the present time."""
        self._due_s = self._clock.now_s + self._period_s

    def cancel(self):
        """Disable the timer until the next reset."""
        self._due_s = math.inf

    def call_if_due(self):
        """Call the callback if the period has elapsed."""
        if self._clock.now_s >= self._due_s:
            self.reset()
            self._callback()


class Bus:
    """
    Delivers bytes from publishers to queues, and checks the messages that nodes publish.

    ``sent`` counts messages by topic, ``newest_ns`` has the last stamp of each topic, ``wrong``
    collects messages with values that are not finite. ``listen(name, data)`` is called with every
    message that a node publishes.
    """

    def __init__(self, clock):
        self.clock, self.listen = clock, lambda name, data: None
        self.sent, self.newest_ns, self.wrong = defaultdict(int), {}, []
        self._queues, self._numbers = defaultdict(list), defaultdict(int)
        self._driven = []

    def make_publisher(self, node, topic, depth):
        """Return a replacement for the publisher of a Topic."""
        return SimpleNamespace(publish=lambda data: self._publish(topic.name, data),
                               get_subscription_count=lambda: 1,
                               wait_for_all_acked=lambda _: True, topic_name=topic.name)

    def join(self, queue, name, is_driving):
        """
        Feed a queue of a node with the messages of a topic, in place of those received by DDS.
        """
        waiting = deque()
        queue._take = lambda cls, raw: waiting.popleft() if waiting else None
        self._queues[name].append(waiting)
        if is_driving:
            queue._linger_s = 0.0
            self._driven.append((waiting, queue))

    def _publish(self, name, data):
        self.sent[name] += 1
        self.newest_ns[name] = stamp_of(data)
        reason = not_finite(name, data)
        if reason:
            self.wrong.append((name, reason))
        self.listen(name, data)
        self.put(name, data)

    def put(self, name, data):
        """Deliver a message, from a node or from a test."""
        self._numbers[name] += 1
        info = {'publication_sequence_number': self._numbers[name],
                'received_timestamp': self.clock.time_ns()}
        for waiting in self._queues[name]:
            waiting.append((data, info))

    def drive(self):
        """Wake the nodes until no message that triggers a computation is waiting."""
        busy = True
        while busy:
            busy = False
            for waiting, queue in self._driven:
                if waiting:
                    queue._wake(*waiting.popleft())
                    busy = True


def not_finite(name, data):
    """Return the values of a published message that are not finite, as text, or ''."""
    topic = TOPICS.get(name)
    if topic is None:
        return ''
    if topic == topics.METER_RECORD:
        fix = velocity_record.read_fix(data, 0)
        values = (*fix.velocity, *fix.sigma, fix.tan_alpha, *fix.tau, *fix.g) if fix.valid else ()
    else:
        unpack, size = _doubles(topic.type_name)
        values = unpack(data, len(data) - size)
        if math.isfinite(sum(values)):
            return ''
        if topic.type_name == topics.FIX and Reader(topics.FIX).numbers(data)[0] < 0:
            # By convention a receiver without a fix publishes a position of NaN.
            values = values[3:]
    return '' if all(map(math.isfinite, values)) else str(values)


@lru_cache(maxsize=None)
def _doubles(type_name):
    """Return a function that unpacks the doubles of a message, and their offset from its end."""
    layout = LAYOUTS[type_name]
    found = struct.Struct(f'<{layout.doubles}d')
    return found.unpack_from, found.size + layout.fix


class Log:
    """Replaces the logger of a node: counts lines and keeps the last ones."""

    def __init__(self):
        self.lines, self.longest, self.kept = 0, 0, deque(maxlen=200)

    def say(self, sentence, **more):
        """Record a line."""
        self.lines += 1
        self.longest = max(self.longest, len(sentence))
        assert sentence.isprintable(), sentence
        self.kept.append(sentence)

    info = warning = error = fatal = debug = say


class FedNodes:
    """
    Nodes of the table of executables, joined by a Bus; a context manager.

    parameters: {node: {name: value}}. ``nodes`` and ``logs`` hold the node and its Log by name.
    """

    def __init__(self, parameters):
        self._parameters = parameters
        self.clock = ToldClock()
        self.began_s = self.clock.now_s
        self.bus = Bus(self.clock)
        self.nodes, self.logs = {}, {}

    def __enter__(self):
        with ExitStack() as stack:
            self._start(stack)
            # From here on __exit__ cleans up; if starting fails, the stack does it immediately.
            self._ends = stack.pop_all()
        return self

    def __exit__(self, *exception):
        self._ends.close()

    def _start(self, stack):
        import rclpy
        from ins_sim.core.numerics.compilation import plain_only
        from ins_sim.ros.lock_step import pacing, release, steerer
        from ins_sim.ros.nodes import truth_adapter
        from ins_sim.ros.process import announced, diagnostics, said
        from ins_sim.ros.transport import backlog, patience, qos

        def patch(owner, name, value):
            stack.enter_context(mock.patch.object(owner, name, value))

        # As in node processes: plain Python, because a live node must not stop to compile.
        stack.enter_context(plain_only())
        self._context = rclpy.Context()
        self._context.init()
        stack.callback(self._context.try_shutdown)
        for module in (announced, diagnostics, said, backlog, patience, pacing, release, steerer):
            patch(module, 'time', self.clock)
        for module in (diagnostics, patience, truth_adapter):
            patch(module, 'wall_timer', lambda _, period_s, callback: ToldTimer(
                self.clock, period_s, callback))
        patch(qos, 'make_publisher', self.bus.make_publisher)
        class_of = qos.message_class
        patch(qos, 'message_class', lambda topic: class_of(
            replace(topic, type_name=STAND_IN) if topic.type_name == topics.TRANSFORMS else topic))
        for name, parameters in self._parameters.items():
            self._make(stack, name, parameters)

    def _make(self, stack, name, parameters):
        from rclpy.parameter import Parameter
        from ins_sim.ros import main
        node = main._load(name)(context=self._context, parameter_overrides=[
            Parameter(key, value=value) for key, value in parameters.items()])
        stack.callback(node.destroy_node)
        self.nodes[name], self.logs[name] = node, Log()
        node.get_logger = lambda: self.logs[name]
        if hasattr(node, '_queue'):
            self.bus.join(node._queue, node.DRIVER.name, True)
        if hasattr(node, 'hand_queues'):
            for topic, queue in node.hand_queues().items():
                self.bus.join(queue, topic, hasattr(queue, '_wake'))
        if hasattr(node, 'recorder'):
            for topic, track in node.recorder.tracks.items():
                self.bus.join(track.queue, topic.lstrip('/'), False)
        broadcaster = getattr(node, 'broadcaster', None)
        if broadcaster is not None and broadcaster.queue is not None:
            self.bus.join(broadcaster.queue, topics.TF.name, False)
        if getattr(node, '_drive', None) is not None and node._drive._static is not None:
            self.bus.join(node._drive._static, topics.TF_STATIC.name, False)
        if getattr(node, '_acks', None) is not None:
            self.bus.join(node._acks, topics.ACK.name, False)


def held_bytes(thing, seen=None):
    """
    Return the size of an object in bytes, including all containers and objects of ins_sim it
    holds.
    """
    seen = set() if seen is None else seen
    total, todo = 0, [thing]
    while todo:
        one = todo.pop()
        if id(one) in seen:
            continue
        seen.add(id(one))
        total += sys.getsizeof(one, 0)
        if isinstance(one, dict):
            todo += [*one.keys(), *one.values()]
        elif isinstance(one, (list, tuple, set, frozenset, deque)):
            todo += one
        elif type(one).__module__.startswith('ins_sim'):
            todo += getattr(one, '__dict__', {}).values()
    return total
