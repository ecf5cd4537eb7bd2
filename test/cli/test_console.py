"""Output to a terminal, a pipe or a file: complete numbers, remaining time, no escape sequence."""

import io
import os
import re
import subprocess
import sys

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.cli import progress
from ins_sim.cli.main import main
from ins_sim.io import bag_imu
from ins_sim.messages import topics
from ins_sim.report import table
from ins_sim.report.console import PlainConsole
from ins_sim.report.summary import SummaryRow
from ins_sim.visible_text import visible
import pytest
from support.places import ROOT

NUMBER = '-3.02229e-123'
ROWS = [SummaryRow(f'a figure with quite a long name, number {k}', 'm/s^2', float(NUMBER),
                   float(NUMBER), float(NUMBER), float(NUMBER)) for k in range(3)]


@pytest.mark.parametrize('terminal, width', [(False, 80), (True, 80), (True, 40), (True, 200)])
def test_numbers_are_never_cut(terminal, width):
    """
    Numbers are complete in a pipe, and in a terminal too narrow for the table.

    There the names are folded instead.
    """
    out = io.StringIO()
    console = PlainConsole(file=out, force_terminal=terminal, width=width, color_system=None)
    table.show_table('a title [rad/s]', ROWS, console)
    said = out.getvalue()
    assert said.count(NUMBER) == 12 and '\N{HORIZONTAL ELLIPSIS}' not in said
    assert '[rad/s]' in said
    assert (ROWS[2].name in said) == (not terminal or width == 200)


def test_words_are_as_they_are():
    """Texts are printed without markup, wrapped paths or control characters."""
    out = io.StringIO()
    name = '/tmp/' + 'a' * 200 + ' [red] :smile: \x1b[31m\x07'
    PlainConsole(file=out).print(f'written: {name}')
    assert out.getvalue() == f'written: {visible(name)}\n'
    assert '\x1b' not in visible(name) and r'\x1b[31m\x07' in visible(name)
    assert visible('a\nb', keep='\n') == 'a\nb' and visible('a\nb') == r'a\nb'
    assert visible('\u202eabc\udce9') == r'\u202eabc\udce9'
    assert visible('\u00e9\u4e2d') == '\u00e9\u4e2d'


def test_progress_in_a_pipe(monkeypatch, capsys):
    """In a pipe progress is printed as a line every 30 s, with the remaining time."""
    clock = [0.0]
    monkeypatch.setattr(progress.time, 'monotonic', lambda: clock[0])
    with progress.progress_bars(PlainConsole(file=io.StringIO())) as add_bar:
        show, flown = add_bar('simulating'), None
        for second in range(101):
            clock[0] = float(second)
            show(second / 400.0)
    with progress.progress_bars(PlainConsole(file=io.StringIO()), 'flights') as add_bar:
        flown = add_bar('flying', 24)
        flown(0)
        clock[0] += 4000.0
        flown(12)
    assert capsys.readouterr().err.splitlines() == [
        'simulating: 1 %, 0:06:35 left', 'simulating: 9 %, 0:06:05 left',
        'simulating: 16 %, 0:05:35 left', 'simulating: 24 %, 0:05:05 left',
        'flying: 12 of 24 flights, 1:06:40 left']


def test_names_of_a_bag_cannot_command_the_terminal(tmp_path, capsys):
    """info and errors print escape sequences and line breaks in topic names as text."""
    path = tmp_path / 'bag'
    with BagWriter(path) as bag:
        bag.add_topic('/a\x1b[2J\nstate     whole', topics.STRING)
    assert main(['info', str(path)]) == 0
    said = capsys.readouterr().out
    assert r'/a\x1b[2J\nstate     whole' in said and '\x1b' not in said
    assert main(['allan', str(path), '--topic', '/b\x1b[2J', '-o', str(tmp_path / 'x')]) == 2
    said = capsys.readouterr().err
    assert '\x1b' not in said and said.count('\n') == 1


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_name_of_a_bag_does_not_part_a_sentence(storage, tmp_path):
    """Exceptions of the API stay on one line for any topic name."""
    with BagWriter(tmp_path / 'bag', storage) as bag:
        bag.add_topic('/i\nu', topics.IMU)
    with open_bag(tmp_path / 'bag') as bag:
        assert list(bag.topics) == [r'/i\nu']
        with pytest.raises(ValueError, match=r'/i\\nu is empty; expected messages'):
            bag_imu.read_imu_messages(bag, r'/i\nu')


@pytest.mark.parametrize('environment', [
    {'LC_ALL': 'C', 'PYTHONUTF8': '0', 'PYTHONCOERCECLOCALE': '0'}, {'LC_ALL': 'C.UTF-8'}])
def test_names_that_are_no_text(environment, tmp_path):
    """A folder whose name is not UTF-8, or not ASCII in an ASCII locale, is written."""
    for name in (b'run_\xe9', 'caf\u00e9'.encode(), b'$\\a$_[b]'):
        ended = subprocess.run(
            [sys.executable, '-m', 'ins_sim', 'simulate', '-p', 'duration_s:=1.0', '-o', name],
            cwd=tmp_path, capture_output=True, stdin=subprocess.DEVNULL, check=False,
            env={**os.environ, 'PYTHONPATH': str(ROOT), **environment})
        assert ended.returncode == 0 and not ended.stderr, ended.stderr
        found = os.fsencode(tmp_path) + b'/' + name
        assert os.path.exists(found + b'/errors.png')
        assert re.search(b'written: ', ended.stdout)
