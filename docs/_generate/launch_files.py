"""Page of the launch files and their arguments."""

import ast

from ins_sim import resources
from ins_sim.launching.arguments import LAUNCH_FILES

from .markdown import code, NO_VALUE, page, table, text

INTRODUCTION = '''\
`ros2 launch ins_sim NAME --show-args` prints the same. An argument is given as `NAME:=VALUE`. An
unknown argument, or a value that is not accepted, ends the launch with one sentence.
'''


def pages():
    """Return {path: Markdown}."""
    lines = []
    for name, arguments in LAUNCH_FILES.items():
        path = resources.launch(name.removesuffix('.launch.py'))
        told = ast.get_docstring(ast.parse(path.read_text('utf-8')))
        lines += [f'## {name}', '', '```text', told, '```', '',
                  *table(('argument', 'default', 'meaning'), [
                      (code(one.name), _default(one), text(one.doc)) for one in arguments],
                      'options')]
    return {'launch_files.md': page('Launch files', INTRODUCTION, *lines)}


def _default(argument):
    """Return the default of an argument."""
    if argument.default is None:
        return 'must be given'
    return code(argument.default) if argument.default else NO_VALUE
