"""
Entry points of the node executables.

The class of a node is imported only after the signal handlers are installed (``process.runtime``).
"""

from functools import partial
from importlib import import_module
import sys

from ins_sim.entry import BAD_INPUT, end_at_once

# executable: (module in ``nodes``, class)
NODES = {
    'motion_generator': ('motion_generator', 'MotionGeneratorNode'),
    'imu_sensor': ('imu_sensor', 'ImuSensorNode'),
    'strapdown': ('strapdown', 'StrapdownNode'),
    'velocity_meter': ('velocity_meter', 'VelocityMeterNode'),
    'gnss': ('gnss', 'GnssNode'),
    'aided_navigator': ('aided_navigator', 'AidedNavigatorNode'),
    'truth_adapter': ('truth_adapter', 'TruthAdapterNode'),
    'simulation': ('simulation', 'SimulationNode'),
    'recorder': ('recorder', 'RecorderNode'),
    'player': ('player', 'PlayerNode'),
}


def run_node(name, args=None, **options):
    """
    Run a node of NODES as this process and return its exit code.

    Parameters
    ----------
    name : key of NODES
    args : command line with ROS arguments, by default ``sys.argv``
    options : further keyword arguments of the node class
    """
    end_at_once()
    from .process.arguments import answer, with_paths
    from .process.runtime import node_main
    words = sys.argv if args is None else args
    code = answer(name, words)
    if code is not None:
        return code
    return node_main(partial(_load, name), with_paths(words), **options)


def _load(name):
    module, cls = NODES[name]
    return getattr(import_module(f'ins_sim.ros.nodes.{module}'), cls)


# Entry points of the console scripts. The player needs a bag and is started by "ins_sim play".
motion_generator = partial(run_node, 'motion_generator')
imu_sensor = partial(run_node, 'imu_sensor')
strapdown = partial(run_node, 'strapdown')
velocity_meter = partial(run_node, 'velocity_meter')
gnss = partial(run_node, 'gnss')
aided_navigator = partial(run_node, 'aided_navigator')
truth_adapter = partial(run_node, 'truth_adapter')
simulation = partial(run_node, 'simulation')
recorder = partial(run_node, 'recorder')


def main(words):
    """Run the node named by the first word; return its exit code, 2 for an unknown node."""
    if not words or words[0] not in NODES:
        given = f'unknown node {words[0]!r}; ' if words and words[0] != '--help' else ''
        print(f'{given}usage: python -m ins_sim.ros.main NODE [--ros-args ...]; NODE is one of '
              f'{", ".join(NODES)}', file=sys.stderr)
        return BAD_INPUT
    return run_node(words[0], words)


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
