"""
ROS parameter files (YAML) as the settings of the nodes, or of a study, without ROS.

The offline command line reads the same files as ``ros2 run --ros-args --params-file``: sections
``/**`` and node names, each with ``ros__parameters``; later files and assignments win.
"""

from collections.abc import Mapping
import re

import yaml

from ins_sim.settings.by_node import AIDING, ALL_NODES, NODES
from ins_sim.settings.catalogue import build, flatten, values_of
from ins_sim.settings.simulation import AidedSimulationSettings, SimulationSettings
from ins_sim.settings.suggest import nearest_name, unknown_key

ROS_OWN = ('use_sim_time', 'start_type_description_service')


def read(paths, assignments=()) -> SimulationSettings:
    """
    Return SimulationSettings of parameter files, in order, and of assignments.

    assignments: texts NAME:=VALUE, or {name: value}, whose values are taken as they are.
    A file may serve the recorder as well; its section is checked name by name.

    Raises ValueError (or OSError) in one sentence that names the file, the section and the key.
    """
    return SimulationSettings(**read_nodes(paths, assignments, NODES, ALL_NODES))


def read_aided(paths, assignments=()) -> AidedSimulationSettings:
    """Return AidedSimulationSettings as ``read`` does SimulationSettings."""
    built = read_nodes(paths, assignments, {**NODES, **AIDING}, ALL_NODES)
    simulation = SimulationSettings(**{node: built.pop(node) for node in NODES})
    return AidedSimulationSettings(simulation, **built)


def read_nodes(paths, assignments, nodes, known=None):
    """
    Return {node: its settings} as ``read`` does, for any nodes {name: settings class}.

    A node is here whatever has a section of its own in the files.  known: nodes that may be
    named, by default nodes.
    """
    known = nodes if known is None else known
    values = {node: {} for node in known}
    for path in paths:
        for section, parameters in _sections(path, known):
            for name, value in _flat(parameters).items():
                _assign(values, known, section, name, value, path)
    for name, value, where in _assigned(assignments):
        # NODE:NAME as ROS writes it, for one node
        node, separator, own = name.partition(':')
        section, name = (node, own) if separator and node in known else ('/**', name)
        _assign(values, known, section, name, value, where)
    built = {}
    for node, cls in nodes.items():
        try:
            built[node] = build(cls, values[node])
        except ValueError as error:
            raise ValueError(f'{node}: {error}') from None
    return built


def _assigned(assignments):
    """Yield (name, value, where it is said) of texts NAME:=VALUE or of {name: value}."""
    if isinstance(assignments, Mapping):
        yield from ((name, value, 'values') for name, value in assignments.items())
        return
    for assignment in assignments:
        name, separator, text = assignment.partition(':=')
        if not separator:
            raise ValueError(f'-p {assignment!r} has no ":="; expected NAME:=VALUE')
        yield name, _parse(text, f'-p {assignment}'), '-p'


def _parse(text, where):
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        problem = str(error).replace('\n', ' ')
        raise ValueError(f'{where} is not YAML: {problem}') from None


def _sections(path, nodes):
    try:
        with open(path, encoding='utf-8') as stream:
            text = stream.read()
    except UnicodeDecodeError as error:
        raise ValueError(f'{path} is not UTF-8 text: {error}') from None
    document = _parse(text, path)
    if not isinstance(document, Mapping) or not document:
        raise ValueError(f'{path} holds no parameters; expected sections such as '
                         '"/**: ros__parameters: ..."')
    for section, body in document.items():
        node = _node_of(section, nodes)
        if node is None:
            raise ValueError(f'{path}: unknown section {section!r}; the nearest known one is '
                             f'{nearest_name(section, ["/**", *nodes])!r}')
        if not isinstance(body, Mapping) or list(body) != ['ros__parameters'] or not isinstance(
                body['ros__parameters'], Mapping):
            raise ValueError(f'{path}: section {section!r} expects exactly one mapping, '
                             '"ros__parameters"')
        yield node, body['ros__parameters']


def _node_of(section, nodes):
    """Return the node of a section name ('strapdown', '/ns/strapdown', '/**'), or None."""
    text = str(section)
    if text == '/**':
        return text
    node = text.rsplit('/', 1)[-1]
    return node if node in nodes else None


def _flat(parameters, prefix=''):
    values = {}
    for key, value in parameters.items():
        name = f'{prefix}{key}'
        if isinstance(value, Mapping):
            values.update(_flat(value, name + '.'))
        else:
            values[name] = value
    return values


def _assign(values, nodes, section, name, value, where):
    if name in ROS_OWN or name.startswith('qos_overrides.'):
        return
    known = {node: flatten(cls) for node, cls in nodes.items() if section in ('/**', node)}
    takers = [node for node, names in known.items() if name in names]
    if not takers:
        raise ValueError(f'{where}: {unknown_key(name, set().union(*known.values()))}')
    for node in takers:
        kind = known[node][name].type
        values[node][name] = _number(value) if kind is float else value


def _number(value):
    """Return 1e-3 as the number it is: YAML 1.1, and so PyYAML, takes it for a text."""
    if isinstance(value, str) and re.fullmatch(r'[-+]?\d+e[-+]?\d+', value, re.IGNORECASE):
        return float(value)
    return value


def dump(settings):
    """Return the text of a parameter file with every key of SimulationSettings."""
    return dump_nodes({node: getattr(settings, node) for node in NODES})


def dump_aided(settings):
    """Return the text of a parameter file with every key of AidedSimulationSettings."""
    return dump_nodes({**{node: getattr(settings.simulation, node) for node in NODES},
                       **{node: getattr(settings, node) for node in AIDING}})


def dump_nodes(built):
    """Return the text of a parameter file with every key of {node: its settings}."""
    document = {}
    for node, settings in built.items():
        tree = {}
        for name, value in values_of(settings).items():
            *parents, leaf = name.split('.')
            branch = tree
            for parent in parents:
                branch = branch.setdefault(parent, {})
            branch[leaf] = list(value) if isinstance(value, tuple) else value
        # Wildcard: a bare name would miss a node in a namespace.
        document[f'/**/{node}'] = {'ros__parameters': tree}
    return yaml.safe_dump(document, sort_keys=False)
