"""Imports between packages, and the sizes of files and folders, follow the design."""

import ast
import re
import sys

from support.each import each
from support.places import ROOT

PACKAGE = ROOT / 'ins_sim'
FILES = {'.'.join(path.relative_to(ROOT).with_suffix('').parts).removesuffix('.__init__'): path
         for path in sorted(PACKAGE.rglob('*.py'))}
LONGEST = 300
# Modules that core must not import, because only the edges of the program use them.
NOT_IN_CORE = {'argparse', 'logging'}
LAZY = {'numba'}
# The modules that may use them: compiled code is cached in the user's folder, and slow
# compilations are logged.
COMPILES = ('ins_sim.core.numerics.compile_cache', 'ins_sim.core.numerics.compilation')


def imports(name, tree, nodes=None):
    """Return the absolute names that a module imports; ``from x import y`` counts as x and x.y."""
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
    """Yield the nodes that are executed on import: all except the bodies of functions."""
    stack = [tree]
    while stack:
        node = stack.pop()
        if isinstance(node, ast.If) and ast.unparse(node.test) == 'TYPE_CHECKING':
            # Only type checkers read this branch.
            continue
        yield node
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            stack.extend(ast.iter_child_nodes(node))


TREES = {name: ast.parse(path.read_text(encoding='utf-8')) for name, path in FILES.items()}
IMPORTS = {name: imports(name, tree) for name, tree in TREES.items()}
EAGER = {name: imports(name, tree, eager(tree)) for name, tree in TREES.items()}


# The packages that each package of ins_sim may import in addition to itself. This is the only
# place that lists them.
EARTH = {'core.numerics', 'core.attitude', 'core.earth'}
STREAMS = EARTH | {'core.timeseries', 'core.streams'}
CORE = {'core.numerics', 'core.attitude', 'core.earth', 'core.timeseries', 'core.streams',
        'core.motion', 'core.sensors', 'core.navigation', 'core.aiding', 'core.guidance',
        'core.postprocessing', 'core.prediction', 'core.simulation', 'core.ensemble',
        'core.standalone', 'core.calibration'}
FILES_AND_BAGS = CORE | {'settings', 'messages', 'bags', 'io', 'parameter_files', 'resources',
                         'graph', 'studies', 'report', 'jobs', 'regular_file', 'own_folders',
                         'ros_parameters', 'visible_text', 'yaml_text'}
MAY_IMPORT = {
    'settings': set(),
    'core.numerics': set(),
    'core.timeseries': set(),
    'core.attitude': {'core.numerics'},
    'core.earth': {'core.numerics', 'core.attitude'},
    'core.streams': EARTH,
    'core.motion': STREAMS - {'core.streams'},
    'core.sensors': STREAMS | {'settings'},
    'core.navigation': STREAMS,
    'core.aiding': STREAMS | {'settings', 'core.navigation'},
    'core.guidance': EARTH | {'settings', 'core.motion'},
    'core.postprocessing': EARTH | {'settings', 'core.timeseries', 'core.navigation'},
    'core.calibration': EARTH | {'settings', 'core.timeseries', 'core.motion', 'core.sensors'},
    'core.prediction': EARTH | {'settings', 'core.timeseries', 'core.navigation', 'core.motion',
                                'core.sensors'},
    'core.simulation': (CORE | {'settings'}) - {'core.postprocessing', 'core.prediction',
                                                'core.ensemble', 'core.standalone',
                                                'core.calibration'},
    'core.standalone': EARTH | {'settings', 'core.timeseries', 'core.navigation',
                                'core.postprocessing', 'core.simulation'},
    'core.ensemble': STREAMS | {'settings', 'core.motion', 'core.sensors', 'core.navigation',
                                'core.aiding', 'core.simulation'},
    'studies': CORE | {'settings', 'jobs'},
    'messages': {'core.attitude', 'core.timeseries'},
    'jobs': {'settings', 'core.numerics', 'core.timeseries', '__version__'},
    'bags': {'messages', 'settings.suggest', 'settings.shown', 'own_folders', 'regular_file',
             'visible_text', 'yaml_text'},
    'own_folders': set(),
    'visible_text': set(),
    'regular_file': set(),
    'io': CORE | {'bags', 'messages', 'settings', 'regular_file'},
    'yaml_text': {'settings.shown', 'regular_file'},
    'ros_parameters': {'settings.shown', 'yaml_text'},
    'parameter_files': {'settings', 'ros_parameters', 'yaml_text'},
    'resources': {'settings.suggest'},
    'graph': {'messages'},
    'launching': {'graph', 'messages', 'resources', 'ros_parameters', 'settings', 'yaml_text'},
    # Imported first by every command.
    'entry': {'cli'},
    '__main__': {'entry'},
    'report': CORE | {'settings', 'studies', 'jobs', 'parameter_files', 'regular_file',
                      'visible_text', 'io.csv_writer'},
    'api': FILES_AND_BAGS,
    'ros': FILES_AND_BAGS | {'entry'},
    'testing': {'api', 'messages', 'parameter_files', 'ros', 'settings'},
    'cli': FILES_AND_BAGS | {'ros', 'entry', '__version__'},
    # The public names; those not in api are imported for annotations.
    '__init__': {'api', 'bags', 'core.motion', 'core.prediction', 'settings'},
}


def room_of(name):
    """Return the package in which a module lies: 'core.attitude', 'io', 'graph'."""
    parts = name.split('.')[1:]
    return '.'.join(parts[:2]) if parts[:1] == ['core'] else parts[0] if parts else '__init__'


def inside(*rooms):
    """Return the names of the modules of some packages."""
    return [name for name in FILES
            if any(f'{name}.'.startswith(f'ins_sim.{room}.') for room in rooms)]


def tops(names):
    """Return the first components of dotted names."""
    return {name.partition('.')[0] for name in names}


@each(FILES)
def test_imports_are_those_of_the_table(name):
    """A module imports only its own package and those listed in MAY_IMPORT."""
    room = room_of(name)
    allowed = MAY_IMPORT.get(room, set()) | {room}
    for other in IMPORTS[name]:
        if other.startswith('ins_sim.') and other not in ('ins_sim.core',):
            # Importing a name from a module imports the module.
            known = other if other in FILES else other.rpartition('.')[0]
            if known != 'ins_sim':
                assert (room_of(known) in allowed
                        or known.removeprefix('ins_sim.') in allowed), other


@each(inside('core'))
def test_core_imports_only_numerics(name):
    """core imports the standard library, NumPy, SciPy, itself and, inside functions, Numba."""
    standard = set(sys.stdlib_module_names) - (NOT_IN_CORE if name not in COMPILES else set())
    allowed = standard | {'numpy', 'scipy', 'ins_sim'} | LAZY
    assert tops(IMPORTS[name]) <= allowed
    assert not tops(EAGER[name]) & LAZY, 'import numba inside the function that needs it'


@each(inside('core'))
def test_core_opens_no_file(name):
    """core opens no file; files are read and written by ins_sim.io and ins_sim.bags."""
    called = {node.func.id for node in ast.walk(TREES[name])
              if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    assert 'open' not in called
    files = {'os', 'pathlib', 'io', 'gzip', 'csv', 'tempfile', 'yaml'}
    assert name == COMPILES[0] or not tops(IMPORTS[name]) & files


@each(inside('core'))
def test_core_reads_no_setting_of_a_node(name):
    """core reads no node setting (depths of queues, pacing, epoch); nodes pass what is needed."""
    read = {node.attr for node in ast.walk(TREES[name])
            if isinstance(node, ast.Attribute) and 'settings' in ast.unparse(node.value)}
    assert not read & {'topics', 'pacing', 'time'}


@each(inside('settings'))
def test_settings_need_only_python(name):
    """Settings are read without NumPy."""
    assert tops(IMPORTS[name]) <= set(sys.stdlib_module_names) | {'ins_sim'}


@each(inside('messages'))
def test_messages_need_only_numpy(name):
    """Messages are packed without ROS."""
    assert tops(IMPORTS[name]) <= set(sys.stdlib_module_names) | {'numpy', 'ins_sim'}


@each(name for name in FILES if name not in inside('ros'))
def test_only_the_room_ros_imports_rclpy_at_once(name):
    """All packages except ins_sim.ros can be imported without ROS."""
    assert 'rclpy' not in tops(EAGER[name])


@each(name for name, path in FILES.items() if path.name == '__init__.py' and name != 'ins_sim')
def test_a_room_holds_only_its_docstring(name):
    """The file __init__ of a package states what is in it, and imports nothing."""
    assert ast.get_docstring(TREES[name])
    assert len(TREES[name].body) == 1


def test_no_class_name_twice():
    """No name of a class is used twice in ins_sim."""
    found = {}
    for name, tree in TREES.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                found.setdefault(node.name, []).append(name)
    assert {cls: names for cls, names in found.items() if len(names) > 1} == {}


@each(FILES)
def test_imports_are_relative_inside_a_room_and_absolute_across(name):
    """Imports across packages are absolute, and those within one package are relative."""
    for node in ast.walk(TREES[name]):
        if isinstance(node, ast.ImportFrom):
            base = '.'.join(name.split('.')[:-1 * node.level] if FILES[name].name != '__init__.py'
                            else name.split('.')) if node.level else node.module
            if base.partition('.')[0] == 'ins_sim' and room_of(name) != '__init__':
                target = f'{base}.{node.module}' if node.level and node.module else base
                same = room_of(f'{target}.x') == room_of(name)
                assert same == bool(node.level), ast.unparse(node)


@each(sorted({path.parent for path in FILES.values()}))
def test_a_folder_is_a_table_of_contents(folder):
    """A folder has at most 24 entries, or 16 in the packages of core."""
    entries = [path for path in folder.iterdir()
               if path.name not in ('__pycache__', '__init__.py')]
    most = 16 if 'core' in folder.relative_to(ROOT).parts else 24
    assert len(entries) <= most


def test_there_is_no_import_cycle():
    """The modules of ins_sim can be sorted so that each imports only earlier ones."""
    graph = {name: {other for other in EAGER[name] if other in FILES and other != name}
             for name in FILES}
    while graph:
        free = {name for name, needs in graph.items() if not needs & set(graph)}
        assert free, f'import cycle among {sorted(graph)}'
        graph = {name: needs for name, needs in graph.items() if name not in free}


@each(FILES)
def test_file_is_short_and_has_a_telling_name(name):
    """No file has more than 300 lines or a name like utils, which would show several purposes."""
    assert len(FILES[name].read_text(encoding='utf-8').splitlines()) <= LONGEST
    assert name.rpartition('.')[2] not in ('utils', 'util', 'helpers', 'misc')


def test_contributing_shows_the_rooms_in_the_order_of_their_imports():
    """CONTRIBUTING.md lists all packages; each imports only its own row and the rows above it."""
    text = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')
    table = text.partition('| rooms | content |')[2].partition('\n\n')[0]
    row_of = {room: row for row, line in enumerate(table.splitlines())
              for room in re.findall(r'`([\w.]+)`', line.partition(' | ')[0])}
    assert set(row_of) == set(MAY_IMPORT) - {'__version__'}
    for room, others in MAY_IMPORT.items():
        for other in others - {'__version__'}:
            known = other if other in row_of else other.rpartition('.')[0]
            assert row_of[known] <= row_of[room], (room, other)
