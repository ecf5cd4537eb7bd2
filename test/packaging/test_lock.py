"""The lock file has the requirements of setup.py, for every supported Python, with hashes."""

import importlib.util
from pathlib import Path
import re
import runpy

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
import pytest
import setuptools
from support.places import ROOT

LOCK = (ROOT / 'requirements.lock').read_text(encoding='utf-8')
PYTHONS = ['3.10', '3.11', '3.12', '3.13', '3.14']
# One requirement: a line "name==version ; marker \" and its hashes.
ENTRY = re.compile(r'(?P<requirement>[a-z][^\\\n]*?)'
                   r'(?P<hashes>(?: \\\n    --hash=sha256:[0-9a-f]{64})+)\n')


@pytest.fixture
def setup_arguments(monkeypatch):
    """Return the keyword arguments that setup.py passes to setuptools."""
    given = {}
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(setuptools, 'setup', given.update)
    runpy.run_path('setup.py')
    return given


def environment(python):
    """Return the environment markers of a Python on a machine with wheels of rclpy."""
    return {'python_version': python, 'python_full_version': f'{python}.1',
            'sys_platform': 'linux', 'platform_system': 'Linux', 'platform_machine': 'x86_64',
            'os_name': 'posix', 'platform_python_implementation': 'CPython',
            'implementation_name': 'cpython', 'extra': ''}


def locked(python):
    """Return {name: version} of what is installed for a Python; a name must be unique."""
    versions = {}
    for entry in ENTRY.finditer(LOCK):
        requirement = Requirement(entry['requirement'])
        if requirement.marker is None or requirement.marker.evaluate(environment(python)):
            version, = requirement.specifier
            assert version.operator == '=='
            assert requirement.name not in versions
            versions[requirement.name] = version.version
    return versions


def test_every_requirement_has_a_version_and_hashes():
    """The lock file has only requirements with version and hashes: no option and no comment."""
    assert ENTRY.sub('', LOCK) == ''
    assert len(ENTRY.findall(LOCK)) > 100


def test_no_index_is_named():
    """The lock file names no package index."""
    for word in ('://', '--index', '--extra', '--find', ' @ '):
        assert word not in LOCK


@pytest.mark.parametrize('python', PYTHONS)
def test_what_setup_asks_for_is_locked(setup_arguments, python):
    """
    Requirements, extras and rclpy are locked to versions that setup.py allows.

    The extras are test, compression and dataframe.
    """
    versions = locked(python)
    extras = setup_arguments['extras_require']
    for text in [*setup_arguments['install_requires'], *extras['ros'], *extras['test'],
                 *extras['compression'], *extras['dataframe']]:
        wanted = Requirement(text)
        if wanted.marker is None or wanted.marker.evaluate(environment(python)):
            assert wanted.specifier.contains(versions[canonicalize_name(wanted.name)]), text


@pytest.mark.parametrize('python', PYTHONS)
def test_the_locked_setuptools_builds_the_package(python):
    """
    The locked setuptools is at least 70.1 and below 80.

    From 70.1 on it needs no package wheel; before 80 it has the command develop, which colcon
    uses.
    """
    major, minor = map(int, locked(python)['setuptools'].split('.')[:2])
    assert (70, 1) <= (major, minor) < (80, 0)


@pytest.fixture
def bootstrap():
    """Return the module tools/bootstrap.py."""
    spec = importlib.util.spec_from_file_location('bootstrap', ROOT / 'tools' / 'bootstrap.py')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_changed_lock_is_noticed(bootstrap, monkeypatch, tmp_path):
    """A changed lock file changes the stamp of the virtual environment."""
    before = bootstrap.digest_of_requirements()
    other = tmp_path / 'requirements.lock'
    monkeypatch.setattr(bootstrap, 'LOCK', str(other))
    other.write_text(LOCK, encoding='utf-8')
    assert bootstrap.digest_of_requirements() == before
    other.write_text(LOCK.replace('numpy==', 'numpy==1', 1), encoding='utf-8')
    assert bootstrap.digest_of_requirements() != before


def installed_by(bootstrap, monkeypatch, tmp_path, with_ros, **facts):
    """Return the options of each call of pip on a machine."""
    calls = []
    monkeypatch.setattr(bootstrap, 'VENV', str(tmp_path))
    monkeypatch.setattr(bootstrap, 'run', lambda command, *_: calls.append(command[4:]))
    bootstrap.install({'system': 'linux', 'machine': 'x86_64', 'libc': ('glibc', '2.36'),
                       'version': [3, 11, 7], 'numpy': None, **facts}, with_ros, fresh=False)
    return calls


def test_without_ros_the_lock_is_installed(bootstrap, monkeypatch, tmp_path):
    """Without ROS the lock is installed with hashes, and the package without dependencies."""
    libraries, package = installed_by(bootstrap, monkeypatch, tmp_path, with_ros=False)
    assert {'--require-hashes', '--requirement', bootstrap.LOCK} <= set(libraries)
    assert {'--no-deps', '--no-build-isolation', '--editable'} <= set(package)


def test_beside_ros_the_lock_is_left_alone(bootstrap, monkeypatch, tmp_path):
    """With a sourced ROS the lock is not used, so that NumPy remains that of ROS."""
    monkeypatch.setenv('ROS_DISTRO', 'jazzy')
    command, = installed_by(bootstrap, monkeypatch, tmp_path, with_ros=True, numpy='1.26.4')
    assert bootstrap.LOCK not in command and '--require-hashes' not in command
    constraints = Path(command[command.index('--constraint') + 1])
    assert constraints.read_text(encoding='utf-8') == 'numpy==1.26.4\n'


@pytest.mark.parametrize('facts', [{'machine': 'aarch64'}, {'version': [3, 15, 0]},
                                   {'libc': ('', '')}])
def test_without_wheels_of_rclpy_the_lock_is_left_alone(bootstrap, monkeypatch, tmp_path, facts):
    """On machines without wheels of rclpy the lock, which contains them, is not used."""
    command, = installed_by(bootstrap, monkeypatch, tmp_path, with_ros=False, **facts)
    assert bootstrap.LOCK not in command and '--constraint' not in command
