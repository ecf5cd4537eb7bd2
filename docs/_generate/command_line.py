"""Pages of the command ``ins_sim``: one for each verb, from the parser of its arguments."""

import argparse
import os
import re

from ins_sim.cli.main import parser, VERBS

from .markdown import code, contents, NO_VALUE, page, table, text

INTRODUCTION = '''\
`ins_sim VERB --help` prints the same. See also the [exit codes](exit_codes.md).
'''
WIDTH = '80'
USAGE = 'usage: '
# The end of many helps; the table has a column for it.
DEFAULT = re.compile(r' ?\(default: (.*)\)$')


def pages():
    """Return {path: Markdown} of the pages of the command."""
    parsers = verb_parsers()
    found = {f'command_line/{name}.md': _page(name, one) for name, one in parsers.items()}
    rows = [(f'[{code(name)}](command_line/{name}.md)', text(verb.HELP))
            for name, verb in VERBS.items()]
    found['command_line.md'] = page(
        'Command line', INTRODUCTION, *table(('verb', 'what it does'), rows),
        *contents(f'{name} <command_line/{name}>' for name in parsers))
    return found


def verb_parsers():
    """Return {verb: ArgumentParser}."""
    return next(action.choices for action in parser()._actions
                if isinstance(action, argparse._SubParsersAction))


def arguments(one):
    """Return the actions of a parser, without that of the help."""
    return [action for action in one._actions
            if not isinstance(action, argparse._HelpAction) and action.help != argparse.SUPPRESS]


def _page(name, one):
    os.environ['COLUMNS'] = WIDTH
    lines = [text(one.description), '', '```text',
             _usage(one), '```', '']
    named = [action for action in arguments(one) if action.option_strings]
    placed = [action for action in arguments(one) if not action.option_strings]
    if placed:
        lines += ['## Arguments', '', *table(('argument', 'meaning'), [
            (code(_name(action)), _help(action, one)) for action in placed])]
    if named:
        lines += ['## Options', '', *table(('option', 'default', 'meaning'), [
            (_option(action), _default(action), _help(action, one)) for action in named],
            'options')]
    return page(f'ins_sim {name}', *lines)


def _name(action):
    """Return the name of the value of an argument."""
    if action.metavar is None and action.choices:
        return '{' + ','.join(map(str, action.choices)) + '}'
    return action.metavar or action.dest.upper()


def _option(action):
    value = f' {_name(action)}' if action.nargs != 0 else ''
    return ', '.join(code(word + value) for word in action.option_strings)


def _usage(one):
    first, *others = one.format_usage().removeprefix(USAGE).rstrip().splitlines()
    return '\n'.join([first, *(line[len(USAGE):] for line in others)])


def _default(action):
    """Return the default, in the words of the help where these name it."""
    told = DEFAULT.search(action.help)
    if told:
        return text(told[1] % vars(action))
    if action.nargs == 0 or action.default in (None, '', [], ()):
        return NO_VALUE
    return code(action.default)


def _help(action, one):
    choices = ', '.join(map(str, action.choices)) if action.choices else ''
    words = DEFAULT.sub('', action.help) if action.option_strings else action.help
    return text(words % {**vars(action), 'prog': one.prog, 'choices': choices})
