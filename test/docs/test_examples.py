"""Every example of the README runs, and every name the documents give exists."""

import importlib
import re
import shlex

import pytest

import ins_sim
from ins_sim.cli.main import main, parser
import numpy as np
from support.places import ROOT

README = (ROOT / 'README.md').read_text(encoding='utf-8')
BLOCKS = re.findall(r'```(\w+)\n(.*?)```', README, re.DOTALL)
COMMANDS = [[line for line in text.splitlines() if line.startswith('ins_sim ')]
            for kind, text in BLOCKS if kind == 'sh']
# verbs that simulate or predict are shortened; those that need live nodes are tested with them
SHORTENED = {'simulate', 'predict', 'compare-orientation', 'allan', 'compare-filters',
             'monte-carlo'}
LIVE = {'record', 'play'}
# take minutes whatever their flights are; tests of their own shorten them
LONG = {'loop-study', 'delay-study'}
DOCUMENTS = sorted((ROOT / 'docs').rglob('*.md'))


@pytest.mark.parametrize('lines', filter(None, COMMANDS), ids=lambda lines: lines[0])
def test_commands_of_the_readme(lines, tmp_path, monkeypatch, request):
    """Block by block, two seconds of simulated time; the flight is one of the recorded ones."""
    monkeypatch.chdir(tmp_path)
    if any('flight.csv.gz' in line for line in lines):
        data = request.getfixturevalue('shared_data')
        (tmp_path / 'flight.csv.gz').symlink_to(data / 'flights' / 'cruise_gv_acclip_rf01.csv.gz')
    for line in lines:
        words = shlex.split(line)[1:]
        if words[0] in LIVE | LONG:
            # the words are those of the parser
            assert parser().parse_args(words).verb == words[0]
        else:
            short = ['-p', 'duration_s:=2.0'] if words[0] in SHORTENED else []
            short += ['--runs', '2'] if words[0] == 'monte-carlo' else []
            assert main([*words, *short]) == 0, line


@pytest.mark.parametrize('code', [text for kind, text in BLOCKS if kind == 'python'])
def test_python_of_the_readme(code, capsys):
    """It prints three components of position and drift."""
    exec(compile(code, 'README.md', 'exec'), {})
    assert len(re.findall(r'[-\d.e+]+', capsys.readouterr().out)) >= 6


def test_make_targets_of_the_readme():
    """The two commands are targets of the Makefile."""
    makefile = (ROOT / 'Makefile').read_text(encoding='utf-8')
    for target in re.findall(r'^make ([\w-]+)', README, re.MULTILINE):
        assert f'\n{target}:' in makefile


@pytest.mark.parametrize('path', DOCUMENTS, ids=lambda p: p.stem)
def test_names_in_the_documents_exist(path):
    """`core.module.name` and `ins_sim.module.name` can be imported."""
    for name in re.findall(r'`(?:ins_sim\.)?((?:core|messages|ros|report)\.(?!html`)[\w.]+)`',
                           path.read_text(encoding='utf-8')):
        parts = name.split('.')
        target = ins_sim
        for k, part in enumerate(parts):
            if not hasattr(target, part):
                importlib.import_module('ins_sim.' + '.'.join(parts[:k + 1]))
            target = getattr(target, part)


def test_the_arrays_of_a_run_are_documented(tmp_path, monkeypatch):
    """run_files.md names each array of run.npz, and only those, by its dimensions."""
    monkeypatch.chdir(tmp_path)
    text = (ROOT / 'docs' / 'reference' / 'run_files.md').read_text(encoding='utf-8')
    dimensions = {}
    for keys, shape in re.findall(r'^\| (`.*?`) \| ([^|]*?) \|', text, re.MULTILINE):
        for key in re.findall(r'`(\w+_\w+)`', keys):
            assert key not in dimensions, key
            dimensions[key] = shape
    found = set()
    for words in ('--params-file motion_2 --params-file delay_y_1us',
                  '--params-file motion_2 --params-file imu_tactical_dtg',
                  '--aided --params-file route_flight --params-file grade_mid '
                  '-p window.cycles:=100', '--params-file guided_flight'):
        assert main(['simulate', *words.split(), '-p', 'duration_s:=3.0', '-o', 'run',
                     '--force']) == 0
        with np.load('run/run.npz') as arrays:
            found |= set(arrays)
            for key in set(arrays) & set(dimensions):
                given = [part.strip() for part in dimensions[key].split(',')]
                shape = arrays[key].shape
                assert given == ['as above'] or [str(n) for n in shape[1:]] == given[1:], key
    assert found == set(dimensions)


def test_links_of_the_readme_lead_somewhere():
    """Relative links name files that are there."""
    for link in re.findall(r'\]\(([^)#:]+)\)', README):
        assert (ROOT / link).exists(), link


def test_what_docstrings_cite_can_be_opened():
    """Pages of docs/ that code and configuration cite exist; nothing cites an unshipped file."""
    cited = set()
    for path in [*(ROOT / 'ins_sim').rglob('*.py'), *(ROOT / 'config').glob('*.yaml')]:
        text = path.read_text(encoding='utf-8')
        cited |= set(re.findall(r'docs/[\w/]+\.md', text))
        assert not re.search(r'\bspec/\w', text), path
    assert cited and all((ROOT / page).exists() for page in cited)
