"""Tables, settings and list of files of a report as HTML."""

import numbers
import os
import platform
from urllib.parse import quote

import numpy as np

from .differences import changed_settings, settings_by_node
from .words import breakable, cell_text, text


def table_section(table):
    """Return a PageTable as a section."""
    note = f'<p>{text(table.note)}</p>' if table.note else ''
    return (f'<section><h2>{text(table.title)}</h2>\n'
            f'{_table(table.heads, table.rows)}{note}</section>')


def _table(heads, rows, kind=''):
    # Columns of numbers are right-aligned.
    numeric = [any(isinstance(row[k], numbers.Real) for row in rows) for k in range(len(heads))]
    marks = [' class="number"' if right else '' for right in numeric]
    head = ''.join(f'<th scope="col"{mark}>{text(name)}</th>'
                   for mark, name in zip(marks, heads))
    body = '\n'.join('<tr>' + ''.join(f'<td{mark}>{breakable(text(cell_text(value)))}</td>'
                                      for mark, value in zip(marks, row)) + '</tr>'
                     for row in rows)
    return (f'<div class="wide"><table{kind}>\n<thead><tr>{head}</tr></thead>\n'
            f'<tbody>\n{body}\n</tbody></table></div>\n')


def settings_section(page, bokeh):
    """Return the section about the simulation; ``bokeh`` is the version of Bokeh, or ''."""
    parts = []
    if page.settings is not None:
        changed = changed_settings(page.settings)
        parts.append('<p>Settings that differ from the defaults: '
                     f'{len(changed) or "none"}.</p>')
        if changed:
            parts.append(_table(('setting', 'value', 'default', 'unit', 'of'), changed,
                                ' class="settings"'))
    digests = [(f'digest of {name}', value) for name, value in page.digest.items()]
    facts = [*_seeds(page.settings), *digests, *_versions(bokeh)]
    parts.append('<dl>' + ''.join(f'<dt>{text(name)}</dt><dd><code>{text(value)}</code></dd>'
                                  for name, value in facts) + '</dl>')
    return '\n'.join(parts)


def _seeds(settings):
    """Return (name, value) of the seeds and of the run number."""
    nodes = {} if settings is None else settings_by_node(settings)
    return [(f'{name} of {node}' if node else name, getattr(given, name))
            for name in ('seed', 'run') for node, given in nodes.items() if hasattr(given, name)]


def _versions(bokeh):
    """Return (name, version) of the software that computed the run and draws the figures."""
    from ins_sim import __version__
    try:
        from importlib.metadata import PackageNotFoundError, version
        numba = version('numba')
    except PackageNotFoundError:
        numba = 'not installed'
    found = [('ins_sim', __version__), ('Python', platform.python_version()),
             ('NumPy', np.__version__), ('Numba', numba)]
    return [*found, ('Bokeh', bokeh)] if bokeh else found


def files_list(files):
    """Return the list of the files next to the report, each with its content in words."""
    return '<ul>' + ''.join(
        f'<li><a href="{quote(os.fsencode(name))}">{text(name)}</a>: {text(what)}</li>'
        for name, what in files.items()) + '</ul>'
