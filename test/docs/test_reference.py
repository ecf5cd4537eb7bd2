"""The generators of the reference pages, tested without building the site."""

import ast
import importlib.util
import sys

from ins_sim import entry
import pytest
from support.places import ROOT


@pytest.fixture(scope='module')
def generate():
    """Return the package docs/_generate."""
    folder = ROOT / 'docs' / '_generate'
    spec = importlib.util.spec_from_file_location(
        '_generate', folder / '__init__.py', submodule_search_locations=[str(folder)])
    package = importlib.util.module_from_spec(spec)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, '_generate', package)
        spec.loader.exec_module(package)
        yield package


def test_only_changed_pages_are_written_and_others_deleted(generate, tmp_path, monkeypatch):
    """A second build leaves equal pages untouched, so that Sphinx does not read them again."""
    texts = {'a.md': 'one\n', 'folder/b.md': 'two\n'}
    monkeypatch.setattr(generate, 'pages', lambda: texts)
    generate.write_pages(tmp_path)
    a, b = tmp_path / 'a.md', tmp_path / 'folder' / 'b.md'
    before = a.stat().st_mtime_ns, b.stat().st_mtime_ns
    texts['folder/b.md'] = 'three\n'
    (tmp_path / 'old.md').write_text('')
    generate.write_pages(tmp_path)
    assert a.stat().st_mtime_ns == before[0]
    assert (a.read_text(), b.read_text()) == ('one\n', 'three\n')
    assert sorted(path.name for path in tmp_path.rglob('*.md')) == ['a.md', 'b.md']


def test_plain_words_become_markdown(generate):
    """Special characters are escaped, options and names become code, bars do not end a cell."""
    text = generate.markdown.text
    assert text('a * b < c_d [x] $5 | --all') == r'a \* b \< `c_d` \[x\] \$5 \| `--all`'
    assert text('see gyro.delay_us.x, ~/outage and -p.') == \
        'see `gyro.delay_us.x`, `~/outage` and `-p`.'
    assert text('10 Hz, 0.5 deg/s, and/or') == '10 Hz, 0.5 deg/s, and/or'
    assert generate.markdown.code('a|b') == r'`a\|b`'


def test_ranges_are_exact(generate):
    """A bound is written with all its digits."""
    number = generate.parameters._number
    assert [number(value) for value in (2147483647, 1e7, 0.001, 90.0)] == [
        '2147483647', '1e+07', '0.001', '90']


@pytest.mark.parametrize('name, more', [
    ('motion_generator', [entry.CONSUMER]), ('imu_sensor', [entry.FAULT]),
    ('strapdown', [entry.FAULT]), ('recorder', [entry.FAULT]),
    ('truth_adapter', [entry.FAULT, entry.CONSUMER]), ('player', [entry.FAULT, entry.CONSUMER]),
    ('simulation', [entry.FAULT, entry.CONSUMER])])
def test_exit_codes_of_a_node_are_those_that_it_names(name, more, generate):
    """Besides 0 and 2 a node has the exit codes that its module or a base class names."""
    assert generate.interfaces.node_exit_codes(name) == [entry.OK, entry.BAD_INPUT, *more]


def test_no_exit_code_is_a_number_elsewhere():
    """Commands and nodes return exit codes only by their names in ins_sim.entry."""
    for folder in ('cli', 'ros'):
        for path in (ROOT / 'ins_sim' / folder).rglob('*.py'):
            tree = ast.parse(path.read_text(encoding='utf-8'))
            runs = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)
                    and node.name in ('run', 'main', 'answer', 'node_main')]
            numbers = [node.value.value for function in runs for node in ast.walk(function)
                       if isinstance(node, ast.Return) and isinstance(node.value, ast.Constant)]
            assert set(numbers) <= {0, None}, path
