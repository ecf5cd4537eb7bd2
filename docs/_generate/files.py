"""Page of the shipped parameter files, and one page for each with what it sets."""

from ins_sim.cli.known_settings import known_parameters
from ins_sim.cli.shipped_files import DEFAULTS, HEADS, INSTRUMENTS, MOTIONS, shipped_files, STUDIES
from ins_sim.settings.catalogue import value_text

from .markdown import code, contents, page, table, text

INTRODUCTION = '''\
These parameter files are part of the package. Give their names to `--params-file` of a verb or of
a node, or to the argument of the same name of the launch files. `ins_sim list` prints this list,
and `ins_sim describe NAME` what a file sets. The files that a run writes are described in
[the files of a run](../run_files.md).
'''
TITLES = {MOTIONS: 'Motions', INSTRUMENTS: 'Instruments', STUDIES: 'Studies'}
EVERY_NODE = '**'


def pages():
    """Return {path: Markdown} of the pages of files."""
    lines, names, found = [], [], {}
    for kind, files in shipped_files().items():
        lines += [f'## {TITLES.get(kind, "Others")}', '', f'{text(HEADS[kind])}.', '',
                  *table(('name', 'content'), [
                      (f'[{code(file.name)}](files/{file.name}.md)', text(file.words))
                      for file in files])]
        names += [file.name for file in files]
        found.update({f'files/{file.name}.md': _file(file) for file in files})
    found['files.md'] = page('Shipped parameter files', INTRODUCTION, *lines,
                             *contents(f'files/{name}' for name in names))
    return found


def _file(file):
    """Return the page of a file: the comment at its head, and the values that it sets."""
    lines = ['```text', *file.head, '```', '']
    if file.name in DEFAULTS:
        # All defaults are on the pages of the parameters already.
        lines.append('The file sets every [parameter](../parameters.md) to its default.')
    else:
        lines += table(('for', 'parameter', 'value', 'meaning'), [
            ('all nodes' if node == EVERY_NODE else code(node), code(key), _value(value),
             text(_meaning(node, key))) for node, key, value in file.values])
    return page(f'{file.name}.yaml', *lines)


def _value(value):
    return code(value_text(tuple(value) if isinstance(value, list) else value))


def _meaning(node, key):
    return next(p.words for p in known_parameters()
                if p.name == key and (node in p.readers or node == EVERY_NODE))
