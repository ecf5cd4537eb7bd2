"""Verb describe: describe a parameter, a group, a node, a verb or a shipped file."""

import textwrap

HELP = 'describe a parameter, a group of parameters or a shipped file'
DESCRIPTION = ('Describe a parameter or a group of parameters (meaning, unit, bounds, default, '
               'and the nodes and verbs that have it), a node or verb with all its parameters, or '
               'a shipped parameter file with all that it sets. Without a name: list the groups.')
WIDTH = 79
# Most names with the same ending that a message lists.
MOST = 6


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('name', nargs='?', default=None, metavar='NAME',
                        help='such as gyro.errors, gyro.delay_us.y, strapdown or racetrack')


def run(chosen):
    """Describe; return the exit code."""
    from ins_sim.report.console import PlainConsole
    console = PlainConsole()
    for line in described(chosen.name):
        console.print(line)
    return 0


def described(name):
    """Return the lines on a name, or on all groups; ValueError if there is no such name."""
    from ins_sim import resources
    from ins_sim.settings.catalogue import sentence_of
    from .known_settings import known_groups, known_parameters, READERS
    groups = known_groups()
    if name is None:
        return [line for group in groups if '.' not in group.name
                for line in _entry(f'{group.name}  ({", ".join(group.readers)})', group.words)]
    parameters = known_parameters()
    inside = [p for p in parameters if p.name == name or p.name.startswith(f'{name}.')]
    if inside:
        return _parameters([g for g in groups if g.name == name], inside)
    if name in resources.config_names():
        return _file(name, parameters)
    if name in READERS:
        own = (p for p in parameters if name in p.readers)
        return [*_entry(name, sentence_of(READERS[name])),
                *(line for p in own for line in ('', *_entry(_head(p), p.words)))]
    raise ValueError(_unknown(name, {p.name for p in parameters}, {
        *(g.name for g in groups), *resources.config_names(), *READERS}))


def _parameters(groups, parameters):
    """Return the lines on the groups of a name and the parameters in them."""
    told = [_entry(f'{group.name}  ({", ".join(group.readers)})', group.words)
            for group in groups]
    # If all parameters of a group have the same readers, these are named once, with the group.
    alike = len(groups) == 1 and {p.readers for p in parameters} == {groups[0].readers}
    told += [_entry(_head(p) if alike else f'{_head(p)}  ({", ".join(p.readers)})', p.words)
             for p in parameters]
    return [line for entry in told for line in ('', *entry)][1:]


def _head(parameter):
    return f'{parameter.name}: {parameter.default}'


def _file(name, parameters):
    """Return the lines on a shipped file: its comment, and what it sets."""
    from ins_sim.settings.catalogue import value_text
    from .shipped_files import shipped_file
    file = shipped_file(name)
    lines, section = [str(file.path), *(f'    {line}' for line in file.head)], None
    for node, key, value in file.values:
        if node != section:
            of = 'every node that knows it' if node == '**' else node
            lines += ['', f'for {of}:']
            section = node
        words = next(p.words for p in parameters if p.name == key
                     and (node in p.readers or node == '**'))
        text = value_text(tuple(value) if isinstance(value, list) else value)
        lines += _entry(f'  {key}: {text}', words)
    return lines


def _entry(head, words):
    """Return a head and words below it, folded."""
    fold = textwrap.TextWrapper(WIDTH, subsequent_indent='        ', break_long_words=False,
                                break_on_hyphens=False)
    told = textwrap.TextWrapper(WIDTH, initial_indent='    ', subsequent_indent='    ',
                                break_long_words=False, break_on_hyphens=False)
    return [*fold.wrap(head), *told.wrap(words)]


def _unknown(name, parameters, others):
    from ins_sim.settings.shown import cut, shown
    from ins_sim.settings.suggest import nearest_name
    ending = sorted(p for p in parameters if p.endswith(f'.{name}'))
    if ending:
        more = f' and {len(ending) - MOST} more' if len(ending) > MOST else ''
        near = f'there are {", ".join(ending[:MOST])}{more}'
    else:
        near = f'the nearest known one is {cut(nearest_name(name, parameters | others))!r}'
    return (f'{shown(name)} is not a parameter, group, node, verb or shipped file; {near}')
