"""docs/explanation/validation.md is rendered from its template and recorded figures alone."""

import importlib.util
import json

from ins_sim import __version__
import pytest
from support.places import ROOT


@pytest.fixture
def tool(tmp_path, monkeypatch):
    """Return the module tools/render_validation.py, which works on a page in tmp_path."""
    spec = importlib.util.spec_from_file_location(
        'render_validation', ROOT / 'tools' / 'render_validation.py')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for name, text in (('TEMPLATE', 'a {{one:.2f}}, b {{two[1]:.1e}}\n'),
                       ('VALUES', json.dumps({'figures': {
                           'one': {'value': 1.0}, 'two': {'value': [0.0, 3e-5]},
                           'unused': {'value': 7.0}}})),
                       ('PAGE', '')):
        (tmp_path / name).write_text(text)
        monkeypatch.setattr(module, name, tmp_path / name)
    return module


def real(name):
    """Return the text of a file of the repository."""
    return (ROOT / 'docs' / name).read_text(encoding='utf-8')


def test_the_page_is_its_rendering(tool):
    """The page equals its rendering: every figure shown is known, and every known one is shown."""
    template = real('figures/validation.md.in')
    figures = json.loads(real('figures/validation.json'))['figures']
    assert tool.names(template) == set(figures)
    assert tool.render(template, figures) == real('explanation/validation.md')


def test_the_figures_are_of_this_version():
    """All figures were made with the version of the package; see "How a release is made"."""
    figures = json.loads(real('figures/validation.json'))['figures']
    assert {figure['made_with']['version'] for figure in figures.values()} == {__version__}


def test_the_tool_renders_takes_and_checks(tool, tmp_path, capsys):
    """New figures replace older ones, unused ones are dropped, and an edited page is detected."""
    assert tool.main([]) == 0 and tool.PAGE.read_text() == 'a 1.00, b 3.0e-5\n'
    run = tmp_path / 'run.json'
    run.write_text(json.dumps({'made_with': {'version': '9'}, 'figures': {
        'one': {'value': 2.0}, 'another': {'value': 0.0}}}))
    assert tool.main(['--take', str(run)]) == 0
    assert '1 of the 2 figures of the page are new' in capsys.readouterr().out
    assert tool.PAGE.read_text() == 'a 2.00, b 3.0e-5\n'
    stored = json.loads(tool.VALUES.read_text())['figures']
    assert set(stored) == {'one', 'two'} and stored['one']['made_with'] == {'version': '9'}
    assert tool.main(['--check']) == 0
    tool.PAGE.write_text('a 2.01\n')
    assert tool.main(['--check']) == 1
