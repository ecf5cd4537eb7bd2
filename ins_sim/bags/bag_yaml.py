"""YAML as rosbag2 writes it, and reading it from files that nobody vouches for."""

import json
import re

import yaml

# what needs no quotes in YAML 1.1, and is no number, truth value or nothing
_PLAIN = re.compile(r'(?!(?:true|false|yes|no|on|off|y|n|null)$)[A-Za-z_/][\w/.\-]*', re.ASCII
                    | re.IGNORECASE)
_DEEPEST = 50


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


def load_yaml(text):
    """Return the tree of a YAML text; ValueError if it is none."""
    try:
        return yaml.load(text, _loader(text))
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise ValueError(' '.join(str(error).split())) from None


def _loader(text):
    """Return the loader in C, ten times faster, but not for what might exhaust its stack."""
    depth = deepest = 0
    for bracket in re.findall(r'[][{}]', text):
        depth += 1 if bracket in '[{' else -1
        deepest = max(depth, deepest)
    if deepest > _DEEPEST or re.search(r'^ {200}|(?:- ){50}', text, re.MULTILINE):
        return yaml.SafeLoader
    return getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
