"""Nodes of the test process that receive the truth of a racetrack, without DDS."""

from support.hostile.fed_nodes import FedNodes

from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
from ins_sim.messages.run_announcement import RunAnnouncement
from ins_sim.ros.lock_step.truth_source import TruthSource
from ins_sim.settings.catalogue import build
from ins_sim.settings.motion import MotionGeneratorSettings

MOTION = {'motion.kind': 'racetrack'}
FLIGHT = {'rate_hz': 100.0, 'time.epoch': 'fixed', 'time.epoch_s': 0, **MOTION}


class Flown(FedNodes):
    """Nodes that receive the truth of a racetrack; ``heard`` has the messages of each topic."""

    def __init__(self, **nodes):
        super().__init__(nodes)
        self._source = TruthSource(build(MotionGeneratorSettings, FLIGHT))
        self._k, self.heard = 0, {}

    def __enter__(self):
        super().__enter__()
        self.bus.listen = lambda name, data: self.heard.setdefault(name, []).append(data)
        for node in self.nodes.values():
            node._announced.take(RunAnnouncement(0, 0, 100.0, 3600 * SECOND).pack())
        return self

    def fly(self, count):
        """Send a number of samples."""
        for _ in range(count):
            for topic, data in zip(topics.TRUTH, self._source.messages(self._k)):
                self.bus.put(topic.name, data)
            self._k += 1
            self.clock.pass_by(0.01)
            self.bus.drive()

    def said(self, node):
        """Return the log messages of a node."""
        return '\n'.join(self.logs[node].kept)
