"""YAML as rosbag2 writes it."""

import json
import re

# what needs no quotes in YAML 1.1, and is no number, truth value or nothing
_PLAIN = re.compile(r'(?!(?:true|false|yes|no|on|off|y|n|null)$)[A-Za-z_/][\w/.\-]*', re.ASCII
                    | re.IGNORECASE)


def dump_yaml(tree):
    """Return dicts, lists, texts, whole numbers, truth values and None in the style of rosbag2."""
    return '\n'.join(_lines(tree))


def _lines(tree):
    if isinstance(tree, dict):
        for key, value in tree.items():
            if value and isinstance(value, (dict, list)):
                yield f'{key}:'
                yield from ('  ' + line for line in _lines(value))
            else:
                yield f'{key}: {_scalar(value)}'
    else:
        for value in tree:
            lines = _lines(value) if isinstance(value, dict) else [_scalar(value)]
            for k, line in enumerate(lines):
                yield ('  ' if k else '- ') + line


def _scalar(value):
    if value is None:
        return '~'
    if isinstance(value, str):
        # a text of JSON is one of YAML
        return value if _PLAIN.fullmatch(value) else json.dumps(value, ensure_ascii=False)
    return json.dumps(value)
