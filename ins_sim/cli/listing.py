"""Verb list: the shipped motions, instruments and studies."""

HELP = 'the shipped motions, instruments and studies'
DESCRIPTION = ('List the parameter files that are shipped, with a line each, and the verbs that '
               'are studies. "ins_sim describe NAME" tells more of one.')
KINDS = ('motions', 'instruments', 'studies', 'others')
INDENT = 2


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('kind', nargs='?', choices=KINDS, metavar='KIND', default=None,
                        help='only these: %(choices)s')


def run(chosen):
    """List; return the exit code."""
    from rich.table import Table
    from ins_sim.report.console import PlainConsole
    from . import shipped_files
    console, first = PlainConsole(), True
    files = shipped_files.shipped_files()
    kinds = KINDS if chosen.kind is None else (chosen.kind,)
    parts = [(shipped_files.HEADS[kind], [(file.name, file.words) for file in files[kind]])
             for kind in kinds]
    if 'studies' in kinds:
        parts.insert(kinds.index('studies') + 1, (
            'studies, as verbs: ins_sim VERB --help', study_verbs()))
    width = max(len(name) for _, rows in parts for name, _ in rows)
    for head, rows in parts:
        console.print(head if first else f'\n{head}')
        first = False
        table = Table.grid(padding=(0, 2), pad_edge=False)
        table.add_column(min_width=width + INDENT, no_wrap=True)
        table.add_column()
        for name, words in rows:
            table.add_row(' ' * INDENT + name, words)
        console.print(table)
    return 0


def study_verbs():
    """Return the name and the line of every verb that is a study."""
    from importlib import import_module
    from pkgutil import iter_modules
    from . import studies
    names = sorted(found.name for found in iter_modules(studies.__path__))
    return [(name.replace('_', '-'), import_module(f'{studies.__name__}.{name}').HELP)
            for name in names]
