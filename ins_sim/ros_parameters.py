"""
Read parameter files and assignments by the rules of rcl of ROS 2 Jazzy, without ROS.

In ROS, rcl_yaml_param_parser (parse.c), rcl (arguments.c) and rclpy (node.cpp) determine the
parameters of a node.  The same rules are followed here, including the surprising ones:

* Sections count in the order in which their names first appear, and an assignment without a node
  belongs to ``/**``.  Therefore the section of a node that follows ``/**`` overrides ``-p``.
* A name can have a value of each type at the same time, and that of the first type in KINDS wins:
  ``x: 2.0`` does not override ``x: 1``.
* A nested name is always a new entry, a dotted one replaces an earlier entry of that name.
* There are no aliases and no null, and all values of a list have the same type.

A test compares names, types, values and errors with those of rclpy.
"""

from dataclasses import dataclass
import re

import yaml

from ins_sim.settings.shown import shown
from ins_sim.yaml_text import events, line_of, scalar

PARAMS_KEY = 'ros__parameters'
# The types of values in the order of precedence.
KINDS = (bool, int, float, str, (bool,), (int,), (float,), (str,))
NAMES = {bool: 'truth values', int: 'whole numbers', float: 'numbers with a point', str: 'texts'}
LONGEST_PART, LONGEST_NODE = 244, 255
_WORD = re.compile(r'[A-Za-z_][A-Za-z0-9_]*')


class Parameters:
    """Sections with their parameters, in the order in which they were given."""

    def __init__(self):
        self._sections = {}

    def add_file(self, content, where):
        """
        Add the sections of a parameter file and return their names.

        ``content`` is the bytes of the file, ``where`` its name in messages.
        """
        file = _File(self._sections, where)
        try:
            file.read(content)
        except ValueError as error:
            raise ValueError(f'{where} {error}') from None
        return list(file.named)

    def add_value(self, section, name, text, where):
        """Add the value of a parameter, as YAML; ``where`` describes its source in messages."""
        try:
            if not text:
                raise ValueError('has no value')
            reader = _Values(where)
            entries = self._sections.setdefault(section, [])
            entry = entries[_find(entries, name)]
            entry.where = where
            for event in events(text):
                if isinstance(event, yaml.ScalarEvent):
                    reader.value(event, entry)
                elif isinstance(event, yaml.SequenceStartEvent):
                    reader.begin_list()
                elif isinstance(event, yaml.SequenceEndEvent):
                    reader.listed = False
                elif isinstance(event, (yaml.AliasEvent, yaml.CollectionStartEvent)):
                    raise ValueError('is neither a single value nor a list')
        except ValueError as error:
            raise ValueError(f'{where} {error}') from None

    def given(self):
        """
        Yield full name of the section, name, Given and last source of each entry, in order.

        If a name occurs more than once in a section, the last entry counts.
        """
        for section, entries in self._sections.items():
            for entry in entries:
                yield absolute(section), entry.name, entry.winner(), entry.where

    def of(self, node):
        """Return {name: Given} of a node with the full name node, such as '/imu1/strapdown'."""
        return {name: one for section, name, one, _ in self.given() if applies(section, node)}


@dataclass(frozen=True)
class Given:
    """A value (None for an empty list or mapping) and its source."""

    value: object
    where: str


class _Entry:
    """A parameter that can have a value of each type at the same time."""

    def __init__(self, name):
        self.name, self.where, self.places = name, '', {}

    def winner(self):
        for kind in KINDS:
            if kind in self.places:
                return self.places[kind]
        return Given(None, self.where)


def absolute(section):
    """Return the name of a section with a leading slash."""
    return section if section.startswith('/') else f'/{section}'


def applies(section, node):
    """Return whether a section applies to a node (full names; ``/*`` is one name, ``/**`` any)."""
    pattern = section.replace('/*', r'(/\w+)')
    return re.fullmatch(pattern, node, re.ASCII) is not None


def _find(entries, name):
    """Return the index of the first entry with a name; add one if there is none."""
    for number, entry in enumerate(entries):
        if entry.name == name:
            return number
    entries.append(_Entry(name))
    return len(entries) - 1


class _Values:
    """Reader of values, single or in a list."""

    def __init__(self, where):
        self._where = where
        self.listed, self._kind = False, None

    def begin_list(self):
        self.listed, self._kind = True, None

    def value(self, event, entry):
        if event.style not in ('"', "'") and not event.value:
            raise ValueError(f'has no value at {line_of(event)}; expected one')
        value = scalar(event)
        kind = type(value)
        entry.where = self._where
        if not self.listed:
            entry.places[kind] = Given(value, self._where)
            return
        if self._kind is None:
            self._kind = kind
            entry.places[kind,] = Given([], self._where)
        elif kind is not self._kind or (kind,) not in entry.places:
            raise ValueError(
                f'has {shown(event.value)} in a list of {NAMES[self._kind]} at {line_of(event)}, '
                f'{shown(entry.name)}; ROS expects values of one type, such as [1.0, 0.0, 0.0]')
        entry.places[kind,].value.append(value)


class _File:
    """State of the file parser of rcl: names of node and parameter, and what comes next."""

    def __init__(self, sections, where):
        self._sections, self._where = sections, where
        self.named = {}
        self._values = _Values(where)
        self._key_next, self._in_parameters, self._new_map = True, False, False
        self._depth = 0
        self._node, self._group = _Path('/'), _Path('.')
        # rcl keeps the index of the parameter, even from one section to the next.
        self._entries, self._number = [], 0

    def read(self, content):
        for event in events(content):
            if isinstance(event, yaml.ScalarEvent):
                self._on_scalar(event)
            elif isinstance(event, yaml.SequenceStartEvent):
                if self._key_next:
                    raise ValueError(f'has a list as a key at {line_of(event)}; expected a name')
                if not self._in_parameters:
                    raise ValueError(_before(event))
                self._values.begin_list()
            elif isinstance(event, yaml.SequenceEndEvent):
                self._values.listed, self._key_next = False, True
            elif isinstance(event, yaml.MappingStartEvent):
                self._depth += 1
                # The mapping of ros__parameters itself is not a group.
                self._new_map = not (self._in_parameters
                                     and self._depth - self._node.count == 3)
                self._key_next = True
            elif isinstance(event, yaml.MappingEndEvent):
                self._end_mapping()
            elif isinstance(event, yaml.AliasEvent):
                raise ValueError(f'has an alias at {line_of(event)}; ROS allows none in a '
                                 'parameter file')

    def _on_scalar(self, event):
        if not self._key_next:
            if not self._in_parameters or not self._entries:
                raise ValueError(_before(event))
            named = self._number < len(self._entries)
            self._values.value(event, self._entries[self._number] if named else _Entry(''))
            self._key_next = not self._values.listed
            return
        name = event.value.partition('\0')[0]
        if not event.value:
            raise ValueError(f'has an empty key at {line_of(event)}; expected a name')
        if self._in_parameters:
            self._on_name(name, event)
        elif not name.startswith(PARAMS_KEY):
            self._node.add(name)
        elif not self._node.count:
            raise ValueError(f'has no node name before {PARAMS_KEY} at {line_of(event)}')
        else:
            section = self._node.text
            _check_section(section, event)
            self._entries = self._sections.setdefault(section, [])
            self.named[absolute(section)] = True
            self._node.remove()
            self._in_parameters = True
        self._key_next = False

    def _on_name(self, name, event):
        if self._new_map:
            if self._number >= len(self._entries):
                raise ValueError(f'has a mapping without a name at {line_of(event)}')
            self._group.replace(self._entries[self._number].name)
            self._new_map = False
        group = self._group.text
        self._number = _find(self._entries, name if group is None else group)
        entry = self._entries[self._number]
        entry.where = self._where
        if group is not None:
            # A group is an entry of its own until its first name is added to it.
            entry.name = f'{group}.{name}'

    def _end_mapping(self):
        if self._in_parameters:
            if self._group.count:
                self._group.remove()
            else:
                self._in_parameters = False
        elif self._depth == self._node.count + 1:
            self._node.remove()
        self._depth -= 1


class _Path:
    """Names joined by a separator; like rcl it adds and removes text, not list elements."""

    def __init__(self, separator):
        self._separator = separator
        self.text, self.count = None, 0

    def add(self, name):
        if not self.count:
            self.text = name
        else:
            between = '' if self.text.endswith(self._separator) else self._separator
            self.text = f'{self.text}{between}{name}'
        self.count += 1

    def replace(self, text):
        self.text = text
        self.count += 1

    def remove(self):
        if self.count == 1:
            self.text = None
        elif self.count and self._separator in self.text:
            self.text = self.text.rpartition(self._separator)[0]
        self.count = max(self.count - 1, 0)


def _before(event):
    return (f'has {shown(getattr(event, "value", []))} before "{PARAMS_KEY}" at {line_of(event)}; '
            f'expected sections such as "/**: {PARAMS_KEY}: ..."')


def _check_section(section, event):
    """Raise ValueError unless a section is a node name with namespace or wildcards."""
    *parts, node = section.split('/')
    if parts[:1] == ['']:
        parts = parts[1:]
    lengths = (LONGEST_PART,) * len(parts) + (LONGEST_NODE,)
    if not all(word in ('*', '**') or _WORD.fullmatch(word) and len(word) <= most
               for word, most in zip((*parts, node), lengths)):
        raise ValueError(f'has the section {shown(section)} at {line_of(event)}; expected the '
                         'name of a node, with its namespace or wildcards')
