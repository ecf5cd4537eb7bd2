"""
Fixture ``figures``: values that tests measure are written to one JSON file at the end of the run.

A figure is sent with the report of its test, so that workers of pytest-xdist need no file of their
own. New figures are added to the file, so that several runs (everyday, live, slow) fill one file;
the newest value of a name replaces older ones.
"""

import json
import os
from pathlib import Path
import platform

from ins_sim import __version__
import numpy as np
import pytest

KEY = 'figure'


class Figures:
    """Record the figures of one test."""

    def __init__(self, node):
        self._node = node

    def record(self, name, value, unit='', expected=None, source=''):
        """
        Record a figure.

        Parameters
        ----------
        name : str
            Words joined by dots; unique over all tests.
        value : float, int, str or sequence of them
            Measured value.
        unit : str
            Unit of the value and of the expected value.
        expected : as value, optional
            Published, required or independently computed value.
        source : str
            Source of the expected value.
        """
        self._node.user_properties.append((KEY, {
            'name': name, 'value': _plain(value), 'unit': unit, 'expected': _plain(expected),
            'source': source}))


def _plain(value):
    """Return a value that JSON can hold: NumPy scalars and arrays become floats and lists."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    return [_plain(v) for v in value] if isinstance(value, (tuple, list)) else value


@pytest.fixture
def figures(request):
    """Return the Figures of this test."""
    return Figures(request.node)


def machine():
    """Return {name: value} describing the machine and the versions that computed the figures."""
    return {'version': __version__, 'python': platform.python_version(), 'numpy': np.__version__,
            'machine': f'{platform.machine()}, {os.cpu_count()} cores'}


class Collector:
    """Collect the figures of all test reports of a session and write them at its end."""

    def __init__(self, path):
        self._path = Path(path)
        self._found = {}

    def pytest_runtest_logreport(self, report):
        """Store the figures of a test that has passed."""
        if report.when == 'call' and report.passed:
            for key, figure in report.user_properties:
                if key == KEY:
                    # pytest-xdist appends the group of a test to its name.
                    self._add(report.nodeid.split('@')[0], dict(figure))

    def _add(self, test, figure):
        name = figure.pop('name')
        other = self._found.get(name)
        if other is not None and other['test'] != test:
            raise ValueError(f'figure {name} is recorded by {other["test"]} and by {test}')
        self._found[name] = {**figure, 'test': test}

    def pytest_sessionfinish(self):
        """Write the file, keeping the figures of earlier runs."""
        if not self._found:
            return
        known = json.loads(self._path.read_text())['figures'] if self._path.exists() else {}
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._path.write_text(json.dumps(
            {'made_with': machine(), 'figures': dict(sorted({**known, **self._found}.items()))},
            indent=1) + '\n')


def pytest_addoption(parser):
    """Add the command line option for the path of the file."""
    parser.addoption('--figures', default=None, metavar='FILE',
                     help='where to write the figures (default: build/figures.json)')


def pytest_configure(config):
    """
    Register the collector in the main process only: workers of pytest-xdist do not see all
    reports.
    """
    if not hasattr(config, 'workerinput'):
        path = config.getoption('figures') or config.rootpath / 'build' / 'figures.json'
        config.pluginmanager.register(Collector(path), 'figures-collector')
