"""What a node says about itself on /diagnostics, once a second of wall time."""

import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from ..transport.qos_overrides import advertise, unused
from ..transport.wall_timer import wall_timer
from .net import described
from .said import kind, Said, short

RECENT_S = 5.0


class Monitor:
    """
    Counts of one node and its last fault.

    The owner increments ``received`` and ``sent``, and clears ``awaited`` while silence is in
    order.  input_name: what drives the node, or None; it is stale after stale_s in silence.
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
        Let describe() -> (what is wrong or '', [(key, value)]) have its say once a second.

        What stays wrong is logged when it begins.
        """
        self._more.append(describe)

    def fault(self, sentence, fatal=False):
        """Count a fault and log it, each kind once and then more and more rarely."""
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
            # once all of the node is made
            self._looked = True
            self._tell_unused()
        if self._input and self._told != bool(self.received):
            # here and not at the start, where the first log line would cost 50 ms of CPU
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
                # said when it began, and true until it ends
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
                f'{len(names)} qos_overrides are of no publisher and no subscription of this '
                f'node, {short(names[0])} the first: not used here')

    @staticmethod
    def _ask(describe):
        try:
            return describe()
        except Exception as error:
            return described(error), ()
