"""Verb list: the shipped motions, instruments and studies."""

import textwrap

HELP = 'list the shipped motions, instruments and studies'
DESCRIPTION = ('List the shipped parameter files, one per line, and the verbs that are studies. '
               '"ins_sim describe NAME" shows what a file sets.')
# Indent of a name, least width of the text in a narrow terminal, width of a line in a pipe.
INDENT, LEAST, LONGEST = 2, 30, 10000
KINDS = ('motions', 'instruments', 'studies', 'others')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('kind', nargs='?', choices=KINDS, metavar='KIND', default=None,
                        help='list only one kind: %(choices)s')


def run(chosen):
    """List; return the exit code."""
    from ins_sim.report.console import PlainConsole
    from . import shipped_files
    console = PlainConsole()
    files = shipped_files.shipped_files()
    kinds = KINDS if chosen.kind is None else (chosen.kind,)
    parts = [(shipped_files.HEADS[kind], [(file.name, file.words) for file in files[kind]])
             for kind in kinds]
    if 'studies' in kinds:
        parts.insert(kinds.index('studies') + 1, (
            'studies with a verb of their own: ins_sim VERB --help', study_verbs()))
    # In a pipe each entry is one line, however long.
    for line in lines(parts, console.width if console.is_terminal else LONGEST):
        console.print(line)
    return 0


def lines(parts, width):
    """Return the lines of parts (head, rows of name and words), folded at a width."""
    longest = max(len(name) for _, rows in parts for name, _ in rows)
    told = []
    for head, rows in parts:
        told += ['', head]
        for name, words in rows:
            start = f'{"":{INDENT}}{name:{longest}}  '
            told += textwrap.wrap(words, max(width, len(start) + LEAST), initial_indent=start,
                                  subsequent_indent=' ' * len(start))
    return told[1:]


def study_verbs():
    """Return the name and the line of every verb that is a study."""
    from importlib import import_module
    from pkgutil import iter_modules
    from . import studies
    names = sorted(found.name for found in iter_modules(studies.__path__))
    return [(name.replace('_', '-'), import_module(f'{studies.__name__}.{name}').HELP)
            for name in names]
