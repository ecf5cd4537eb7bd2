"""The package installs with pip and colcon, and the bootstrap script sets itself up."""

from importlib import import_module
import ast
import os
from pathlib import Path
import re
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

from ins_sim import graph, resources
import pytest
from support.places import ROOT

MANIFEST = ElementTree.parse(ROOT / 'package.xml').getroot()
SETUP = (ROOT / 'setup.py').read_text(encoding='utf-8')
SCRIPTS = dict(re.findall(r"'(\w+) = (ins_sim[\w.]+:\w+)'", SETUP))
FIND = ('from ins_sim import resources, __file__ as f; '
        'print(f); print(resources.config("default")); print(resources.launch("replay"))')


def run(command, **options):
    """Return the output of a command; if it fails, the test fails with both streams."""
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                            stdin=subprocess.DEVNULL, timeout=600, **options)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.fixture
def source(tmp_path):
    """Return a copy of the source tree, because a build leaves files next to the sources."""
    copy = tmp_path / 'src' / 'ins_sim'
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(
        '.git', '.venv*', 'build', 'install', 'log', '*.egg-info', '__pycache__'))
    return copy


@pytest.fixture
def clean_environment():
    """Return the environment without the variables set by the start-up hook of the wheels."""
    env = {name: value for name, value in os.environ.items() if name not in (
        '_ROS_WHEELS_BOOTSTRAP_COMPLETE', 'LD_LIBRARY_PATH', 'VIRTUAL_ENV', 'PYTHONPATH',
        'AMENT_PREFIX_PATH')}
    return env


def test_the_manifest_names_the_package():
    """package.xml has the name of the package; ``test_version`` compares the version."""
    assert MANIFEST.findtext('name') == 'ins_sim'


def test_graph_names_executables():
    """Each process of ins_sim.graph is an installed executable of the same module."""
    for process in (*graph.PROCESSES, *graph.AIDING, graph.RECORDER, graph.ONE_PROCESS):
        module, function = SCRIPTS[process.executable].split(':')
        assert function == process.executable
        assert graph.process_command(process)[2:4] == [module, process.executable]
    assert graph.MASTER in {process.name for process in graph.PROCESSES}


def test_command_passes_names_files_and_values():
    """process_command passes node name, parameter files and values as launch does."""
    words = graph.process_command(graph.PROCESSES[0], ['a.yaml'], [('rate_hz', 10.0)],
                                  namespace='/left')
    assert words[4:] == ['--ros-args', '-r', '__node:=strapdown', '-r', '__ns:=/left',
                         '--params-file', 'a.yaml', '-p', 'rate_hz:=10.0']


def test_scripts_exist():
    """Each console script refers to an existing function."""
    assert set(SCRIPTS) == {'motion_generator', 'imu_sensor', 'strapdown', 'velocity_meter',
                            'gnss', 'aided_navigator', 'recorder', 'truth_adapter', 'simulation',
                            'ins_sim'}
    for entry in SCRIPTS.values():
        module, function = entry.split(':')
        assert callable(getattr(import_module(module), function))


def test_missing_configuration_is_named_with_those_there_are():
    """An unknown parameter file is refused with the known names."""
    with pytest.raises(FileNotFoundError, match="no config named 'motion_3'; expected one of "
                                                '.*motion_1, motion_2'):
        resources.config('motion_3')


def test_resources_stand_without_ament(monkeypatch):
    """Without ROS the parameter files are found."""
    monkeypatch.delenv('AMENT_PREFIX_PATH', raising=False)
    assert resources.config('default').is_file()
    monkeypatch.setitem(sys.modules, 'ament_index_python', None)
    monkeypatch.setitem(sys.modules, 'ament_index_python.packages', None)
    assert resources.config('default').is_file()


def imported_packages():
    """Return the names of the packages that the modules of ins_sim import."""
    names = set()
    for path in (ROOT / 'ins_sim').rglob('*.py'):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                names.update(alias.name.partition('.')[0] for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names.add(node.module.partition('.')[0])
    return names - set(sys.stdlib_module_names) - {'ins_sim'}


def test_run_time_needs_five_libraries_and_ros():
    """Each imported library is a run-time requirement, part of ROS, or an extra."""
    required = re.search(r'install_requires=\[(.*?)\]', SETUP, re.DOTALL).group(1)
    assert re.findall(r"'(\w+)", required) == ['numpy', 'scipy', 'pyyaml', 'matplotlib', 'rich']
    of_ros = {element.text for element in MANIFEST.iter('exec_depend')}
    # pytest: ins_sim.testing defines a fixture if it is installed.
    extras = {'pandas', 'numba', 'pygeomag', 'bokeh', 'xarray', 'distributed', 'pytest'}
    assert imported_packages() <= {'numpy', 'scipy', 'yaml', 'matplotlib', 'rich'} | (
        of_ros | extras)


# Packages of Jazzy and of Ubuntu 24.04; look a new dependency up in rosdistro and add it.
KEYS = {
    'ament_index_python', 'diagnostic_msgs', 'geometry_msgs', 'launch', 'launch_ros', 'nav_msgs',
    'rcl_interfaces', 'rclpy', 'ros2launch', 'rosgraph_msgs', 'sensor_msgs', 'std_msgs',
    'std_srvs', 'tf2_msgs', 'python3-flake8', 'python3-hypothesis', 'python3-matplotlib',
    'python3-numpy', 'python3-pytest', 'python3-rich', 'python3-scipy', 'python3-setuptools',
    'python3-yaml'}


def test_manifest_depends_on_packages_of_ubuntu_alone():
    """
    package.xml depends on packages of ROS and Ubuntu only.

    A release of a ROS distribution may not depend on keys that rosdep installs from PyPI.
    """
    names = {element.text for element in MANIFEST if element.tag.endswith('depend')}
    assert names == KEYS
    for library in ('numpy', 'scipy', 'yaml', 'matplotlib', 'rich'):
        assert f'python3-{library}' in names


@pytest.mark.slow
def test_pip_install(source, tmp_path, clean_environment):
    """``pip install .`` in a new environment gives the scripts, which find their configuration."""
    python = tmp_path / 'venv' / 'bin' / 'python'
    run([sys.executable, '-m', 'venv', tmp_path / 'venv'], env=clean_environment)
    run([python, '-m', 'pip', 'install', '--quiet', '--prefer-binary', source],
        env=clean_environment)
    for script in SCRIPTS:
        assert (python.parent / script).is_file()
    module, config, launch = run([python, '-c', FIND], cwd=tmp_path,
                                 env=clean_environment).split()
    for path in (module, config, launch):
        assert Path(path).is_relative_to(tmp_path / 'venv')
    run([python.parent / 'ins_sim', '--help'], cwd=tmp_path, env=clean_environment)
    listed = run([python, '-m', 'pip', 'list', '--format', 'freeze'], env=clean_environment)
    names = {line.partition('==')[0].lower() for line in listed.split()}
    print(f'pip install . : {len(names)} packages, {", ".join(sorted(names))}')
    assert len(names - {'pip', 'setuptools', 'wheel'}) <= 20
    # The definitions of the messages are installed with the package.
    run([python.parent / 'ins_sim', 'simulate', '-p', 'duration_s:=1.0', '-o', 'run', '--bag',
         'bag'], cwd=tmp_path, env=clean_environment)


def test_colcon_build(source, tmp_path):
    """``colcon build`` installs everything where ``ros2 run`` and the ament index search."""
    pytest.importorskip('colcon_ros', reason='colcon-ros is not installed')
    pytest.importorskip('ament_index_python', reason='no ROS: nothing to build upon')
    env = dict(os.environ)
    env.setdefault('AMENT_PREFIX_PATH', sys.prefix)
    run([sys.executable, '-m', 'colcon', 'build', '--base-paths', source.parent], cwd=tmp_path,
        env=env)
    prefix = tmp_path / 'install' / 'ins_sim'
    for script in SCRIPTS:
        assert os.access(prefix / 'lib' / 'ins_sim' / script, os.X_OK)
    # The variables that sourcing the workspace sets.
    env['AMENT_PREFIX_PATH'] = f'{prefix}{os.pathsep}{env["AMENT_PREFIX_PATH"]}'
    site, = (prefix / 'lib').glob('python*/site-packages')
    env['PYTHONPATH'] = os.pathsep.join([str(site), *filter(None, [env.get('PYTHONPATH')])])
    module, config, launch = run([sys.executable, '-c', FIND], cwd=tmp_path, env=env).split()
    for path in (module, config, launch):
        assert Path(path).is_relative_to(prefix)
    assert (Path(module).parent / 'bags' / 'message_types.json').is_file()
    index = ('from ament_index_python.packages import get_package_prefix as find; '
             'print(find("ins_sim"))')
    assert run([sys.executable, '-c', index], cwd=tmp_path, env=env).strip() == str(prefix)
    run([prefix / 'lib' / 'ins_sim' / 'ins_sim', '--help'], cwd=tmp_path, env=env)


def bootstrap(source, environment, *command):
    """Return the finished run of the bootstrap script of a source tree."""
    return subprocess.run([sys.executable, source / 'tools' / 'bootstrap.py', *command],
                          env=environment, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=600)


def test_sourced_ros_without_rclpy_is_refused(source, tmp_path, clean_environment):
    """The bootstrap script never mixes wheels with the libraries of a sourced ROS."""
    # A module that cannot be imported hides the rclpy of this environment.
    (tmp_path / 'rclpy.py').write_text('raise ImportError\n')
    result = bootstrap(source, {**clean_environment, 'ROS_DISTRO': 'jazzy',
                                'AMENT_PREFIX_PATH': str(tmp_path), 'PYTHONPATH': str(tmp_path)})
    assert result.returncode == 1
    assert 'install ros-jazzy-rclpy' in result.stderr
    assert not (source / '.venv').exists()


def test_an_interrupted_set_up_says_so_in_one_sentence(source, clean_environment, tmp_path):
    """Ctrl-C during a step of the set-up gives one message; the step here makes no .venv."""
    mark = tmp_path / 'started'
    (source / 'tools' / 'slow.py').write_text(
        'import os, pathlib, sys, time\nsys.path.insert(0, os.path.dirname(__file__))\n'
        'import bootstrap\n'
        f'code = "import pathlib, time; pathlib.Path({str(mark)!r}).touch(); time.sleep(600)"\n'
        'bootstrap.main = lambda: bootstrap.run([sys.executable, "-c", code], False, "waiting")\n'
        'bootstrap.started()\n')
    process = subprocess.Popen([sys.executable, source / 'tools' / 'slow.py'], text=True,
                               env=clean_environment, stderr=subprocess.PIPE)
    while not mark.exists():
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    error = process.communicate()[1]
    assert process.returncode == 130
    assert error == 'ins_sim: interrupted; the next call goes on or starts over\n'


@pytest.mark.slow
def test_bootstrap_recovers_and_needs_no_network_again(source, clean_environment):
    """An incomplete environment is made again, and a complete one is used without network."""
    offline = {**clean_environment, 'PIP_NO_INDEX': '1', 'PIP_CONFIG_FILE': os.devnull}
    offline.pop('PIP_FIND_LINKS', None)
    result = bootstrap(source, offline)
    assert result.returncode == 1 and 'installing failed' in result.stderr
    assert (source / '.venv').exists()
    result = bootstrap(source, clean_environment, 'python', '-c', 'import ins_sim')
    assert result.returncode == 0, result.stderr
    result = bootstrap(source, offline, 'ins_sim', '--help')
    assert result.returncode == 0 and 'installing' not in result.stderr
