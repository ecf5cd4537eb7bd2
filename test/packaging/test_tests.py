"""The tests: short files, small folders, no timing, shared code in test/support."""

import ast

from support.each import each
from support.places import ROOT

TESTS = ROOT / 'test'
FILES = {str(path.relative_to(TESTS)): path for path in sorted(TESTS.rglob('*.py'))}
FOLDERS = sorted({path.parent for path in FILES.values()})


@each(FILES)
def test_a_file_is_short(name):
    """A test file has at most 300 lines."""
    assert len(FILES[name].read_text(encoding='utf-8').splitlines()) <= 300


@each(FOLDERS)
def test_a_folder_is_a_table_of_contents(folder):
    """A test folder has at most 24 entries."""
    assert len([path for path in folder.iterdir() if path.name != '__pycache__']) <= 24


@each(FILES)
def test_nothing_is_imported_from_a_test_and_no_path_is_set(name):
    """Shared code is in test/support; no test imports a test or changes sys.path."""
    tree = ast.parse(FILES[name].read_text(encoding='utf-8'))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            assert not any(part.startswith('test_') for part in (node.module or '').split('.'))
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            assert (node.value.id, node.attr) != ('sys', 'path')


@each(FILES)
def test_nothing_is_timed(name):
    """No test asserts a speed, which benchmarks measure; a clock may only guard against a hang."""
    text = FILES[name].read_text(encoding='utf-8')
    assert 'perf_' + 'counter' not in text and 'time.time' + '()' not in text
