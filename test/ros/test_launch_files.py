"""The launch files, read with stand-ins for launch: what they start is what the table says."""

import runpy
import sys
from types import ModuleType, SimpleNamespace

from ins_sim import graph, resources
from ins_sim.messages import topics
import pytest

MODULES = {
    'launch': ['LaunchDescription'],
    'launch.actions': ['DeclareLaunchArgument', 'ExecuteProcess', 'GroupAction', 'OpaqueFunction',
                       'RegisterEventHandler', 'Shutdown'],
    'launch.event_handlers': ['OnProcessExit'],
    'launch.substitutions': [],
    'launch_ros': [], 'launch_ros.actions': ['Node', 'PushRosNamespace'],
    'launch_ros.parameter_descriptions': ['ParameterValue']}


class Call(SimpleNamespace):
    """What a constructor of launch was called with."""


def stand_in(name):
    """Return a constructor that keeps its arguments."""
    return lambda *words, **named: Call(what=name, words=words, **named)


class Configuration:
    """The value of a launch argument."""

    def __init__(self, name):
        self.name = name

    def perform(self, context):
        """Return it."""
        return context[self.name]


@pytest.fixture
def started(monkeypatch):
    """Return the function that gives the actions of a launch file for some arguments."""
    for module, names in MODULES.items():
        stub = ModuleType(module)
        for name in names:
            setattr(stub, name, stand_in(name))
        monkeypatch.setitem(sys.modules, module, stub)
    sys.modules['launch.substitutions'].LaunchConfiguration = Configuration

    def actions(file, **given):
        content = runpy.run_path(str(resources.launch(file)))
        described = content['generate_launch_description']().words[0]
        values = {a.words[0]: getattr(a, 'default_value', None) for a in described
                  if a.what == 'DeclareLaunchArgument'}
        assert set(given) <= set(values)
        assert all(a.description for a in described if a.what == 'DeclareLaunchArgument')
        found = described[-1].function({**values, **given})
        assert ended_by(found) == {name: f'{name} has ended' for name in flat(found)}
        return flat(found)

    return actions


def ended_by(found):
    """Return the names of the processes whose end ends a launch, of its actions."""
    handlers = [a.words[0] for a in found if a.what == 'RegisterEventHandler']
    assert all(h.what == 'OnProcessExit' and h.on_exit[0].what == 'Shutdown' for h in handlers)
    return {h.target_action.name: h.on_exit[0].reason for h in handlers}


def flat(actions):
    """Return the nodes and processes among actions by name."""
    found = {}
    for action in actions:
        if action.what in ('Node', 'ExecuteProcess'):
            found[action.name] = action
        elif action.what == 'GroupAction':
            found.update(flat(action.words[0]))
    return found


def test_simulation_with_and_without_a_recorder(started):
    """The recorder is one of the consumers, and records what the nodes publish."""
    plain = started('simulation')
    assert set(plain) == {process.name for process in graph.PROCESSES}
    assert 'pacing.required' not in plain[graph.MASTER].parameters[-1]
    nodes = started('simulation', record='bag', lock_step='true')
    assert set(nodes) == {*plain, 'recorder'}
    assert nodes[graph.MASTER].parameters[-1]['pacing.required'] == ['strapdown', 'recorder']
    own = nodes['recorder'].parameters[-1]
    assert own['record.topics'] == [topic.name for topic in (topics.RUN, *topics.DATA)]
    assert own['storage.path'] == 'bag' and nodes['recorder'].executable == 'recorder'


def test_simulated_time_has_a_clock(started):
    """use_sim_time makes the generator publish /clock: three readers need a publisher."""
    for value, expected in (('true', True), ('True', True), ('false', None)):
        nodes = started('simulation', use_sim_time=value)
        clocks = {name: node.parameters[-1].get('publish_clock') for name, node in nodes.items()}
        assert clocks == {**dict.fromkeys(nodes), graph.MASTER: expected}


def test_frames_and_transforms_of_all_nodes(started):
    """One prefix and one source of TF for all; the recorder, which has none, records them."""
    nodes = started('simulation', prefix='uav1', tf='aided', aided='true', record='bag')
    for name, node in nodes.items():
        own = node.parameters[-1]
        given = own.get('frames.prefix'), own.get('tf.source')
        assert given == ((None, None) if name == 'recorder' else ('uav1', 'aided'))
    assert nodes['recorder'].parameters[-1]['record.topics'][-2:] == ['/tf', '/tf_static']
    plain = started('simulation')[graph.MASTER].parameters[-1]
    assert 'frames.prefix' not in plain and 'tf.source' not in plain


def test_aided_simulation(started):
    """All six, each of which lock-step waits for but the sensor, whose work the others show."""
    plain = {process.name for process in graph.PROCESSES}
    aiding = {process.name for process in graph.AIDING}
    assert aiding == {'velocity_meter', 'gnss', 'aided_navigator'}
    nodes = started('simulation', aided='true')
    assert set(nodes) == plain | aiding
    assert all(nodes[name].executable == name for name in aiding)
    parameters = nodes[graph.MASTER].parameters[-1]
    assert set(parameters['pacing.required']) == {'strapdown', *aiding}
    nodes = started('simulation', aided='true', record='bag')
    assert set(nodes) == {*plain, *aiding, 'recorder'}
    parameters = nodes[graph.MASTER].parameters[-1]
    assert set(parameters['pacing.required']) == {'strapdown', 'recorder', *aiding}
    recorded = nodes['recorder'].parameters[-1]['record.topics']
    assert recorded == [t.name for t in (topics.RUN, *topics.DATA, *topics.AIDING,
                                         *topics.GUIDANCE)]
    with pytest.raises(ValueError, match="aided is 'yes'; expected true or false"):
        started('simulation', aided='yes')


def test_replay(started):
    """The nodes behind the source, and the verb that plays into them."""
    for source, names in (('imu', {'strapdown'}), ('truth', {'strapdown', 'imu_sensor'})):
        nodes = started('replay', bag='old', source=source, namespace='left', loop='true')
        assert set(nodes) == {*names, 'player'}
        words = nodes['player'].cmd
        assert words[3:9] == ['play', 'old', '--lock-step', 'strapdown', '--loop', '--topics']
        assert words[9:] == [*graph.REPLAYS[source].topics, '--ros-args', '-r', '__ns:=/left']
    with pytest.raises(ValueError, match="source is 'ins'; expected one of truth, imu"):
        started('replay', bag='old', source='ins')
