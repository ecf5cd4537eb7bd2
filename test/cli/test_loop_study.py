"""The command loop-study: tables, figures, numbers, and messages for invalid input."""

from dataclasses import replace
import json

import pytest

from ins_sim.cli.main import main
from ins_sim.studies import closed_loop, stability_map


@pytest.fixture
def short(monkeypatch):
    """Shorten the flights of the study to some seconds."""
    table = [replace(case, duration_s=1.0) for case in closed_loop.TABLE[4:6]]
    monkeypatch.setattr(closed_loop, 'TABLE', table)
    monkeypatch.setattr(closed_loop, 'VARIED', table[:1])
    monkeypatch.setattr(closed_loop, 'CONDITIONS', {
        name: closed_loop.CONDITIONS[name] for name in ('noise of the meter',
                                                        'signals of the meter')})
    monkeypatch.setattr(stability_map, 'PANELS', stability_map.PANELS[:1])


def study(folder, *words):
    """Run the command; return the numbers it wrote."""
    assert main(['loop-study', '-o', str(folder), *words]) == 0
    return json.loads((folder / 'loop_study.json').read_text())


def test_flights_and_conditions(short, tmp_path, capsys):
    """Rows have results of the full simulation, of the lateral channel alone, and published."""
    found = study(tmp_path / 'a', '--parts', 'table', 'conditions')
    text = ' '.join(capsys.readouterr().out.split())
    assert 'Closed loop' in text and 'signals of the meter' in text
    rows = found['table']
    assert [row['case'] for row in rows] == ['sliding, N 1000, K_v 1', 'sliding, N 1000, K_v 50']
    assert all(row['published'] == {'beta_deg': 0.0} for row in rows)
    # No window has ended by then.
    assert all(row['end_m'] == pytest.approx(row['lateral']['end_m'], abs=1e-3) for row in rows)
    assert [row['condition'] for row in found['conditions']] == ['noise of the meter',
                                                                 'signals of the meter']
    assert not found['conditions'][0]['lateral']
    for name in ('histories_0', 'conventional_1000_1'):
        assert (tmp_path / 'a' / f'{name}.png').stat().st_size > 10000
    page = (tmp_path / 'a' / 'report.html').read_text(encoding='utf-8')
    assert '0 of 2 flights end quiet' in page and 'Closed loop under conditions' in page


@pytest.mark.slow
def test_the_map(short, tmp_path):
    """One panel with two gains has the linear limits and the limits from 1 m and 100 m."""
    panel, = study(tmp_path / 'b', '--parts', 'map', '--gains', '2', '--jobs', '1')['map']
    assert panel['filter'] == 'sliding conventional, N 10'
    assert panel['flown']['1 m'] == pytest.approx(panel['linear'], rel=0.01)
    assert (tmp_path / 'b' / 'map.png').stat().st_size > 10000


@pytest.mark.parametrize('words, sentence', [
    (['--gains', '0'], '--gains is 0 and --jobs 0; expected 1 or more gains'),
    (['--params-file', 'route_flight'], 'motion.kind is route; expected guided'),
    (['-p', 'motion.guided.control_rate_hz:=50.0'], 'motion.guided.control_rate_hz is 50 Hz; '
     'expected rate_hz, 100 Hz, which the study'),
    (['-p', 'gain_per_sec:=1.0'], "unknown parameter 'gain_per_sec'; the nearest known one is "
     "'gain_per_s'"),
])
def test_bad_input_is_one_sentence(tmp_path, capsys, words, sentence):
    """Invalid input gives one message and exit code 2, and no folder."""
    assert main(['loop-study', '-o', str(tmp_path / 'out'), *words]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1
    assert not (tmp_path / 'out').exists()
