"""
Read ROS parameter files (YAML) into settings of nodes or studies, without ROS.

The offline commands read the same files as ``ros2 run --ros-args --params-file``, with the same
rules (``ros_parameters``). Assignments of ``-p`` count as if they followed the files.
"""

from collections.abc import Mapping
import warnings

import yaml

from ins_sim.ros_parameters import applies, Parameters
from ins_sim.settings.by_node import AIDING, ALL_NODES, NODES
from ins_sim.settings.catalogue import (build, check_value, flatten, from_ros, is_of_ros,
                                        values_of)
from ins_sim.settings.shown import cut, listed, shown
from ins_sim.settings.simulation import AidedSimulationSettings, SimulationSettings
from ins_sim.settings.suggest import nearest_name, similar_name, unknown_key
from ins_sim.yaml_text import Dumper, read_bytes

ANY_NODE = '/**'
# Number of names in a message about ignored parameters.
MOST_TOLD = 3


def read(paths, assignments=()) -> SimulationSettings:
    """
    Return SimulationSettings from parameter files and assignments.

    A file may have sections for other nodes of ins_sim; the names in them are checked too.

    Parameters
    ----------
    paths : parameter files, in order
    assignments : list of texts NAME:=VALUE, or mapping {name: value} with Python values

    Raises
    ------
    ValueError or OSError
        With one sentence that names the file, the section and the key.
    """
    return SimulationSettings(**read_nodes(paths, assignments, NODES, ALL_NODES))


def read_aided(paths, assignments=()) -> AidedSimulationSettings:
    """Return AidedSimulationSettings; the arguments are those of ``read``."""
    built = read_nodes(paths, assignments, {**NODES, **AIDING}, ALL_NODES)
    simulation = SimulationSettings(**{node: built.pop(node) for node in NODES})
    return AidedSimulationSettings(simulation, **built)


def read_nodes(paths, assignments, nodes, known=None):
    """
    Return {node: settings} from parameter files and assignments, for any nodes.

    A node is here anything with a section of its own in the files, including commands.

    Parameters
    ----------
    paths, assignments : as in ``read``
    nodes : {name: settings class} of the nodes to read
    known : {name: settings class} of the nodes that may occur in files, by default nodes; values
        for them are checked one by one
    """
    known = nodes if known is None else known
    given, named = Parameters(), []
    for path in paths:
        sections = given.add_file(read_bytes(path), str(path))
        if not sections:
            raise ValueError(f'{path} holds no parameters; expected sections such as '
                             '"/**: ros__parameters: ..."')
        _tell_foreign(path, sections, known)
        named += sections
    by_value = isinstance(assignments, Mapping)
    said = [] if by_value else [_add_assignment(given, text, known) for text in assignments]
    _check_sections(given, nodes, known)
    namespace = _namespace(named, given, known)
    values = {node: given.of(f'{namespace}/{node}') for node in known}
    fields = {node: flatten(cls) for node, cls in known.items()}
    _tell_overruled(given, {node: values[node] for node in nodes}, fields, namespace,
                    [*map(str, paths), *said])
    built = {node: {name: from_ros(one.value, fields[node][name])
                    for name, one in values[node].items() if name in fields[node]}
             for node in known}
    if by_value:
        for name, value in assignments.items():
            node, name = _addressed(name, 'values', known)
            takers = _takers(node, name, fields, 'values')
            built.update({taker: {**built[taker], name: value} for taker in takers})
    return {node: _built(node, cls, built[node]) for node, cls in nodes.items()}


def _built(node, cls, values):
    try:
        return build(cls, values)
    except ValueError as error:
        raise ValueError(f'{node}: {error}') from None


def _add_assignment(given, text, known):
    """Add a text NAME:=VALUE or NODE:NAME:=VALUE; return its description for messages."""
    name, separator, value = text.partition(':=')
    if not separator:
        raise ValueError(f'-p {shown(text)} has no ":="; expected NAME:=VALUE')
    where = f'-p {cut(text)}'
    node, name = _addressed(name, where, known)
    _takers(node, name, {n: flatten(cls) for n, cls in known.items()}, '-p')
    given.add_value(node or ANY_NODE, name, value, where)
    return where


def _addressed(name, where, known):
    """Split NAME or NODE:NAME into the node (None for all) and the name."""
    node, separator, own = name.partition(':')
    if not separator:
        return None, name
    if node not in known:
        raise ValueError(f'{where}: {shown(node)} is not a node of ins_sim; the nearest is '
                         f'{nearest_name(node, known)!r}')
    return node, own


def _takers(node, name, fields, where):
    """Return the nodes that have a parameter; raise ValueError if there is none."""
    asked = {node: fields[node]} if node else fields
    takers = [taker for taker, names in asked.items() if name in names]
    if not takers and not is_of_ros(name):
        raise ValueError(f'{where}: {unknown_key(name, set().union(*asked.values()))}')
    return takers


def _node_of(section, known):
    """Return the node of a section: a known one, ANY_NODE for a wildcard, or None."""
    node = section.rpartition('/')[2]
    return ANY_NODE if node in ('*', '**') else node if node in known else None


def _tell_foreign(path, sections, known):
    """Warn about sections of unknown nodes; raise ValueError if a file has no others."""
    foreign = [section for section in sections if _node_of(section, known) is None]
    if not foreign:
        return
    if len(foreign) == len(sections):
        near = nearest_name(foreign[0].rpartition('/')[2], [ANY_NODE, *known])
        raise ValueError(f'{path}: unknown section {shown(foreign[0])}; the nearest known one is '
                         f'{near!r}')
    told = []
    for section in foreign[:MOST_TOLD]:
        near = similar_name(section.rpartition('/')[2], known)
        told.append(cut(section) + (f' (did you mean {near}?)' if near else ''))
    warnings.warn(f'{path}: ignored, because no node of that name reads its parameters here: '
                  f'{listed([*told, *foreign[MOST_TOLD:]], MOST_TOLD)}', stacklevel=4)


def _check_sections(given, nodes, known):
    """
    Raise ValueError on a parameter that no node of its section has.

    Values for known nodes that are not read are checked one by one.
    """
    fields = {node: flatten(cls) for node, cls in known.items()}
    for section, name, one, _ in given.given():
        node = _node_of(section, known)
        if node is None:
            continue
        where = '-p' if one.where.startswith('-p ') else one.where
        _takers(None if node == ANY_NODE else node, name, fields, where)
        if node in known and node not in nodes and name in fields[node]:
            try:
                check_value(name, from_ros(one.value, fields[node][name]), fields[node][name])
            except ValueError as error:
                raise ValueError(f'{where}: {node}: {error}') from None


def _namespace(named, given, known):
    """
    Return the namespace of the sections of known nodes, '' for none; named lists all sections.

    Warns about ignored sections of other namespaces; raises ValueError if there are several
    namespaces and no section without one.
    """
    ours = [section for section in named if _node_of(section, known)]
    found = {section.partition('/*')[0] if '*' in section else section.rpartition('/')[0]
             for section in ours}
    plain = any('*' not in section and section.count('/') == 1 for section in ours)
    named = sorted(found - {''})
    if len(named) > 1 and not plain:
        raise ValueError(f'the sections belong to {len(named)} namespaces, '
                         f'{listed(named, MOST_TOLD)}; expected one vehicle')
    namespace = named[0] if named and not plain else ''
    every = dict.fromkeys([*ours, *(section for section, *_ in given.given())])
    strange = [section for section in every if _node_of(section, known)
               and not any(applies(section, f'{namespace}/{node}') for node in known)]
    if strange:
        warnings.warn(f'ignored, because the nodes are in the namespace {namespace or "/"!r}: '
                      f'{listed(strange, MOST_TOLD)}', stacklevel=4)
    return namespace


def _tell_overruled(given, values, known, namespace, order):
    """
    Warn about files and assignments that have no effect on a node by the rules of ROS.

    Parameters
    ----------
    values : {node: {name: Given}}
    known : {node: names}
    order : files and assignments in the order given
    """
    lost = {}
    for section, name, one, last in given.given():
        for node, winners in values.items():
            if name not in known[node] or not applies(section, f'{namespace}/{node}'):
                continue
            winner = winners[name]
            if order.index(last) > order.index(winner.where) and (
                    one.where != last or one.value != winner.value):
                lost.setdefault((last, winner.where), {}).setdefault(name, []).append(node)
    for (where, winner), names in lost.items():
        nodes = list(dict.fromkeys(node for some in names.values() for node in some))
        what = '' if where.startswith('-p ') else f': {listed(names, MOST_TOLD)}'
        advice = f'; write -p {nodes[0]}:{where[3:]}' if (
            where.startswith('-p ') and ':' not in where.partition(':=')[0]) else ''
        warnings.warn(f'{where}{what}: no effect on {", ".join(nodes)}, because, as in ROS 2, '
                      f'{winner} sets it in a section that comes later, or with another '
                      f'type{advice}', stacklevel=4)


def dump(settings):
    """Return the text of a parameter file with every key of SimulationSettings."""
    return dump_nodes({node: getattr(settings, node) for node in NODES})


def dump_aided(settings):
    """Return the text of a parameter file with every key of AidedSimulationSettings."""
    return dump_nodes({**{node: getattr(settings.simulation, node) for node in NODES},
                       **{node: getattr(settings, node) for node in AIDING}})


def dump_nodes(built):
    """Return the text of a parameter file with every key of {node: settings}."""
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
    return yaml.dump(document, Dumper=Dumper, sort_keys=False)
