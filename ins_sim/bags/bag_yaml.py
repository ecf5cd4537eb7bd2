"""Write YAML in the style of rosbag2."""

import json
import re

# Strings that need no quotes in YAML 1.1 and are not numbers, booleans or null.
_PLAIN = re.compile(r'(?!(?:true|false|yes|no|on|off|y|n|null)$)[A-Za-z_/][\w/.\-]*', re.ASCII
                    | re.IGNORECASE)


def dump_yaml(tree):
    """Return a tree of dict, list, str, int, bool and None as YAML in the style of rosbag2."""
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
        # A JSON string is a valid YAML string.
        return value if _PLAIN.fullmatch(value) else json.dumps(value, ensure_ascii=False)
    return json.dumps(value)
