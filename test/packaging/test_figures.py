"""The figures of a test run are written to one file, with one process and with several."""

import json
import os

import pytest
from support.places import ROOT

TESTS = """
import numpy as np
import pytest

@pytest.mark.parametrize('k', [0, 1, 2])
def test_one(k, figures):
    figures.record(f'one.{k}', np.float64(k), 'm', expected=np.arange(2), source='nowhere')

def test_fails(figures):
    figures.record('wrong', 1.0)
    assert False
"""


@pytest.fixture
def runner(pytester, monkeypatch):
    """Return the Pytester, whose processes find the plugin and the package."""
    paths = [str(ROOT / 'test'), str(ROOT), os.environ.get('PYTHONPATH', '')]
    monkeypatch.setenv('PYTHONPATH', os.pathsep.join(filter(None, paths)))
    return pytester


def run(pytester, *words):
    """Run the tests above with the plugin; return the contents of the file."""
    pytester.makepyfile(test_some=TESTS)
    pytester.makeconftest("pytest_plugins = ('support.figures',)")
    result = pytester.runpytest_subprocess('--figures', 'out/figures.json', *words)
    result.assert_outcomes(passed=3, failed=1)
    return json.loads((pytester.path / 'out' / 'figures.json').read_text())


@pytest.mark.parametrize('words', [('-p', 'no:xdist'), ('-n', '2')], ids=['one', 'workers'])
def test_figures_of_passed_tests_are_written(runner, words):
    """
    The file has every figure of passed tests with unit, expectation and test.

    It has no figure of a test that failed.
    """
    if '-n' in words:
        pytest.importorskip('xdist')
    found = run(runner, *words)
    assert list(found['figures']) == ['one.0', 'one.1', 'one.2']
    assert found['figures']['one.2'] == {
        'value': 2.0, 'unit': 'm', 'expected': [0, 1], 'source': 'nowhere',
        'test': 'test_some.py::test_one[2]'}
    assert found['made_with']['version']


def test_a_second_run_adds_to_the_file(runner):
    """A second run adds its figures and keeps those of the first run."""
    folder = runner.path / 'out'
    folder.mkdir()
    (folder / 'figures.json').write_text('{"figures": {"former": {"value": 1}}}')
    assert list(run(runner)['figures']) == ['former', 'one.0', 'one.1', 'one.2']
