"""Ctrl-C ends every verb with one message, even during the imports of Python."""

import os
import signal
import subprocess
import sys

from ins_sim import entry
from ins_sim.cli.main import VERBS
import pytest
from support.places import ROOT

# A module that is imported by others at a time chosen by the test.
SLOW = """
import os, signal, sys, time
from importlib import import_module
from importlib.abc import MetaPathFinder


class Finder(MetaPathFinder):
    count = 0

    def find_spec(self, name, path=None, target=None):
        Finder.count += 1
        if Finder.count == int(os.environ['AT']):
            signal.raise_signal(getattr(signal, os.environ['SIGNAL']))


sys.meta_path.insert(0, Finder())
sys.argv[0] = 'ins_sim'
from ins_sim.entry import command
command()
"""
WORDS = {'simulate': ['-p', 'duration_s:=600.0'], 'predict': ['-p', 'duration_s:=1e6'],
         'compare-filters': ['--runs', '1'], 'info': ['absent'], 'convert': ['absent.csv', 'bag'],
         'navigate': ['absent.csv'], 'play': ['absent'], 'record': ['imu'],
         'export': ['kalibr', '--params-file', 'absent']}


def interrupted(verb, at, number, folder):
    """Return the result of a verb that receives a signal during an import."""
    return subprocess.run(
        [sys.executable, '-c', SLOW, verb, *WORDS.get(verb, [])], cwd=folder, text=True,
        capture_output=True, timeout=120.0, stdin=subprocess.DEVNULL,
        env={**os.environ, 'AT': str(at), 'SIGNAL': number, 'PYTHONPATH': str(ROOT)})


@pytest.mark.parametrize('verb', VERBS)
def test_a_signal_amid_imports(verb, tmp_path):
    """
    A signal during imports gives exit code 130 and one message, and nothing remains.

    A verb that ends by itself before the import passes the signal on has its own exit code: that
    of a refusal, or of a node.
    """
    own = {'record': 0, 'play': 0}.get(verb, 2 if 'absent' in str(WORDS.get(verb)) else 130)
    for at, number in ((3, 'SIGINT'), (60, 'SIGTERM')):
        ended = interrupted(verb, at, number, tmp_path)
        assert ended.returncode in (130, own), ended.stderr
        said = ended.stderr.splitlines()
        if ended.returncode == 130:
            assert len(said) == 1 and said[0].startswith('ins_sim') and 'interrupted; ' in said[0]
        assert 'Traceback' not in ended.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def handlers():
    """Restore the signal handlers after the test."""
    before = {number: signal.getsignal(number) for number in entry.SIGNALS}
    yield
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    for number, handler in before.items():
        signal.signal(number, handler)


def test_an_interrupt_that_was_swallowed_comes_again(handlers):
    """A signal raised within a destructor, which Python reports as ignored, is raised again."""
    for number in entry.SIGNALS:
        signal.signal(number, entry._interrupt)
    with pytest.raises(KeyboardInterrupt):
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt as error:
            entry._on_unraisable(type('Unraisable', (), {'exc_value': error}))
        signal.pause()
    assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN


def test_a_reader_that_goes_away(tmp_path):
    """``ins_sim ... | head`` prints no error, and all files are written."""
    with subprocess.Popen([sys.executable, '-m', 'ins_sim', 'simulate', '-p', 'duration_s:=1.0',
                           '-o', 'run'], cwd=tmp_path, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True,
                          env={**os.environ, 'PYTHONPATH': str(ROOT)}) as process:
        process.stdout.close()
        said = process.stderr.read()
    assert said == '' and (tmp_path / 'run' / 'summary.json').exists()
