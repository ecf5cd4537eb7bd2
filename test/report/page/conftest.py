"""Fixtures of the tests of reports."""

import sys

import pytest


@pytest.fixture
def without_bokeh(monkeypatch):
    """Make Bokeh unavailable, as on a machine without the extra report."""
    from ins_sim.report import page
    for name in [name for name in sys.modules if name.partition('.')[0] == 'bokeh']:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, 'bokeh', None)
    for name in ('bokeh_panels', 'bokeh_marks'):
        monkeypatch.delitem(sys.modules, f'ins_sim.report.page.{name}', raising=False)
        monkeypatch.delattr(page, name, raising=False)
