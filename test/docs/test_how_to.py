"""Tables and commands of docs/how_to that no other test covers give the values of the pages."""

import re
import shlex

from ins_sim.cli.main import main
import ins_sim
import pytest
from support import pages
from support.places import ROOT

PAGES = ROOT / 'docs' / 'how_to'
GRADES = re.findall(
    r'^\| `(\w+)` \| [^|]+ \| [\d.]+ \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$',
    (PAGES / 'choose_a_grade.md').read_text(encoding='utf-8'), re.MULTILINE)


def commands(page):
    """Return the arguments of the ins_sim commands in the shell blocks of a page."""
    blocks, _ = pages.split((PAGES / page).read_text(encoding='utf-8'))
    return [shlex.split(line)[1:] for block in blocks if block.language == 'sh'
            for line in pages.commands(block) if line.startswith('ins_sim ')]


def test_every_grade_has_a_row():
    """The table of grades has a row for each of the six instruments."""
    assert len(GRADES) == 6


@pytest.mark.parametrize('name, ten_minutes, hour, circle', GRADES)
def test_errors_of_the_grades(name, ten_minutes, hour, circle):
    """The error budget on the racetrack gives the errors of the table to four digits."""
    budget = ins_sim.budget(ins_sim.read_settings(['racetrack', name]))
    rms = budget.rms()
    instant = int(abs(budget.t_s - 600.0).argmin())
    assert budget.t_s[instant] == pytest.approx(600.0)
    found = rms[instant], rms[-1], budget.error_circle(0.5)[-1]
    assert found == pytest.approx([float(text) for text in (ten_minutes, hour, circle)], rel=1e-3)


def test_commands_of_the_page_on_bags(tmp_path, monkeypatch, capsys):
    """The example of navigate_a_bag.md aligns to 0.11 deg and drifts by 0.05 m in a minute."""
    monkeypatch.chdir(tmp_path)
    for words in commands('navigate_a_bag.md'):
        assert main(words) == 0, words
        if 'bench_nav' in words:
            out = capsys.readouterr().out
            assert 'standard error 0.11 deg' in out
            drift = re.search(r'^│ +60 │ +([\d.]+) │', out, re.MULTILINE).group(1)
            assert round(float(drift), 2) == 0.05


def test_commands_of_the_page_on_delays(tmp_path, monkeypatch, capsys):
    """The example of estimate_delays.md gives 2.02 +- 0.10 us for a channel that is 2 us late."""
    monkeypatch.chdir(tmp_path)
    for words in commands('estimate_delays.md'):
        assert main(words) == 0, words
    assert re.search(r'^│ y +│.*│ +2\.02 \+- 0\.10 │ +2 │$', capsys.readouterr().out, re.MULTILINE)
