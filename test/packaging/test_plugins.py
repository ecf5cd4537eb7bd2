"""The tests are collected beside the pytest plugins of ROS."""

import os
import subprocess
import sys

import pytest
from support.places import ROOT


@pytest.mark.parametrize('plugin', ['launch_testing', 'launch_ros'])
def test_a_plugin_of_launch_testing_is_not_loaded(plugin, tmp_path):
    """It would import each test file by its bare name, and several files have the same."""
    (tmp_path / 'plugin_of_ros.py').write_text('raise SystemExit("the plugin was loaded")')
    installed = tmp_path / 'plugin_of_ros-1.0.dist-info'
    installed.mkdir()
    (installed / 'METADATA').write_text(
        'Metadata-Version: 2.1\nName: plugin_of_ros\nVersion: 1.0\n')
    (installed / 'entry_points.txt').write_text(f'[pytest11]\n{plugin} = plugin_of_ros\n')
    path = os.pathsep.join([str(tmp_path), os.environ.get('PYTHONPATH', '')])
    ended = subprocess.run(
        [sys.executable, '-m', 'pytest', '--collect-only', '-q', '-p', 'no:cacheprovider',
         'test/packaging/test_version.py'],
        cwd=ROOT, env={**os.environ, 'PYTHONPATH': path}, capture_output=True, text=True,
        check=False, timeout=120.0)
    assert ended.returncode == 0, ended.stdout + ended.stderr
