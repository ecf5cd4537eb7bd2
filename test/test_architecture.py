"""The directions of the imports, and the size of the files, are those of the design."""

import ast
from pathlib import Path
import sys

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / 'ins_sim'
FILES = {'.'.join(path.relative_to(ROOT).with_suffix('').parts).removesuffix('.__init__'): path
         for path in sorted(PACKAGE.rglob('*.py'))}
LONGEST = 350
# What numerics has no business with: the edges of the program are elsewhere.
NOT_IN_CORE = {'argparse', 'logging'}
LAZY = {'numba'}


def imports(name, tree, nodes=None):
    """Return the absolute names that a module imports, ``from x import y`` as x and x.y."""
    package = name if FILES[name].name == '__init__.py' else name.rpartition('.')[0]
    found = set()
    for node in ast.walk(tree) if nodes is None else nodes:
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ''
            if node.level:
                parts = package.split('.')[:len(package.split('.')) - node.level + 1]
                base = '.'.join([*parts, base]).rstrip('.')
            found.add(base)
            found.update(f'{base}.{alias.name}' for alias in node.names)
    return found


def eager(tree):
    """Yield the nodes that run on import: all but the bodies of functions."""
    stack = [tree]
    while stack:
        node = stack.pop()
        yield node
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            stack.extend(ast.iter_child_nodes(node))


TREES = {name: ast.parse(path.read_text(encoding='utf-8')) for name, path in FILES.items()}
IMPORTS = {name: imports(name, tree) for name, tree in TREES.items()}
EAGER = {name: imports(name, tree, eager(tree)) for name, tree in TREES.items()}


def inside(*rooms):
    """Return the names of the modules of some rooms."""
    return [name for name in FILES
            if any(f'{name}.'.startswith(f'ins_sim.{room}.') for room in rooms)]


def tops(names):
    """Return the first parts of names."""
    return {name.partition('.')[0] for name in names}


def rooms(names):
    """Return the rooms of ins_sim that names lie in."""
    return {name.split('.')[1] for name in names if name.startswith('ins_sim.')}


@pytest.mark.parametrize('name', inside('core'))
def test_core_imports_only_numerics(name):
    """Core knows the standard library, NumPy, SciPy, itself and, inside functions, Numba."""
    standard = set(sys.stdlib_module_names) - NOT_IN_CORE
    allowed = standard | {'numpy', 'scipy', 'ins_sim'} | LAZY
    assert tops(IMPORTS[name]) <= allowed
    assert not tops(EAGER[name]) & LAZY, 'import numba inside the function that needs it'
    assert rooms(IMPORTS[name]) <= {'core', '__version__'}


@pytest.mark.parametrize('name', inside('messages'))
def test_messages_import_only_core_and_numpy(name):
    """Messages are packed without ROS."""
    assert tops(IMPORTS[name]) <= set(sys.stdlib_module_names) | {'numpy', 'ins_sim'}
    assert rooms(IMPORTS[name]) <= {'core', 'messages'}


@pytest.mark.parametrize('name', [name for name in FILES if name not in inside('ros')])
def test_only_the_room_ros_imports_rclpy_at_once(name):
    """Without ROS everything but ins_sim.ros can be imported."""
    assert 'rclpy' not in tops(EAGER[name])


def test_there_is_no_import_cycle():
    """The modules of ins_sim can be sorted so that each imports only earlier ones."""
    graph = {name: {other for other in EAGER[name] if other in FILES and other != name}
             for name in FILES}
    while graph:
        free = {name for name, needs in graph.items() if not needs & set(graph)}
        assert free, f'import cycle among {sorted(graph)}'
        graph = {name: needs for name, needs in graph.items() if name not in free}


@pytest.mark.parametrize('name', FILES)
def test_file_is_short_and_has_a_telling_name(name):
    """A file that needs more lines, or is named utils, holds more than one thing."""
    assert len(FILES[name].read_text(encoding='utf-8').splitlines()) <= LONGEST
    assert name.rpartition('.')[2] not in ('utils', 'util', 'helpers', 'misc')
