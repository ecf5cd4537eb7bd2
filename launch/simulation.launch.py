"""
Start the motion generator, the IMU and the strapdown; end when one of them ends.

Example: ros2 launch ins_sim simulation.launch.py params_file:=motion_2 real_time_factor:=10.0
With aided:=true velocity meter, GNSS and aided navigator run too; with params_file:=guided_flight
besides, the aided solution steers the vehicle.  With record:=DIR a recorder writes their topics
into a bag.  Lock-step waits for all of them.
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
    ('aided', 'false', 'true or false: velocity_meter, gnss and aided_navigator run as well'),
    ('record', '', 'folder of a new bag for the topics of the nodes; empty = none'),
    ('use_sim_time', 'false', 'true or false: the nodes take their time from /clock, which the '
                              'generator then publishes'),
    ('prefix', '', 'prefix of all frames, such as uav1; empty = as the parameter files say'),
    ('tf', '', 'who places the vehicle on /tf: none, truth, ins or aided; empty = as the '
               'parameter files say'),
)


def _overrides(process, value):
    """Return the parameters that the launch arguments set for a process."""
    typed = {name: ParameterValue(LaunchConfiguration(name), value_type=kind) for name, kind in (
        ('use_sim_time', bool), ('real_time_factor', float), ('lock_step', bool))}
    parameters = {'use_sim_time': typed['use_sim_time']}
    if process is not graph.RECORDER:
        parameters.update({key: value[name] for name, key in (
            ('prefix', 'frames.prefix'), ('tf', 'tf.source')) if value[name]})
    if process.name == graph.MASTER:
        if value['use_sim_time'].lower() == 'true':
            parameters['publish_clock'] = True
        parameters.update({'pacing.' + name: typed[name]
                           for name in ('real_time_factor', 'lock_step') if value[name]})
        if _added(value):
            parameters['pacing.required'] = ['strapdown', *(p.name for p in _added(value))]
    elif process is graph.RECORDER:
        aiding = (*topics.AIDING, *topics.GUIDANCE) if value['aided'] else ()
        recorded = (topics.RUN, *topics.DATA, *aiding)
        if value['tf'] not in ('', 'none'):
            recorded += topics.TF, topics.TF_STATIC
        parameters['record.topics'] = [topic.name for topic in recorded]
        parameters['storage.path'] = value['record']
    return parameters


def _added(value):
    """Return the processes beside those of every simulation."""
    return (*([graph.RECORDER] if value['record'] else []),
            *(graph.AIDING if value['aided'] else ()))


def _simulation(context):
    """Return the actions, now that the values of the arguments are known."""
    value = {name: LaunchConfiguration(name).perform(context) for name, _, _ in ARGUMENTS}
    if value['aided'] not in ('true', 'false'):
        raise ValueError(f'aided is {value["aided"]!r}; expected true or false')
    value['aided'] = value['aided'] == 'true'
    overlay = [str(resources.parameter_file(value['params_file']))] if value['params_file'] else []
    nodes = {process.name: Node(
        package='ins_sim', executable=process.executable, name=process.name, output='screen',
        parameters=[*(str(resources.config(name)) for name in process.config), *overlay,
                    _overrides(process, value)]) for process in (*_added(value), *graph.PROCESSES)}
    ends = [RegisterEventHandler(OnProcessExit(
        target_action=node, on_exit=[Shutdown(reason=f'{name} has ended')]))
        for name, node in nodes.items()]
    return [*ends,
            GroupAction([PushRosNamespace(value['namespace']), *nodes.values()])]


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription([
        *(DeclareLaunchArgument(name, default_value=default, description=doc)
          for name, default, doc in ARGUMENTS),
        OpaqueFunction(function=_simulation)])
