"""Executable simulation: all nodes of a simulation in one process, connected in memory."""

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
    Contains motion_generator, imu_sensor, strapdown and, if ``aided``, the aiding nodes.

    They have the same names, parameters, topics and services as in separate processes. They also
    compute the same numbers, because they exchange the serialized messages that they publish.
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
        """Yield the publishers of all nodes."""
        yield from super().publishers
        for node in self.members:
            yield from node.publishers

    def run(self, executor, stop):
        """Run the generator until the end or until stop is set; it drives the other nodes."""
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
        """Destroy all nodes."""
        for node in self.members:
            node.destroy_node()
        super().destroy_node()


def _classes(aided):
    # The generator comes first: its loop drives the process.
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
    """Return arguments that keep a member's name if the command line renames the process."""
    if not any(word.startswith(RENAMES) for word in sys.argv):
        return {}
    return {'cli_args': ['--ros-args', '-r', f'__node:={cls.NAME}']}
