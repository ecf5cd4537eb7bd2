"""Names, arrays and pages that the documents and the code cite exist."""

import importlib
import re

import ins_sim
from ins_sim.cli.main import main
import numpy as np
from support.each import each
from support.pages import page_id, PAGES
from support.places import ROOT

DOCUMENTS = [page for page in PAGES if page.name != 'README.md']


@each(DOCUMENTS, page_id)
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


def test_what_docstrings_cite_can_be_opened():
    """Pages of docs/ that code and configuration cite exist; nothing cites an unshipped file."""
    cited = set()
    for path in [*(ROOT / 'ins_sim').rglob('*.py'), *(ROOT / 'config').glob('*.yaml')]:
        text = path.read_text(encoding='utf-8')
        cited |= set(re.findall(r'docs/[\w/]+\.md', text))
        assert not re.search(r'\bspec/\w', text), path
    assert cited and all((ROOT / page).exists() for page in cited)
