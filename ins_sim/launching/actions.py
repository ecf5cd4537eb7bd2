"""Actions of the launch files. Imports launch, and is imported only by the launch files."""

import atexit
from pathlib import Path
from tempfile import NamedTemporaryFile

from ins_sim.graph import play_command
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, EmitEvent, ExecuteProcess, GroupAction,
                            IncludeLaunchDescription, LogInfo, OpaqueFunction,
                            RegisterEventHandler, Shutdown)
from launch.event_handlers import OnProcessExit
from launch.events import matches_action
from launch.events.process import ShutdownProcess
from launch.substitutions import LaunchConfiguration
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions import Node, PushRosNamespace

from . import arguments, plan


def simulation(path):
    """Return the description of the launch file ``simulation``, whose path is given."""
    return _description(path, arguments.SIMULATION, _simulation)


def replay(path):
    """Return the description of the launch file ``replay``, whose path is given."""
    return _description(path, arguments.REPLAY, _replay)


def _description(path, known, make):
    def start(context):
        arguments.check_names(_given(context, path), known)
        return make(context, {argument.name: LaunchConfiguration(argument.name).perform(context)
                              for argument in known})

    return LaunchDescription([
        *(DeclareLaunchArgument(a.name, description=a.doc,
                                **({} if a.default is None else {'default_value': a.default}))
          for a in known),
        OpaqueFunction(function=start)])


def _simulation(context, texts):
    made = plan.simulation(texts, _full(context, texts['namespace']))
    nodes = _nodes(made)
    return [*(LogInfo(msg=sentence) for sentence in made.said), *_ends(nodes, texts),
            GroupAction([PushRosNamespace(texts['namespace']), *nodes.values()])]


def _replay(context, texts):
    made, played, value = plan.replay(texts, _full(context, texts['namespace']))
    nodes = _nodes(made)
    player = ExecuteProcess(name='player', output='screen', cmd=play_command(
        value['bag'], played, plan.play_options(value), made.namespace))
    return [*_ends({'player': player, **nodes}, texts),
            GroupAction([PushRosNamespace(texts['namespace']), *nodes.values()]), player]


def _full(context, namespace):
    """Return the namespace of the nodes, including those pushed by the including files."""
    before = context.launch_configurations.get('ros_namespace', '')
    return '/'.join(part for part in (before.strip('/'), namespace.strip('/')) if part)


def _nodes(made):
    """Return {name: Node} for a Plan."""
    last = []
    if made.overrides_text:
        with NamedTemporaryFile('w', prefix='ins_sim_launch_', suffix='.yaml', delete=False,
                                encoding='utf-8') as stream:
            stream.write(made.overrides_text)
        # The nodes have ended by then.
        atexit.register(Path(stream.name).unlink, missing_ok=True)
        last.append(stream.name)
    return {process.name: Node(
        package='ins_sim', executable=process.executable, output='screen',
        # The nodes in one process keep their names.
        name=process.name if process.name in made.named else None,
        ros_arguments=made.default_words, parameters=[*made.files, *last])
        for process in made.processes}


def _ends(actions, texts):
    """Return the event handlers for the end of each process."""
    return [RegisterEventHandler(OnProcessExit(
        target_action=action, on_exit=_on_end(name, actions, texts)))
        for name, action in actions.items()]


def _on_end(name, actions, texts):
    """Return the handler of the end of a process, which is the end of the run."""
    def ended(event, context):
        if context.is_shutdown:
            return None
        if event.returncode:
            # After this error launch ends all processes, with an exit code other than 0.
            raise RuntimeError(f'{name} ended with exit code {event.returncode}')
        if arguments.BOOLEANS[texts['shutdown'].lower()]:
            return [Shutdown(reason=f'{name} has ended')]
        return [EmitEvent(event=ShutdownProcess(process_matcher=matches_action(action)))
                for other, action in actions.items() if other != name]

    return ended


def _given(context, path):
    """
    Yield the names of the arguments that were given to this launch file.

    Arguments of the including file are visible here too, but are not yielded.
    """
    event = context.get_locals_as_dict().get('event')
    waiting, seen = [getattr(event, 'launch_description', None)], []
    while waiting:
        entity = waiting.pop()
        if entity is None or any(entity is one for one in seen):
            continue
        seen.append(entity)
        if isinstance(entity, IncludeLaunchDescription) and _is_file(entity, path):
            for name, _ in entity.launch_arguments:
                yield perform_substitutions(context, normalize_to_list_of_substitutions(name))
        waiting += (entity.entities if isinstance(entity, LaunchDescription)
                    else getattr(entity, 'get_sub_entities', list)())


def _is_file(include, path):
    return Path(include.launch_description_source.location).resolve() == Path(path).resolve()
