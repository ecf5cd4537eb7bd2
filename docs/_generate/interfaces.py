"""Pages of the nodes, the topics and the services."""

import ast
from pathlib import Path

import ins_sim
from ins_sim import entry
from ins_sim.messages.interfaces import INTERFACES, quality
from ins_sim.messages.topic_contents import CONTENTS
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.catalogue import flatten

from .markdown import code, contents, page, table, text

NODES = '''\
`ros2 run ins_sim NAME` starts a node; see also the [services](services.md), the
[topics](topics.md) and the [exit codes](exit_codes.md) of all nodes together.
'''
TOPICS = '''\
Names are relative to the namespace of the nodes unless they begin with `/`. The frames have their
default names; the parameters `frames.*` change them. `topics.depth` is a parameter of each node.
A policy can be changed for each topic by the parameters `qos_overrides.*` of ROS.
'''
SERVICES = '''\
`~` stands for the name of the node: `~/pause` of `motion_generator` is `/motion_generator/pause`.
The parameter services of ROS are not listed.
'''


def pages():
    """Return {path: Markdown} of the pages of nodes, topics and services."""
    found = {f'nodes/{name}.md': _node(name, one) for name, one in INTERFACES.items()}
    found['nodes.md'] = page('Nodes', NODES, *table(('node', 'what it does'), [
        (_node_link(name), text(one.purpose)) for name, one in INTERFACES.items()]),
        *contents(f'nodes/{name}' for name in INTERFACES))
    found['topics.md'] = page('Topics', TOPICS, *_topics())
    found['services.md'] = page('Services', SERVICES, *table(
        ('node', 'service', 'type', 'what it does'),
        [(_node_link(name), *_service(service))
         for name, one in INTERFACES.items() for service in one.services]))
    return found


def _node_link(name):
    return f'[{code(name)}](nodes/{name}.md)'


def _node(name, one):
    """Return the page of a node."""
    lines = [text(one.purpose), '']
    for title, uses in (('Published topics', one.publishes), ('Subscribed topics',
                                                              one.subscribes)):
        if uses:
            lines += [f'## {title}', '', *table(('topic', 'type', 'when'), [
                (_topic_link(use.topic, '../'), code(use.topic.type_name),
                 text(use.condition) or 'always') for use in uses], 'uses')]
    if one.services:
        lines += ['## Services', '', *table(('service', 'type', 'what it does'), [
            _service(service) for service in one.services])]
    if name in ALL_NODES:
        cls = ALL_NODES[name]
        live = ', '.join(map(code, cls.SETTABLE))
        lines += ['## Parameters', '', f'[{len(flatten(cls))} parameters]'
                  f'(../parameters/{name}.md).' + (f' Can be set while the node runs: {live}.'
                                                   if live else ''), '']
    codes = node_exit_codes(name)
    return page(name, *lines, '## Exit codes', '', *table(('code', 'meaning'), [
        (str(number), text(entry.NODE_CODES[number])) for number in codes]))


def _topic_link(topic, up=''):
    return f'[{code(topic.name)}]({up}topics.md#{anchor(topic)})'


def anchor(topic):
    """Return the anchor of a topic on its page, as MyST makes it of the heading."""
    return ''.join(c for c in topic.name.lower() if c.isalnum() or c in '_-')


def _service(service):
    when = f' Only if {text(service.condition)}.' if service.condition else ''
    return code(service.name), code(service.type_name), text(service.meaning) + when


def _topics():
    for topic, words in CONTENTS.items():
        yield from (f'## {topic.name}', '', text(words), '')
        yield f'* Type: {code(topic.type_name)}'
        if topic.frames:
            yield f'* Frame: {", child ".join(map(code, topic.frames))}'
        yield f'* Quality of service: {text(quality(topic))}'
        yield from (f'* {title}: {_users(topic, kind)}' for title, kind in (
            ('Published by', 'publishes'), ('Subscribed to by', 'subscribes')))
        yield ''


def _users(topic, kind):
    """Return the nodes that publish a topic or subscribe to it, as Markdown."""
    if topic.name == '/diagnostics' and kind == 'publishes':
        return 'all nodes'
    names = [(name, use.condition) for name, one in INTERFACES.items()
             for use in getattr(one, kind) if use.topic == topic]
    return ', '.join(_node_link(name) + (f' ({text(condition)})' if condition else '')
                     for name, condition in names) or 'no node of this package'


def node_exit_codes(name):
    """Return the exit codes of a node, from what its class and its base classes name."""
    codes = {entry.OK, entry.BAD_INPUT}
    names = _names_in(name)
    if 'EXIT_FAULT' in names:
        codes.add(entry.FAULT)
    if 'EXIT_CONSUMER' in names:
        codes.add(entry.CONSUMER)
    return sorted(codes)


def _names_in(module):
    """Return the names in a module of ins_sim.ros.nodes, and in those that it imports there."""
    path = Path(ins_sim.__file__).parent / 'ros' / 'nodes' / f'{module}.py'
    tree, found = ast.parse(path.read_text('utf-8')), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            found.add(node.id)
        elif isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
            found |= _names_in(node.module)
    return found
