"""Command line of a node outside its ROS arguments. This module does not import ROS."""

import sys

from ins_sim import resources
from ins_sim.entry import BAD_INPUT, OK
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.catalogue import flatten
from ins_sim.visible_text import visible

ROS_ARGS, ROS_END, FILE_FLAG = '--ros-args', '--', '--params-file'
INSIDE, OUTSIDE, BOUND = range(3)
HELP = ('-h', '--help')


def answer(name, words):
    """
    Handle ``--help`` and unknown arguments.

    Parameters
    ----------
    name : name of the executable
    words : command line; the first word is the name of the program

    Returns
    -------
    exit code after printing the help or an error, or None if the node can start
    """
    others = _others(words)
    if any(word in HELP for word in others):
        print('\n'.join(_help_lines(name)))
        return OK
    if others:
        print(f'{name}: unknown argument {visible(others[0])}; expected ROS arguments after '
              f'{ROS_ARGS}, such as -p NAME:=VALUE (--help lists the parameters)',
              file=sys.stderr)
        return BAD_INPUT
    return None


def with_paths(words):
    """
    Return a command line in which the names of shipped parameter files are replaced by paths.

    A word that is neither a name nor a path stays as it is; rcl then reports the error.
    """
    found = list(words)
    for k, (word, place) in enumerate(_placed(words)):
        if place == INSIDE and words[k - 1] == FILE_FLAG:
            try:
                found[k] = str(resources.parameter_file(word))
            except OSError:
                continue
    return found


def _others(words):
    return [word for k, (word, place) in enumerate(_placed(words)) if k and place == OUTSIDE]


def _placed(words):
    """Yield each word, and whether it is INSIDE the ROS arguments, OUTSIDE, or their BOUND."""
    inside = False
    for word in words:
        if word == ROS_ARGS or inside and word == ROS_END:
            inside = word == ROS_ARGS
            yield word, BOUND
        else:
            yield word, INSIDE if inside else OUTSIDE


def _help_lines(name):
    yield (f'usage: {name} [--ros-args [-p NAME:=VALUE] [--params-file FILE] [-r FROM:=TO] '
           '[-r __ns:=/NAMESPACE]]')
    if name in ALL_NODES:
        yield ''
        yield 'parameters:'
        cls = ALL_NODES[name]
        for parameter, field in flatten(cls).items():
            unit, default = field.metadata['unit'], field.default
            shown = list(default) if isinstance(default, tuple) else default
            later = '; can be set while the node runs' if parameter in cls.SETTABLE else ''
            yield (f'  {parameter}: {field.metadata["doc"]}{f" [{unit}]" if unit else ""} '
                   f'(default: {shown!r}{later})')
