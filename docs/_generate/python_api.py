"""Pages of the Python interface: one for each public name, from the docstrings."""

import inspect

import ins_sim
from ins_sim import testing

from .markdown import code, contents, first_sentence, page, table, text

INTRODUCTION = '''\
These names are imported from `ins_sim`; see [API stability](../api_stability.md) for what may
change. Everything else can be imported by its module, but may change in any release.
'''
TESTING = '`ins_sim.testing`'


def pages():
    """Return {path: Markdown} of the pages of the public names."""
    names = sorted(ins_sim.__all__, key=str.lower)
    found = {f'python_api/{name}.md': page(name, *_directive(name)) for name in names}
    found['python_api/testing.md'] = page('ins_sim.testing', *_module())
    rows = {kind: [(f'[{code(name)}](python_api/{name}.md)', _summary(name)) for name in names
                   if inspect.isclass(getattr(ins_sim, name)) == (kind == 'Classes')]
            for kind in ('Functions', 'Classes')}
    found['python_api.md'] = page(
        'Python API', INTRODUCTION,
        *(line for kind in rows for line in (f'## {kind}', '', *table(('name', 'summary'),
                                                                      rows[kind]))),
        '## Tests of other filters', '',
        f'[{TESTING}](python_api/testing.md): {text(first_sentence(testing.__doc__))}', '',
        '## Conventions', '', *_rst('.. automodule:: ins_sim', '   :no-members:'),
        *contents([*(f'python_api/{name}' for name in names), 'python_api/testing']))
    return found


def _summary(name):
    return text(first_sentence(inspect.getdoc(getattr(ins_sim, name))))


def _rst(*lines):
    return ['```{eval-rst}', *lines, '```', '']


def _directive(name):
    if inspect.isclass(getattr(ins_sim, name)):
        return _rst(f'.. autoclass:: ins_sim.{name}', '   :members:', '   :member-order: bysource')
    return _rst(f'.. autofunction:: ins_sim.{name}')


def _module():
    return _rst('.. automodule:: ins_sim.testing', '   :members:', '   :member-order: bysource')
