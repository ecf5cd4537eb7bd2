"""The table of the processes of a simulation, for the launch files and the demo alike."""

from dataclasses import dataclass
import sys


@dataclass(frozen=True)
class Process:
    """A node process: its node name, its executable and the parameter files it always gets."""

    name: str
    executable: str
    config: tuple[str, ...] = ('default',)


# Consumers first, so that the generator finds them waiting; any order works.
PROCESSES = (
    Process('strapdown', 'strapdown'),
    Process('imu_sensor', 'imu_sensor'),
    Process('motion_generator', 'motion_generator'),
)

# The end of this one ends the simulation.
MASTER = 'motion_generator'


def command(process, params_files=(), parameters=(), namespace=''):
    """
    Return the argument list that starts a process without ``ros2 run``.

    ``params_files`` are paths, ``parameters`` pairs of name and value as ROS writes them.
    """
    # The module, and not the script, for where the script is depends on the kind of installation.
    words = [sys.executable, '-m', f'ins_sim.ros.{process.executable}', '--ros-args',
             '-r', f'__node:={process.name}']
    if namespace:
        words += ['-r', '__ns:=/' + namespace.strip('/')]
    for path in params_files:
        words += ['--params-file', str(path)]
    for name, value in parameters:
        words += ['-p', f'{name}:={value}']
    return words
