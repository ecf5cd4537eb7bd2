"""What stands on the command line of a node beside its ROS arguments.  No ROS is imported."""

import sys

from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.catalogue import flatten
from ins_sim.visible_text import visible

ROS_ARGS, ROS_END = '--ros-args', '--'
HELP = ('-h', '--help')
BAD = 2


def answer(name, words):
    """
    Print the help, or what is wrong with the arguments; return the exit code, None to go on.

    name: of the executable; words: command line, with the name of the program before ROS_ARGS.
    """
    others = _others(words)
    if any(word in HELP for word in others):
        print('\n'.join(_help_lines(name)))
        return 0
    if others:
        print(f'{name}: unknown argument {visible(others[0])}; expected ROS arguments behind '
              f'{ROS_ARGS}, such as -p NAME:=VALUE (--help lists the parameters)',
              file=sys.stderr)
        return BAD
    return None


def _others(words):
    others, inside = [], False
    for k, word in enumerate(words):
        if word == ROS_ARGS or inside and word == ROS_END:
            inside = word == ROS_ARGS
        elif not inside and k:
            others.append(word)
    return others


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
            later = '; can be set while it runs' if parameter in cls.SETTABLE else ''
            yield (f'  {parameter}: {field.metadata["doc"]}{f" [{unit}]" if unit else ""} '
                   f'(default: {shown!r}{later})')
