"""The launch files, run with stand-ins for launch: what they start, and what ends them."""

import os
import runpy
import sys
from types import ModuleType, SimpleNamespace

from ins_sim import graph, launching, resources
import pytest

MODULES = {
    'launch': ['LaunchDescription'],
    'launch.actions': ['DeclareLaunchArgument', 'EmitEvent', 'ExecuteProcess', 'GroupAction',
                       'IncludeLaunchDescription', 'LogInfo', 'OpaqueFunction',
                       'RegisterEventHandler', 'Shutdown'],
    'launch.event_handlers': ['OnProcessExit'], 'launch.events': [],
    'launch.events.process': ['ShutdownProcess'],
    'launch.substitutions': [], 'launch.utilities': [],
    'launch_ros': [], 'launch_ros.actions': ['Node', 'PushRosNamespace']}


class Call:
    """Replacement for constructors of launch: it stores its arguments."""

    def __init__(self, *words, **named):
        self.what, self.words = type(self).__name__, words
        self.__dict__.update(named)


class Configuration:
    """Replacement for the value of a launch argument."""

    def __init__(self, name):
        self.name = name

    def perform(self, context):
        """Return the value."""
        return context.launch_configurations[self.name]


class Context(SimpleNamespace):
    """Replacement for the context: the values of launch arguments and the current event."""

    is_shutdown = False

    def get_locals_as_dict(self):
        """Return the event being handled, or an empty dict."""
        return {'event': self.event} if self.event else {}


@pytest.fixture
def launch(monkeypatch):
    """Replace launch by stand-ins; return the modules."""
    for module, names in MODULES.items():
        stub = ModuleType(module)
        for name in names:
            setattr(stub, name, type(name, (Call,), {}))
        monkeypatch.setitem(sys.modules, module, stub)
    sys.modules['launch.substitutions'].LaunchConfiguration = Configuration
    sys.modules['launch.events'].matches_action = lambda action: action
    utilities = sys.modules['launch.utilities']
    utilities.normalize_to_list_of_substitutions = list
    utilities.perform_substitutions = lambda context, parts: ''.join(parts)
    forget_actions()
    yield sys.modules
    forget_actions()


def forget_actions():
    """Import the module again, because it keeps the launch of its first import."""
    sys.modules.pop('ins_sim.launching.actions', None)
    vars(launching).pop('actions', None)


def described(file):
    """Return {argument: default} and the function of a launch file."""
    content = runpy.run_path(str(resources.launch(file)))
    actions = content['generate_launch_description']().words[0]
    arguments = [a for a in actions if a.what == 'DeclareLaunchArgument']
    assert all(a.description for a in arguments)
    return {a.words[0]: getattr(a, 'default_value', None) for a in arguments}, \
        actions[-1].function


@pytest.fixture
def started(launch):
    """Return the function that gives the actions of a launch file for some arguments."""
    def actions(file, before=(), event=None, **given):
        values, start = described(file)
        assert set(given) <= set(values)
        return start(Context(launch_configurations={**values, **given, **dict(before)},
                             event=event))

    return actions


def flat(actions):
    """Return the nodes and processes among actions by name."""
    found = {}
    for action in actions:
        if action.what in ('Node', 'ExecuteProcess'):
            found[action.name or action.executable] = action
        elif action.what == 'GroupAction':
            found.update(flat(action.words[0]))
    return found


def handlers(actions):
    """Return {process: handler of its exit} of actions."""
    registered = [a.words[0] for a in actions if a.what == 'RegisterEventHandler']
    assert all(h.what == 'OnProcessExit' for h in registered)
    nodes = {id(action): name for name, action in flat(actions).items()}
    return {nodes[id(h.target_action)]: h.on_exit for h in registered}


def text_of(node):
    """Return the text of the last parameter file of a node."""
    with open(node.parameters[-1], encoding='utf-8') as stream:
        return stream.read()


def test_simulation(started):
    """All nodes have the files, the namespace, and the defaults first."""
    actions = started('simulation', motion='racetrack', imu='imu_tactical_mems', rate_hz='200.0',
                      namespace='left', tf='none', before={'ros_namespace': '/fleet'})
    nodes = flat(actions)
    assert set(nodes) == {process.name for process in graph.PROCESSES}
    for name, node in nodes.items():
        assert node.executable == name and node.package == 'ins_sim' and node.output == 'screen'
        assert [os.path.basename(path) for path in node.parameters[:2]] == [
            'racetrack.yaml', 'imu_tactical_mems.yaml']
        assert f'/fleet/left/{name}:' in text_of(node) and 'rate_hz: 200.0' in text_of(node)
        assert node.ros_arguments in ([], ['-p', 'tf.source:=ins'])
    group, = [a for a in actions if a.what == 'GroupAction']
    assert group.words[0][0].words == ('left',)


def test_one_process_has_no_name(started):
    """The process of all nodes has no name, which ROS would give to all of its nodes."""
    nodes = flat(started('simulation', one_process='true', record='bag'))
    assert set(nodes) == {'simulation', 'recorder'}
    assert nodes['simulation'].name is None and nodes['recorder'].name == 'recorder'


def test_what_is_said(started):
    """Messages of the plan are logged when the launch starts."""
    said = [a.msg for a in started('simulation', record='bag', lock_step='false')
            if a.what == 'LogInfo']
    assert said[-1].startswith('record without lock_step: ')


@pytest.mark.parametrize('file, given, names', [
    ('simulation', {}, {'motion_generator', 'imu_sensor', 'strapdown'}),
    ('replay', {'bag': 'old'}, {'player', 'strapdown'})])
def test_ends(file, given, names, started):
    """The end of the run ends the launch or only its nodes; a failed node ends the launch."""
    context = SimpleNamespace(is_shutdown=False)
    for shutdown in ('true', 'false'):
        actions = started(file, **given, shutdown=shutdown)
        ends, nodes = handlers(actions), flat(actions)
        assert set(ends) == names
        for name, on_exit in ends.items():
            done = on_exit(SimpleNamespace(returncode=0), context)
            if shutdown == 'true':
                assert [a.what for a in done] == ['Shutdown']
                assert done[0].reason == f'{name} has ended'
            else:
                assert [a.what for a in done] == ['EmitEvent'] * (len(names) - 1)
                ended = [a.event.process_matcher for a in done]
                assert ended == [node for other, node in nodes.items() if other != name]
            with pytest.raises(RuntimeError, match=f'^{name} ended with exit code 2$'):
                on_exit(SimpleNamespace(returncode=2), context)
            ending = SimpleNamespace(is_shutdown=True)
            assert on_exit(SimpleNamespace(returncode=2), ending) is None


def test_replay(started):
    """replay starts the nodes downstream of the source, and the player in lock-step with them."""
    for source, names in (('imu', {'strapdown'}), ('truth', {'strapdown', 'imu_sensor'})):
        nodes = flat(started('replay', bag='old', source=source, namespace='left', loop='true',
                             before={'ros_namespace': '/fleet'}))
        assert set(nodes) == {*names, 'player'}
        words = nodes['player'].cmd
        assert words[3:9] == ['play', 'old', '--lock-step', 'strapdown', '--loop', '--topics']
        assert words[9:] == [*graph.REPLAYS[source].topics, '--ros-args', '-r',
                             '__ns:=/fleet/left']


def included(launch, path, names):
    """Return a description that includes a launch file with arguments, as ``ros2 launch`` does."""
    include = launch['launch.actions'].IncludeLaunchDescription(
        launch_description_source=SimpleNamespace(location=str(path)),
        launch_arguments=[(name, 'x') for name in names])
    description = launch['launch'].LaunchDescription()
    description.entities = [include]
    return SimpleNamespace(launch_description=description)


def test_misspelt_arguments_are_refused(started, launch):
    """Misspelt launch arguments are refused, from launch_arguments and from the command line."""
    path = resources.launch('simulation')
    assert started('simulation', event=included(launch, path, ['motion', 'launch-prefix']))
    with pytest.raises(ValueError, match="unknown launch argument 'moton'; the nearest known one "
                                         "is 'motion'"):
        started('simulation', event=included(launch, path, ['moton']))


def test_arguments_of_the_including_file_are_its_own(started, launch):
    """Arguments of a parent launch file are not checked, even if their names are similar."""
    assert started('simulation', event=included(launch, '/elsewhere/parent.launch.py',
                                                ['motions']), before={'motions': 'x'})
    parent = included(launch, '/elsewhere/parent.launch.py', ['motions'])
    inner = included(launch, resources.launch('simulation'), ['moton']).launch_description
    parent.launch_description.entities[0].get_sub_entities = lambda: [inner]
    with pytest.raises(ValueError, match="'moton'"):
        started('simulation', event=parent)
