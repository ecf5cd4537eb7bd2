"""Every command of ins_sim and every Python block of README and docs/ is executed by page."""

import doctest
from pathlib import Path
import re
import shlex

from ins_sim.cli.main import main, parser, VERBS
import pytest
from support.pages import commands, page_id, PAGES, split
from support.places import ROOT

# Verbs that simulate or predict; the duration below is added to their options.
SHORTENED = {'simulate', 'predict', 'compare-orientation', 'allan', 'compare-filters',
             'monte-carlo'}
FEWER = {'monte-carlo': ['--runs', '2'], 'compare-filters': ['--runs', '2'],
         'allan': ['--duration', '600']}
# These verbs need live nodes, or take minutes whatever the flight; other tests run them. Here the
# parser only reads their options.
READ_ONLY = {'record', 'play', 'demo', 'loop-study', 'delay-study', 'dtg-study'}
# Pages whose Python blocks are not programs, each with the reason.
FRAGMENTS = {
    'docs/design/bags.md': 'shows the calls on a bag that the text supposes',
    'docs/design/recorded_truth.md': 'shows the calls with settings that the text supposes'}
# Pages whose commands compute for more than 10 s.
LONG = ('docs/how_to/ensembles.md', 'docs/tutorials/data_sheet.md',
        'docs/tutorials/error_budget.md')
# Enough for every filter and estimate, and computed in a second or two.
SHORT = ['-p', 'duration_s:=10.0']


def is_command(line):
    """Return whether a line is a command of ins_sim, and not one of its output lines."""
    words = line.split()
    return words[:1] == ['ins_sim'] and len(words) > 1 and words[1] in VERBS


def stands_for_yours(words):
    """Return whether a command has a placeholder: a word in capitals, in brackets or with dots."""
    return any(re.fullmatch(r'[A-Z_]{3,}|\.\.\.|\[.*\]|.*:=[A-Z]{3,}', word) for word in words)


def short(words):
    """Return the options that shorten a command."""
    verb = words[0]
    added = SHORT if verb in SHORTENED or (
        verb == 'budget' and '--require' not in words) else []
    return [*words, *added, *FEWER.get(verb, [])]


def run_command(line, missing):
    """
    Run a command, shortened; if it cannot run here, only parse its options.

    missing: set of folders that parsed commands would have written; it is extended.
    """
    words = shlex.split(line)[1:]
    output = words[words.index('-o') + 1:][:1] if '-o' in words else []
    if (words[0] in READ_ONLY or stands_for_yours(words) or '--scheduler' in words
            or missing & set(words)):
        words = [word for word in words if word != '...']
        assert parser().parse_args(words).verb == words[0]
        missing |= set(output)
        return
    if output:
        words.append('--force')
    assert main(short(words)) == 0, line


def run_python(text, names, where, expected, capsys):
    """
    Execute a block with the names that earlier blocks defined.

    Its output must be the indented block that follows it, except for lines with dots. A block with
    prompts contains its own output.
    """
    if text.startswith('>>> '):
        test = doctest.DocTestParser().get_doctest(text, names, where, where, 0)
        assert doctest.DocTestRunner().run(test, clear_globs=False).failed == 0
        names.update(test.globs)
        return
    capsys.readouterr()
    exec(compile(text, where, 'exec'), names)
    printed = capsys.readouterr().out.splitlines()
    if expected:
        lines = expected.splitlines()
        assert len(lines) == len(printed), (lines, printed)
        assert all('...' in line or line == got for line, got in zip(lines, printed)), printed


@pytest.fixture
def here(tmp_path, monkeypatch, request):
    """Work in a temporary folder; return a function that puts a recorded flight into it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv('MPLBACKEND', 'Agg')

    def flight():
        data = request.getfixturevalue('shared_data')
        (tmp_path / 'flight.csv.gz').symlink_to(data / 'flights' / 'cruise_gv_acclip_rf01.csv.gz')

    return flight


@pytest.mark.parametrize('page', [
    pytest.param(page, marks=[pytest.mark.slow] * (page_id(page) in LONG)) for page in PAGES],
    ids=page_id)
def test_examples_of_a_page(page, here, capsys):
    """
    Commands, Python blocks and parameter files of a page work in their order, in one folder.

    Figures named in captions (lines between asterisks) must have been drawn. A YAML block whose
    first line is a comment with a file name is saved under that name first. A comment "not run:
    REASON" above a fence exempts a block; if it is Python it must still compile.
    """
    text = page.read_text(encoding='utf-8')
    blocks, _ = split(text)
    if any('flight.csv.gz' in line for block in blocks for line in commands(block)):
        here()
    names, missing = {'__name__': 'example'}, set()
    for block, after in zip(blocks, [*blocks[1:], None]):
        if block.language == 'python':
            if block.reason or page_id(page) in FRAGMENTS:
                compile(block.text, page_id(page), 'exec')
            else:
                expected = after.text if after and after.language == 'indented' else ''
                run_python(block.text, names, page_id(page), expected, capsys)
        elif block.language == 'yaml' and (name := re.match(r'# ([\w.]+\.yaml)\b', block.text)):
            # The folder of the test is the working directory.
            Path(name[1]).write_text(block.text, encoding='utf-8')
        elif not block.reason:
            for line in filter(is_command, commands(block)):
                run_command(line, missing)
    for caption in re.findall(r'^\*(?! )[^*]*\*$', text, re.MULTILINE):
        for figure in re.findall(r'`([\w/]+\.png)`', caption):
            assert Path(figure).is_file(), f'no command of the page draws {figure}'


def test_pages_with_fragments_have_python():
    """Every page in the table of exempt pages has Python blocks."""
    for name in FRAGMENTS:
        blocks, _ = split((ROOT / name).read_text(encoding='utf-8'))
        assert any(block.language == 'python' for block in blocks), name
