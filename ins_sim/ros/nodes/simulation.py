"""Executable simulation: the nodes of a simulation in one process, joined in memory."""

import sys

from rclpy.node import Node

from ins_sim.core.numerics.compilation import plain_only
from ins_sim.settings.node import OneProcessSettings
from ..process.parameters import declare_settings
from ..transport.hand_over import HandOver
from .imu_sensor import ImuSensorNode
from .motion_generator import MotionGeneratorNode
from .strapdown import StrapdownNode

RENAMES = ('__node:=', '__name:=')


class SimulationNode(Node):
    """
    Holds the nodes motion_generator, imu_sensor, strapdown and, if ``aided``, those of the aids.

    They have the names, parameters, topics and services that they have as processes of their
    own, and the numbers too, for they hand over the bytes that they publish.
    """

    NAME = 'simulation'

    def __init__(self, stop=None, **kwargs):
        super().__init__(self.NAME, **kwargs)
        settings = declare_settings(self, OneProcessSettings)
        self.hand_over, self.members = HandOver(), []
        try:
            for cls in _classes(settings.aided):
                self.members.append(cls(stop=stop, hand_over=self.hand_over, **kwargs,
                                        **_named(cls)))
            self.hand_over.connect()
        except BaseException:
            self.destroy_node()
            raise

    @property
    def publishers(self):
        """Return the publishers of all nodes."""
        yield from super().publishers
        for node in self.members:
            yield from node.publishers

    def run(self, executor, stop):
        """Let the generator work until the end or until stop is set; the others follow it."""
        for node in self.members:
            executor.add_node(node)
        self.members[0].run(executor, stop)

    def step(self):
        """Send the next sample of the truth; return its stamp, or None at the end of the run."""
        with plain_only():
            return self.members[0].step()

    def repeat_first(self):
        """Send sample 0 again."""
        self.members[0].repeat_first()

    def destroy_node(self):
        """Leave the graph, all nodes."""
        for node in self.members:
            node.destroy_node()
        super().destroy_node()


def _classes(aided):
    # the generator first: it is the one that runs
    yield from (MotionGeneratorNode, ImuSensorNode)
    if aided:
        # Imported lazily: a simulation without them starts faster.
        from .gnss import GnssNode
        from .velocity_meter import VelocityMeterNode
        yield from (VelocityMeterNode, GnssNode)
    yield StrapdownNode
    if aided:
        from .aided_navigator import AidedNavigatorNode
        yield AidedNavigatorNode


def _named(cls):
    """Return the arguments that keep the name of a node where the process is given one."""
    if not any(word.startswith(RENAMES) for word in sys.argv):
        return {}
    return {'cli_args': ['--ros-args', '-r', f'__node:={cls.NAME}']}
