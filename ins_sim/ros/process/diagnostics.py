"""Publish the status of a node on /diagnostics once per second of wall time."""

import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from ..transport.qos_overrides import advertise, unused
from ..transport.wall_timer import wall_timer
from .net import described
from .said import kind, Said, short

RECENT_S = 5.0


class Monitor:
    """
    Counts messages and faults of one node, and publishes them.

    The owner increments ``received`` and ``sent``, and sets ``awaited`` to False while no input
    is expected (a paused or finished run).

    Parameters
    ----------
    node : Node
    input_name : name of the topic that drives the node, or None
    stale_s : silence on that topic after which a warning is logged, s
    """

    def __init__(self, node, input_name=None, stale_s=2.0):
        self.received = self.sent = self.faults = 0
        self.state, self.awaited = 'running', True
        self.last_fault = ''
        self._said = Said(lambda sentence: node.get_logger().warning(sentence))
        self._node, self._input, self._stale_s = node, input_name, stale_s
        self._fault_time = self._seen_time = time.monotonic()
        self._before = (time.monotonic(), 0, 0)
        self._stale, self._told, self._looked = False, None, False
        self._more, self._standing = [], set()
        self._publisher = advertise(node, DiagnosticArray, '/diagnostics', 10)
        wall_timer(node, 1.0, self.publish)

    def add(self, describe):
        """
        Call describe() once per second; it returns a fault or '', and pairs (key, value).

        A fault that persists is logged once, when it begins.
        """
        self._more.append(describe)

    def fault(self, sentence, fatal=False):
        """Count and log a fault; repeated faults of one kind are logged at growing intervals."""
        self.faults += 1
        self.last_fault = sentence = short(sentence)
        self._fault_time = time.monotonic()
        if fatal:
            self._node.get_logger().fatal(sentence)
        else:
            self._said.say(sentence)

    def publish(self):
        """Publish the status."""
        now = time.monotonic()
        last, received, sent = self._before
        if self.received != received or not self.awaited:
            self._seen_time, self._stale = now, False
        name = self._node.get_fully_qualified_name()
        status = DiagnosticStatus(level=DiagnosticStatus.OK, message=self.state, name=name,
                                  hardware_id=name)
        silence = now - self._seen_time
        if not self._looked:
            # At the first call all publishers and subscriptions of the node exist.
            self._looked = True
            self._tell_unused()
        if self._input and self._told != bool(self.received):
            # Logged here and not at the start, where the first log line costs 50 ms of CPU time.
            self._told = bool(self.received)
            self._node.get_logger().info(
                f'{"receiving" if self._told else "waiting for"} {self._input}')
        if self._input and not self.received:
            status.level, status.message = DiagnosticStatus.WARN, (
                f'no message on {self._input} yet')
        elif self._input and self.awaited and silence > self._stale_s:
            status.level, status.message = DiagnosticStatus.WARN, (
                f'no message on {self._input} for {silence:.1f} s; expected a steady stream')
            if self.received and not self._stale:
                self._node.get_logger().warning(status.message)
                self._stale = True
        more = [self._ask(describe) for describe in self._more]
        kinds = {kind(wrong): wrong for wrong, _ in more if wrong}
        for name, wrong in kinds.items():
            if name in self._standing:
                # It was logged when it began and has not ended.
                self.last_fault, self._fault_time = short(wrong), now
            else:
                self.fault(wrong)
        self._standing = set(kinds)
        if self.faults and now - self._fault_time < RECENT_S:
            status.level, status.message = DiagnosticStatus.WARN, self.last_fault
        span = max(now - last, 1e-3)
        status.values = [KeyValue(key=key, value=short(str(value))) for key, value in (
            ('received', self.received), ('sent', self.sent), ('faults', self.faults),
            ('last fault', self.last_fault),
            ('received per second', f'{(self.received - received) / span:.1f}'),
            ('sent per second', f'{(self.sent - sent) / span:.1f}'),
            *(pair for _, values in more for pair in values))]
        self._before = (now, self.received, self.sent)
        array = DiagnosticArray(status=[status])
        array.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(array)

    def _tell_unused(self):
        names = unused(self._node)
        if names:
            self._node.get_logger().info(
                f'{len(names)} qos_overrides belong to no publisher or subscription of this node '
                f'and have no effect here; the first is {short(names[0])}')

    @staticmethod
    def _ask(describe):
        try:
            return describe()
        except Exception as error:
            return described(error), ()
