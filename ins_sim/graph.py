"""Table of the processes of a simulation, for the launch files and the demo."""

from dataclasses import dataclass
import sys

from ins_sim.messages import topics


@dataclass(frozen=True)
class Process:
    """A node process: its node name and its executable."""

    name: str
    executable: str


# Consumers first, so that they are ready when the generator starts; any order works.
PROCESSES = (
    Process('strapdown', 'strapdown'),
    Process('imu_sensor', 'imu_sensor'),
    Process('motion_generator', 'motion_generator'),
)

# The aiding sensors and the aided navigator.
AIDING = (
    Process('aided_navigator', 'aided_navigator'),
    Process('velocity_meter', 'velocity_meter'),
    Process('gnss', 'gnss'),
)

# The process whose end ends the simulation.
MASTER = 'motion_generator'

RECORDER = Process('recorder', 'recorder')

# All nodes except the recorder in one process.
ONE_PROCESS = Process('simulation', 'simulation')


@dataclass(frozen=True)
class Replay:
    """Topics of a bag, and the processes that run with them instead of live topics."""

    topics: tuple[str, ...]
    processes: tuple[Process, ...]


# Replays by the data taken from the bag. The true motion is always included, for comparison.
REPLAYS = {
    'truth': Replay((topics.TRUTH_ODOMETRY.name, topics.TRUTH_IMU.name), PROCESSES[:2]),
    'imu': Replay((topics.TRUTH_ODOMETRY.name, topics.IMU_RAW.name), PROCESSES[:1]),
}


def process_command(process, params_files=(), parameters=(), namespace='', parent=None):
    """
    Return the argument list that starts a process without ``ros2 run``.

    Parameters
    ----------
    process : Process
    params_files : paths of parameter files
    parameters : pairs of name and value, as ROS writes them
    namespace : namespace of the node, '' for none
    parent : id of the process whose end also ends this one, or None
    """
    # The module is started, because the path of the script depends on the kind of installation.
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
    Return the argument list that plays the topics of a Replay from a bag.

    options are further options of ``ins_sim play``.
    """
    words = [sys.executable, '-m', 'ins_sim', 'play', str(bag), *options, '--topics',
             *replay.topics]
    return words + (['--ros-args', *_in_namespace(namespace)] if namespace else [])


def _in_namespace(namespace):
    return ['-r', '__ns:=/' + namespace.strip('/')] if namespace else []
