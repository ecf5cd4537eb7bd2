"""
Read YAML from untrusted files, event by event and within limits.

The size in bytes is limited before reading, and nesting and the expansion of aliases while the
events are read.  Scalars have the types that ROS 2 gives them, so that a value is the same in a
parameter file, in ``-p`` and in the metadata of a bag.
"""

import re

import yaml

from ins_sim.regular_file import check_regular
from ins_sim.settings.shown import cut

# A parameter file has some ten kilobytes, the metadata of a bag 150 bytes per file.
MOST_BYTES = 1 << 24
DEEPEST = 64
# Largest number of values in a tree, with aliases expanded.
MOST_VALUES = 1_000_000
STRING_TAG = 'tag:yaml.org,2002:str'

_TRUE = frozenset(('Y', 'y', 'yes', 'Yes', 'YES', 'true', 'True', 'TRUE', 'on', 'On', 'ON'))
_FALSE = frozenset(('N', 'n', 'no', 'No', 'NO', 'false', 'False', 'FALSE', 'off', 'Off', 'OFF'))
_DOTTED = re.compile(r'[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)')
_SPACE = ' \t\n\v\f\r'
_INTEGER = re.compile(r'[-+]?(?:0[xX][0-9a-fA-F]+|[0-9]+)')
_DECIMAL = re.compile(r'[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?')
_HEXADECIMAL = re.compile(r'[-+]?0[xX](?:[0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)'
                          r'(?:[pP][-+]?[0-9]+)?')
_NO_NUMBER = re.compile(r'[-+]?(?:inf|infinity|nan(?:\([0-9a-z_]*\))?)', re.IGNORECASE)
_SMALLEST = 2.2250738585072014e-308
_LARGEST_INTEGER = 2 ** 63


def read_bytes(path):
    """Return the content of a YAML file; raise ValueError if it is not a file, or too large."""
    check_regular(path, 'a YAML file')
    with open(path, 'rb') as stream:
        content = stream.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise ValueError(f'{path} is larger than {MOST_BYTES >> 20} MiB; expected a YAML file')
    return content


def events(content):
    """
    Yield the events of YAML, bytes or text.

    Raises ValueError if it is not YAML or nested deeper than DEEPEST.  The message, such as
    'is not YAML: line 3: ...', has no subject; the caller puts the name of the file before it.
    """
    if len(content) > MOST_BYTES:
        raise ValueError(f'is larger than {MOST_BYTES >> 20} MiB')
    depth = 0
    try:
        for event in yaml.parse(content, getattr(yaml, 'CSafeLoader', yaml.SafeLoader)):
            if isinstance(event, yaml.CollectionStartEvent):
                depth += 1
                if depth > DEEPEST:
                    raise ValueError(f'is nested deeper than {DEEPEST} at {line_of(event)}')
            elif isinstance(event, yaml.CollectionEndEvent):
                depth -= 1
            yield event
    except UnicodeError as error:
        raise ValueError(f'is not UTF-8 text: {error}') from None
    except yaml.reader.ReaderError as error:
        raise ValueError(f'is not UTF-8 text that YAML allows: {error.reason} (position '
                         f'{error.position})') from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f'line {mark.line + 1}: ' if mark else ''
        problem = ' '.join(str(error.problem or error.context).split())
        raise ValueError(f'is not YAML: {place}{problem}') from None
    except yaml.YAMLError as error:
        raise ValueError(f'is not YAML: {" ".join(str(error).split())}') from None


def line_of(event):
    """Return the line in which an event begins, as 'line 3'."""
    return f'line {event.start_mark.line + 1}'


def scalar(event):
    """
    Return a scalar as bool, int, float or str, like rcl_yaml_param_parser of ROS 2.

    There is no null, no date and no tag other than ``!!str``.  ``1e3`` and ``1.0e7`` are floats,
    ``010`` (octal) and ``0x10`` are integers, ``1:30`` is a string.  A number that does not fit
    into a double or a 64-bit integer is a string.
    """
    text = event.value.partition('\0')[0]
    if event.tag == STRING_TAG or event.style in ('"', "'"):
        return text
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    number = text.lstrip(_SPACE)
    if _INTEGER.fullmatch(number) and (value := _integer(number)) is not None:
        return value
    if _DOTTED.fullmatch(text):
        return float(text.replace('.', ''))
    value = _real(number)
    return text if value is None else value


def _integer(text):
    """Return the integer that strtoll reads with base 0, or None."""
    digits = text.lstrip('+-')
    base = 16 if digits[:2] in ('0x', '0X') else 8 if digits.startswith('0') else 10
    digits = digits[2:] if base == 16 else digits
    if base == 8 and re.search('[89]', digits) or len(digits.lstrip('0')) > 22:
        return None
    value = int(digits, base) * (-1 if text.startswith('-') else 1)
    return value if -_LARGEST_INTEGER <= value < _LARGEST_INTEGER else None


def _real(text):
    """Return the number that strtod reads without a range error, or None."""
    if _NO_NUMBER.fullmatch(text):
        return float(text.partition('(')[0])
    try:
        if _DECIMAL.fullmatch(text):
            value, digits = float(text), re.split('[eE]', text)[0]
        elif _HEXADECIMAL.fullmatch(text):
            value, digits = float.fromhex(text), re.split('[pP]', text)[0][2:]
        else:
            return None
    except OverflowError:
        return None
    if abs(value) == float('inf') or (abs(value) < _SMALLEST and re.search('[1-9a-fA-F]',
                                                                           digits)):
        return None
    return value


def load(content):
    """
    Return the first document of YAML as dicts, lists and scalars; None if there is none.

    An empty scalar, ``~`` and ``null`` are None here.  Aliases are expanded and must not contain
    themselves; the tree has at most MOST_VALUES values.

    Raises ValueError as ``events`` does.
    """
    stream = (event for event in events(content)
              if isinstance(event, (yaml.NodeEvent, yaml.CollectionEndEvent,
                                    yaml.DocumentEndEvent)))
    tree = _Tree(stream)
    first = next(stream, None)
    if first is None or isinstance(first, yaml.DocumentEndEvent):
        return None
    value, _, _ = tree.node(first, 0)
    # The rest must be valid YAML too.
    for _ in stream:
        pass
    return value


class _Tree:
    """Builds the values of one document, each with its number of values and its height."""

    def __init__(self, stream):
        self._stream = stream
        self._anchors = {}
        self._count = 0

    def node(self, event, depth):
        if isinstance(event, yaml.AliasEvent):
            if self._anchors.get(event.anchor) is None:
                kind = 'itself' if event.anchor in self._anchors else 'nothing'
                raise ValueError(f'has the alias *{cut(event.anchor)} for {kind} at '
                                 f'{line_of(event)}')
            made = self._anchors[event.anchor]
            self._count += made[1]
            if depth + made[2] > DEEPEST:
                raise ValueError(f'is nested deeper than {DEEPEST}, by aliases, at '
                                 f'{line_of(event)}')
        else:
            self._anchors[event.anchor] = None
            made = self._new(event, depth)
            self._anchors[event.anchor] = made if event.anchor else None
        if self._count > MOST_VALUES:
            raise ValueError(f'holds more than {MOST_VALUES} values, with aliases '
                             f'expanded, at {line_of(event)}')
        return made

    def _new(self, event, depth):
        before = self._count
        self._count += 1
        height = 1
        if isinstance(event, yaml.ScalarEvent):
            empty = event.implicit[0] and event.value in ('', '~', 'null', 'Null', 'NULL')
            return (None if empty else scalar(event)), 1, 1
        values = []
        for inner in self._stream:
            if isinstance(inner, yaml.CollectionEndEvent):
                break
            value, _, inside = self.node(inner, depth + 1)
            height = max(height, inside + 1)
            values.append(value)
        if isinstance(event, yaml.MappingStartEvent):
            keys = values[::2]
            if any(isinstance(key, (dict, list)) for key in keys):
                raise ValueError(f'has a list or a mapping as a key at {line_of(event)}; '
                                 'expected a text')
            values = dict(zip(keys, values[1::2]))
        return values, self._count - before, height


class Dumper(yaml.SafeDumper):
    """YAML dumper that quotes each text that ROS would read as a number or a boolean."""

    def represent_text(self, text):
        plain = yaml.ScalarEvent(None, None, (True, False), text)
        return self.represent_scalar(STRING_TAG, text, None if scalar(plain) == text else "'")


Dumper.add_representer(str, Dumper.represent_text)
