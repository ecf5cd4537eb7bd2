"""
Start the motion generator, the IMU and the strapdown; end when the generator ends.

Example: ros2 launch ins_sim simulation.launch.py params_file:=motion_2 real_time_factor:=10.0
With record:=DIR a recorder writes their topics into a bag, and lock-step waits for it as well.
"""

from ins_sim import graph, resources
from ins_sim.messages import topics
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, GroupAction, OpaqueFunction,
                            RegisterEventHandler, Shutdown)
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = (
    ('params_file', '', 'parameter file over the defaults: the name of a shipped one, such as '
                        'motion_2, or a path'),
    ('namespace', '', 'namespace of the nodes'),
    ('real_time_factor', '', 'simulated seconds per second, 0 = as fast as possible; empty = as '
                             'the parameter files say'),
    ('lock_step', '', 'true or false: wait for the consumers; empty = as the parameter files say'),
    ('record', '', 'folder of a new bag for the topics of the nodes; empty = none'),
    ('use_sim_time', 'false', 'true or false: the nodes take their time from /clock'),
)


def _overrides(process, value):
    """Return the parameters that the launch arguments set for a process."""
    typed = {name: ParameterValue(LaunchConfiguration(name), value_type=kind) for name, kind in (
        ('use_sim_time', bool), ('real_time_factor', float), ('lock_step', bool))}
    parameters = {'use_sim_time': typed['use_sim_time']}
    if process.name == graph.MASTER:
        parameters.update({'pacing.' + name: typed[name]
                           for name in ('real_time_factor', 'lock_step') if value[name]})
        if value['record']:
            parameters['pacing.required'] = ['strapdown', graph.RECORDER.name]
    elif process is graph.RECORDER:
        parameters['record.topics'] = [topic.name for topic in topics.DATA]
        parameters['storage.path'] = value['record']
    return parameters


def _simulation(context):
    """Return the actions, now that the values of the arguments are known."""
    value = {name: LaunchConfiguration(name).perform(context) for name, _, _ in ARGUMENTS}
    overlay = [str(resources.parameter_file(value['params_file']))] if value['params_file'] else []
    processes = (*([graph.RECORDER] if value['record'] else []), *graph.PROCESSES)
    nodes = {process.name: Node(
        package='ins_sim', executable=process.executable, name=process.name, output='screen',
        parameters=[*(str(resources.config(name)) for name in process.config), *overlay,
                    _overrides(process, value)]) for process in processes}
    end = OnProcessExit(target_action=nodes[graph.MASTER],
                        on_exit=[Shutdown(reason='the motion generator has ended')])
    return [RegisterEventHandler(end),
            GroupAction([PushRosNamespace(value['namespace']), *nodes.values()])]


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription([
        *(DeclareLaunchArgument(name, default_value=default, description=doc)
          for name, default, doc in ARGUMENTS),
        OpaqueFunction(function=_simulation)])
