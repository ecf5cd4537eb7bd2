"""The table of the processes of a simulation, for the launch files and the demo alike."""

from dataclasses import dataclass
import sys

from ins_sim.messages import topics


@dataclass(frozen=True)
class Process:
    """A node process: its node name and its executable."""

    name: str
    executable: str


# Consumers first, so that the generator finds them waiting; any order works.
PROCESSES = (
    Process('strapdown', 'strapdown'),
    Process('imu_sensor', 'imu_sensor'),
    Process('motion_generator', 'motion_generator'),
)

# What aids the strapdown solution, and the navigator that is aided.
AIDING = (
    Process('aided_navigator', 'aided_navigator'),
    Process('velocity_meter', 'velocity_meter'),
    Process('gnss', 'gnss'),
)

# The end of this one ends the simulation.
MASTER = 'motion_generator'

RECORDER = Process('recorder', 'recorder')

# All nodes but the recorder in one process.
ONE_PROCESS = Process('simulation', 'simulation')


@dataclass(frozen=True)
class Replay:
    """Topics of a bag, and the processes that run over them instead of live ones."""

    topics: tuple[str, ...]
    processes: tuple[Process, ...]


# by what is taken from the bag beside the true motion, with which the strapdown is compared
REPLAYS = {
    'truth': Replay((topics.TRUTH_ODOMETRY.name, topics.TRUTH_IMU.name), PROCESSES[:2]),
    'imu': Replay((topics.TRUTH_ODOMETRY.name, topics.IMU_RAW.name), PROCESSES[:1]),
}


def process_command(process, params_files=(), parameters=(), namespace='', parent=None):
    """
    Return the argument list that starts a process without ``ros2 run``.

    ``params_files`` are paths, ``parameters`` pairs of name and value as ROS writes them.
    parent: id of the process with which it is to end, or None.
    """
    # The module, and not the script, for where the script is depends on the kind of installation.
    tied = ['ins_sim.ros.main'] if parent is None else ['ins_sim.ros.process.tied', str(parent)]
    words = [sys.executable, '-m', *tied, process.executable, '--ros-args',
             '-r', f'__node:={process.name}']
    words += _in_namespace(namespace)
    for path in params_files:
        words += ['--params-file', str(path)]
    for name, value in parameters:
        words += ['-p', f'{name}:={value}']
    return words


def play_command(bag, replay, options=(), namespace=''):
    """
    Return the argument list that plays what a Replay needs of a bag.

    options: further ones of ``ins_sim play``.
    """
    words = [sys.executable, '-m', 'ins_sim', 'play', str(bag), *options, '--topics',
             *replay.topics]
    return words + (['--ros-args', *_in_namespace(namespace)] if namespace else [])


def _in_namespace(namespace):
    return ['-r', '__ns:=/' + namespace.strip('/')] if namespace else []
