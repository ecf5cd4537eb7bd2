"""The style: PEP 8 with 99 columns, and single quotes."""

import subprocess
import sys
import tokenize

import pytest
from support.places import ROOT

FOLDERS = ('ins_sim', 'test', 'launch', 'tools', 'benchmarks', 'setup.py')
SOURCES = [path for name in FOLDERS
           for path in ([ROOT / name] if name.endswith('.py') else (ROOT / name).rglob('*.py'))]


def test_flake8():
    """Flake8 finds nothing."""
    pytest.importorskip('flake8')
    result = subprocess.run(
        [sys.executable, '-m', 'flake8', *(name for name in FOLDERS if (ROOT / name).exists())],
        cwd=ROOT, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_single_quotes():
    """Double quotes are used only for docstrings and for texts with a single quote."""
    wrong = []
    for path in SOURCES:
        with open(path, 'rb') as stream:
            for token in tokenize.tokenize(stream.readline):
                text = token.string.lstrip('rbfuRBFU')
                if (token.type == tokenize.STRING and text.startswith('"')
                        and not text.startswith('"""') and "'" not in text):
                    wrong.append(f'{path.relative_to(ROOT)}:{token.start[0]}')
    assert not wrong
