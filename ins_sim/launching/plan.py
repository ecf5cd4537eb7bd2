"""
What a launch file starts: processes, their parameter files, and the overrides by its arguments.

Precedence of parameters, later ones override earlier ones: defaults of the nodes, preset of the
motion, preset of the instrument, parameter files in their order, launch arguments. As in every ROS
system the section of one node in any file overrides ``/**`` in all files. The presets therefore
contain only ``/**`` (except ``guided_flight``, whose initial errors are those of one node), and
the launch arguments are in a last file under the full name of each node.
"""

from dataclasses import dataclass
from importlib.util import find_spec

import yaml

from ins_sim import graph
from ins_sim.messages import topics
from ins_sim.ros_parameters import Parameters
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.catalogue import check_value, flatten
from ins_sim.settings.place import Frames
from ins_sim.yaml_text import Dumper, read_bytes
from . import arguments

LOSSES = ('record without lock_step: samples are lost if the machine is too slow; the recorder '
          'reports how many, and with lock_step:=true none are lost')
NO_TRANSFORMS = ('tf2_msgs is not installed (apt: ros-jazzy-tf2-msgs): the nodes publish no '
                 'transforms')


@dataclass(frozen=True)
class Plan:
    """
    The processes that are started, and their parameters.

    Attributes
    ----------
    processes : see ``graph``
    files : paths of parameter files, in order
    defaults : {parameter: value}, overridden by the files
    overrides : {node name: {parameter: value}}, which override the files
    namespace : namespace of the nodes
    said : messages for the user
    """

    processes: tuple
    files: tuple
    defaults: dict
    overrides: dict
    namespace: str = ''
    said: tuple = ()

    @property
    def overrides_text(self):
        """Return the text of a parameter file with the overrides, or '' if there are none."""
        sections = {_full(self.namespace, node): {'ros__parameters': values}
                    for node, values in self.overrides.items() if values}
        return yaml.dump(sections, Dumper=Dumper, sort_keys=False) if sections else ''

    @property
    def named(self):
        """Return the names of processes with one node; in others the nodes keep their names."""
        return {process.name for process in self.processes} - {graph.ONE_PROCESS.name}

    @property
    def default_words(self):
        """Return the ROS arguments with the defaults, which precede the files."""
        return [word for name, value in self.defaults.items() for word in ('-p',
                                                                           f'{name}:={value}')]


def simulation(texts, namespace=''):
    """
    Return the Plan of the launch file ``simulation`` for {argument: text}.

    ``namespace`` is that of the nodes, including the namespaces pushed by including launch files.
    Raises ValueError or OSError.
    """
    value = arguments.read_values(texts, arguments.SIMULATION)
    if value['tf'] == 'aided' and not value['aided']:
        raise ValueError('tf is aided; expected aided:=true with it, because aided_navigator '
                         'publishes map -> odom then')
    files = []
    if value['motion']:
        files.append(arguments.preset_file('motion', value['motion'], arguments.MOTIONS))
    added = (*([graph.RECORDER] if value['record'] else []),
             *(graph.AIDING if value['aided'] else ()))
    nodes = (*added, *graph.PROCESSES)
    overrides = _common(nodes, value)
    if value['one_process']:
        overrides[graph.ONE_PROCESS.name] = {'aided': value['aided']}
    _pace(overrides[graph.MASTER], value, added)
    files, (defaults, said) = (*files, *_files(value)), _transforms(
        'aided' if value['aided'] else 'ins')
    read = _read(files, defaults, namespace)
    if value['record']:
        overrides[graph.RECORDER.name] = {'record.topics': _recorded(value, read),
                                          'storage.path': value['record']}
    if value['record'] and value['lock_step'] is False:
        said = (*said, LOSSES)
    processes = nodes
    if value['one_process']:
        # The recorder is first, because it must exist before the first sample.
        processes = (*(p for p in added if p is graph.RECORDER), graph.ONE_PROCESS)
    return _checked(Plan(processes, files, defaults, overrides, namespace, said))


def replay(texts, namespace=''):
    """
    Return (Plan, graph.Replay, values) of the launch file ``replay`` for {argument: text}.

    For ``namespace`` see ``simulation``. Raises ValueError or OSError.
    """
    value = arguments.read_values(texts, arguments.REPLAY)
    played = graph.REPLAYS[value['source']]
    if value['imu'] and value['source'] == 'imu':
        raise ValueError(f'imu is {value["imu"]!r}, but source:=imu plays the IMU samples of the '
                         'bag; expected source:=truth with it')
    defaults, said = _transforms('ins')
    plan = Plan(played.processes, _files(value), defaults, _common(played.processes, value),
                namespace, said)
    _read(plan.files, plan.defaults, namespace)
    return _checked(plan), played, value


def play_options(value):
    """Return the options of ``ins_sim play`` for the values of the launch file ``replay``."""
    words = [] if value['rate'] is None else ['--rate', repr(value['rate'])]
    if value['lock_step']:
        words += ['--lock-step', 'strapdown']
    if value['loop']:
        words.append('--loop')
    if value['use_sim_time']:
        words.append('--clock')
    return words


def _transforms(source):
    """Return the default of tf.source if transforms can be published, and a message otherwise."""
    if find_spec('tf2_msgs') is None:
        return {}, (NO_TRANSFORMS,)
    return {'tf.source': source}, ()


def _files(value):
    files = []
    if value['imu']:
        files.append(arguments.preset_file('imu', value['imu'], arguments.INSTRUMENTS))
    return (*files, *arguments.parameter_files(value['params_file']))


def _common(processes, value):
    """Return {node: {parameter: value}} of the arguments that apply to all nodes."""
    given = {'frames.prefix': value['prefix'], 'tf.source': value['tf'],
             'rate_hz': value['rate_hz']}
    given = {name: one for name, one in given.items() if one not in ('', None)}
    common = {}
    for process in processes:
        known = flatten(ALL_NODES[process.name])
        common[process.name] = {name: one for name, one in given.items() if name in known}
        if value['use_sim_time']:
            common[process.name]['use_sim_time'] = True
    return common


def _pace(parameters, value, added):
    """Add the parameters by which the generator waits for the other nodes."""
    if value['use_sim_time']:
        parameters['publish_clock'] = True
    waits = value['lock_step']
    if waits is None and value['record']:
        waits = True
    parameters.update({f'pacing.{name}': one for name, one in (
        ('lock_step', waits), ('real_time_factor', value['real_time_factor'])) if one is not None})
    if added:
        parameters['pacing.required'] = ['strapdown', *(process.name for process in added)]


def _full(namespace, node):
    """Return the full name of a node."""
    return '/'.join(['', *(part for part in (namespace.strip('/'), node) if part)])


def _read(files, defaults, namespace):
    """Return {name: value} of the generator as ROS reads the files; refuse invalid files."""
    parameters = Parameters()
    for name, value in defaults.items():
        parameters.add_value('/**', name, value, 'the launch file')
    for path in files:
        parameters.add_file(read_bytes(path), path)
    found = parameters.of(_full(namespace, graph.MASTER))
    return {name: one.value for name, one in found.items()}


def _recorded(value, read):
    """Return the names of the topics to be recorded, without those that are not published."""
    recorded = [topics.RUN, *topics.DATA, *(topics.AIDING if value['aided'] else ())]
    if read.get('motion.kind') == 'guided':
        recorded += topics.GUIDANCE
    if (value['tf'] or read.get('tf.source', 'none')) != 'none':
        recorded += topics.TF, topics.TF_STATIC
    return [topic.name for topic in recorded]


def _checked(plan):
    """Return a Plan; refuse values that a node would refuse, before any node starts."""
    for node, values in plan.overrides.items():
        known = flatten(ALL_NODES[node])
        for name, value in values.items():
            if name in known:
                check_value(name, value, known[name])
        if 'frames.prefix' in values:
            Frames(prefix=values['frames.prefix'])
    return plan
