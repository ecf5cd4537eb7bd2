"""The command compare-filters: table, figure, numbers, and its bad input."""

import json

from ins_sim.cli.main import main
from ins_sim.settings.aided_navigator import FILTERS
import pytest

SHORT = ['--runs', '2', '-p', 'duration_s:=40.0']


def compare(folder, *words):
    """Run the command; return the rows it wrote."""
    assert main(['compare-filters', '-o', str(folder), *SHORT, *words]) == 0
    return json.loads((folder / 'comparison.json').read_text())


def test_the_command_shows_table_and_figure(tmp_path, capsys):
    """Six filters and two more windows of the eskf; one process or two give the same figures."""
    words = ['--cycles', '100', '1000', '10']
    rows = compare(tmp_path / 'a', *words)
    text = capsys.readouterr().out
    assert [(r['filter'], r['cycles']) for r in rows] == [
        *((name, 100) for name in FILTERS), ('eskf', 1000), ('eskf', 10)]
    assert all(r['flights'] == 2 and 0.0 < r['end_m'] < 1000.0 for r in rows)
    # whatever the width of the terminal
    assert 'refuses a window in which the body turns' in ' '.join(text.split())
    assert (tmp_path / 'a' / 'comparison.png').stat().st_size > 20000
    assert compare(tmp_path / 'b', *words, '--jobs', '1') == rows


@pytest.mark.parametrize('words, sentence', [
    (['--runs', '0'], '--runs is 0 and --jobs 0; expected 1 or more runs'),
    (['--cycles', '0'], '--cycles is 0; expected 1 to 100000'),
    (['-p', 'duration_s:=1e6'], 'duration_s is 1e+06 s; expected at most'),
    (['-p', 'motion.route.wind_m_s:=200.0'], 'expected less than the airspeed made good'),
    (['-p', 'filtre:=eskf'], "unknown parameter 'filtre'; the nearest known one is 'filter'"),
])
def test_bad_input_is_one_sentence(tmp_path, capsys, words, sentence):
    """Exit code 2, the sentence, and no folder."""
    assert main(['compare-filters', '-o', str(tmp_path / 'out'), *words]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1
    assert not (tmp_path / 'out').exists()


def test_an_existing_folder_is_kept(tmp_path, capsys):
    """Without --force nothing is replaced; with it only a comparison is."""
    (tmp_path / 'mine').mkdir()
    (tmp_path / 'mine' / 'thesis.txt').write_text('years of work')
    for words in ([], ['--force']):
        assert main(['compare-filters', '-o', str(tmp_path / 'mine'), *SHORT, *words]) == 2
    assert (tmp_path / 'mine' / 'thesis.txt').read_text() == 'years of work'
