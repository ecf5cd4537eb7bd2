"""Pages of the parameters: one for each node, and for each verb with parameters of its own."""

from ins_sim.cli.known_settings import READERS, VERBS
from ins_sim.settings.catalogue import flatten, groups_of, sentence_of, value_text

from .markdown import code, contents, first_sentence, NO_VALUE, page, table, text

HEAD = ('parameter', 'type', 'unit', 'range', 'default', 'meaning')
INTRODUCTION = '''\
Each page lists the parameters of one node, or of one verb of `ins_sim` that has parameters of its
own. Set them in a parameter file or with `-p NAME:=VALUE`. A value outside its range, of another
type, or with an unknown name is refused at the start, with exit code 2. The same words are printed
by `ins_sim describe NAME`. The verbs `simulate`, `monte-carlo`, `budget` and `predict` read the
parameters of the nodes.

In the tables, `double[3]` is a list of three numbers in the order of the axes, and `double[]` a
list of any length; – in the column *unit* means dimensionless, or not a quantity.
'''
TYPES = {bool: 'bool', int: 'int', float: 'double', str: 'string'}


def pages():
    """Return {path: Markdown} of the pages of parameters."""
    found = {f'parameters/{name}.md': _page(name, cls) for name, cls in READERS.items()}
    rows = [(f'[{code(name)}](parameters/{name}.md)', 'verb' if name in VERBS else 'node',
             str(len(flatten(cls)))) for name, cls in READERS.items()]
    found['parameters.md'] = page(
        'Parameters', INTRODUCTION, *table(('read by', 'kind', 'parameters'), rows),
        *contents(f'{name} <parameters/{name}>' for name in READERS))
    return found


def _page(name, cls):
    """Return the page of one node or verb."""
    kind = 'verb' if name in VERBS else 'node'
    title = name.replace('_', '-') if kind == 'verb' else name
    fields, groups = flatten(cls), groups_of(cls)
    lines = [f'Parameters of the {kind} {_link(name, title, kind)}.', '']
    for group in ('', *groups):
        own = {full: f for full, f in fields.items() if full.rpartition('.')[0] == group}
        if group:
            lines += [f'{"##" if "." not in group else "###"} {group}', '',
                      text(first_sentence(sentence_of(groups[group]))), '']
        if own:
            lines += table(HEAD, [_row(full, f, full in cls.SETTABLE)
                                  for full, f in own.items()], 'parameters')
    return page(f'Parameters of {title}', *lines)


def _link(name, title, kind):
    folder = 'command_line' if kind == 'verb' else 'nodes'
    return f'[{code(title)}](../{folder}/{title if kind == "verb" else name}.md)'


def _row(name, f, settable):
    """Return the cells of one parameter."""
    words = f.metadata['doc'] + ('; can be set while the node runs' if settable else '')
    return (code(name), type_text(f), unit_text(f), range_text(f), code(value_text(f.default)),
            text(words))


def type_text(f):
    """Return the type of a parameter as ROS names it."""
    if f.type in TYPES:
        return TYPES[f.type]
    size = f.metadata['size'] or ''
    one = ' or one for all' if f.metadata['equal_axes'] else ''
    return f'{TYPES[f.type.__args__[0]]}\\[{size}\\]{one}'


def unit_text(f):
    """Return the unit of a parameter."""
    return text(f.metadata['unit']) or NO_VALUE


def range_text(f):
    """Return what values are accepted."""
    m = f.metadata
    if m['choices']:
        return ', '.join(code(choice) if choice else 'empty' for choice in m['choices'])
    if m['low'] is not None:
        return f'{_number(m["low"])} to {_number(m["high"])}'
    return '`true`, `false`' if f.type is bool else 'any'


def _number(value):
    """Return a number as short as it can be said exactly."""
    short = f'{value:g}'
    return short if float(short) == value else repr(value)
