"""
Play a bag into the strapdown, or into the IMU and the strapdown; end when the bag or a node
ends.

Example: ros2 launch ins_sim replay.launch.py bag:=DIR source:=truth params_file:=motion_2
"""

from ins_sim import graph, resources
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, ExecuteProcess, GroupAction, OpaqueFunction,
                            RegisterEventHandler, Shutdown)
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = (
    ('bag', None, 'folder of the bag; it has truth/odometry, and truth/imu or imu/data_raw'),
    ('source', 'imu', 'imu: its readings go into the strapdown; truth: its motion goes into the '
                      'IMU, and that into the strapdown'),
    ('params_file', '', 'parameter file over the defaults: the name of a shipped one, such as '
                        'motion_2, or a path'),
    ('namespace', '', 'namespace of the nodes and of what is played'),
    ('rate', '', 'seconds of the bag per second, 0 = as fast as possible; empty = 1, and 0 in '
                 'lock-step'),
    ('lock_step', 'true', 'true or false: wait for the strapdown, so that nothing is lost'),
    ('loop', 'false', 'true or false: begin again at the end'),
    ('use_sim_time', 'false', 'true or false: the nodes take their time from /clock, which is '
                              'then played or published'),
)


def _options(value):
    """Return the options of ``ins_sim play``."""
    words = ['--rate', value['rate']] if value['rate'] else []
    if value['lock_step'] == 'true':
        words += ['--lock-step', 'strapdown']
    if value['loop'] == 'true':
        words.append('--loop')
    if value['use_sim_time'] == 'true':
        words.append('--clock')
    return words


def _replay(context):
    """Return the actions, now that the values of the arguments are known."""
    value = {name: LaunchConfiguration(name).perform(context) for name, _, _ in ARGUMENTS}
    if value['source'] not in graph.REPLAYS:
        raise ValueError(f'source is {value["source"]!r}; expected one of '
                         f'{", ".join(graph.REPLAYS)}')
    replay = graph.REPLAYS[value['source']]
    overlay = [str(resources.parameter_file(value['params_file']))] if value['params_file'] else []
    use_sim_time = ParameterValue(LaunchConfiguration('use_sim_time'), value_type=bool)
    nodes = [Node(
        package='ins_sim', executable=process.executable, name=process.name, output='screen',
        parameters=[*(str(resources.config(name)) for name in process.config), *overlay,
                    {'use_sim_time': use_sim_time}]) for process in replay.processes]
    player = ExecuteProcess(name='player', output='screen', cmd=graph.play_command(
        value['bag'], replay, _options(value), value['namespace']))
    ends = [RegisterEventHandler(OnProcessExit(
        target_action=action, on_exit=[Shutdown(reason=f'{action_name} has ended')]))
        for action_name, action in (('player', player), *zip(
            [process.name for process in replay.processes], nodes))]
    return [*ends,
            GroupAction([PushRosNamespace(value['namespace']), *nodes]), player]


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription([
        *(DeclareLaunchArgument(name, description=doc, **(
            {} if default is None else {'default_value': default}))
          for name, default, doc in ARGUMENTS),
        OpaqueFunction(function=_replay)])
