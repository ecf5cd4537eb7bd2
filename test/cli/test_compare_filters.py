"""The command compare-filters: tables, figures, report, and messages for invalid input."""

import json
import re

from ins_sim.cli.main import main
from ins_sim.settings.aided_navigator import FILTERS
import pytest

SHORT = ['--runs', '2', '-p', 'duration_s:=40.0']


def compare(folder, *words):
    """Run the command; return the rows it wrote."""
    assert main(['compare-filters', '-o', str(folder), *SHORT, *words]) == 0
    return json.loads((folder / 'comparison.json').read_text())


def digest(text):
    """Return the digest of the flights in what the command printed."""
    return re.search('SHA-256 of the flights: ([0-9a-f]{64})', text)[1]


def test_the_command_shows_table_and_figure(tmp_path, capsys):
    """Six filters, and eskf with two more windows, give equal rows with one process or two."""
    words = ['--cycles', '100', '1000', '10']
    rows = compare(tmp_path / 'a', *words)
    text = capsys.readouterr().out
    assert [(r['filter'], r['cycles']) for r in rows] == [
        *((name, 100) for name in FILTERS), ('eskf', 1000), ('eskf', 10)]
    assert all(r['flights'] == 2 and 0.0 < r['end_m'] < 1000.0 for r in rows)
    # This holds for any width of the terminal.
    assert 'refuses a window in which the body turns' in ' '.join(text.split())
    for figure in ('comparison.png', 'consistency.png', 'flights.png'):
        assert (tmp_path / 'a' / figure).stat().st_size > 20000
    # Quantities that a filter does not estimate are not compared; window_kf has no attitude.
    blocks = {r['filter']: list(r['nees']) for r in rows}
    assert blocks == {
        'free': [], 'conventional': [], 'paper': [], 'paper_corrected': [],
        'window_kf': ['position', 'velocity', 'state'],
        'eskf': ['position', 'velocity', 'attitude', 'state']}
    page = (tmp_path / 'a' / 'report.html').read_text()
    for said in ('was best: rms horizontal error at the end', 'NEES at the end, position',
                 digest(text)):
        assert said in page
    assert compare(tmp_path / 'b', *words, '--jobs', '1') == rows
    assert digest(capsys.readouterr().out) == digest(text)


def test_an_interrupted_study_goes_on(tmp_path, capsys, monkeypatch):
    """
    An interrupted study is resumed without repeating finished flights.

    Blocks of a study with other settings are refused; at the end all blocks are deleted.
    """
    from ins_sim.studies import filters
    fly, flown = filters.fly_filters, []

    def once(settings, cases, run):
        flown.append(run)
        if len(flown) == 4:
            raise KeyboardInterrupt
        return fly(settings, cases, run)

    words = ['--filters', 'window_kf', '--jobs', '1', '--runs', '4', '-p', 'duration_s:=20.0']
    whole = compare(tmp_path / 'whole', *words)
    expected = digest(capsys.readouterr().out)
    monkeypatch.setattr(filters, 'fly_filters', once)
    out = tmp_path / 'out'
    assert main(['compare-filters', '-o', str(out), *SHORT, *words]) == 130
    assert not out.exists() and (tmp_path / 'out.blocks').is_dir()
    capsys.readouterr()
    assert main(['compare-filters', '-o', str(out), *SHORT, *words, '-p', 'gain:=0.5']) == 2
    assert 'out.blocks holds blocks of another study (aided_navigator: gain is 0.4 there and ' \
        '0.5 here)' in capsys.readouterr().err
    assert compare(out, *words) == whole
    said = capsys.readouterr().out
    there = int(re.search('([0-9]) of 4 flights found in', said)[1])
    assert there >= 1 and digest(said) == expected
    assert flown == [0, 1, 2, 3, *range(there, 4)] and not (tmp_path / 'out.blocks').exists()


@pytest.mark.parametrize('words, sentence', [
    (['--runs', '0'], 'runs is 0; expected a whole number from 1 to 100000'),
    (['--jobs', '-1'], 'jobs is -1; expected 0 (all cores) or more'),
    pytest.param(['--scheduler', 'tcp://127.0.0.1:1'],
                 'there is no Dask scheduler at tcp://127.0.0.1:1', marks=pytest.mark.slow),
    (['--scheduler', 'tcp://127.0.0.1:1', '--jobs', '2'], 'jobs is 2, and a scheduler is given'),
    (['--cycles', '0'], 'cycles is 0; expected 1 to 100000'),
    (['-p', 'duration_s:=1e6'], 'duration_s is 1e+06 s; expected at most'),
    (['-p', 'motion.route.wind_m_s:=200.0'], 'expected less than the airspeed made good'),
    (['-p', 'filtre:=eskf'], "unknown parameter 'filtre'; the nearest known one is 'filter'"),
])
def test_bad_input_is_one_sentence(tmp_path, capsys, words, sentence):
    """Invalid input gives one message and exit code 2, and no folder."""
    assert main(['compare-filters', '-o', str(tmp_path / 'out'), *words]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1
    assert not (tmp_path / 'out').exists()


def test_an_existing_folder_is_kept(tmp_path, capsys):
    """A folder that is not a comparison is kept, even with --force."""
    (tmp_path / 'mine').mkdir()
    (tmp_path / 'mine' / 'thesis.txt').write_text('years of work')
    for words in ([], ['--force']):
        assert main(['compare-filters', '-o', str(tmp_path / 'mine'), *SHORT, *words]) == 2
    assert (tmp_path / 'mine' / 'thesis.txt').read_text() == 'years of work'
