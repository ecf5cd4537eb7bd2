"""A node imports no heavy library at its start."""

import subprocess
import sys

from ins_sim.ros.main import main
import pytest
from support.places import ROOT


@pytest.mark.parametrize('node', ['motion_generator', 'imu_sensor', 'strapdown', 'gnss',
                                  'velocity_meter', 'aided_navigator'])
def test_a_node_imports_nothing_heavy(node):
    """A starting node does not import SciPy, Numba or matplotlib."""
    pytest.importorskip('rclpy')
    code = (f'import sys, ins_sim.ros.nodes.{node}\n'
            'heavy = {"scipy", "numba", "matplotlib", "rosbags", "rich"}\n'
            'print(sorted(heavy & set(sys.modules)))')
    found = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True,
                           check=True, cwd=ROOT)
    assert found.stdout.strip() == '[]'


@pytest.mark.parametrize('words, said', [
    ([], 'usage: python -m ins_sim.ros.main NODE'),
    (['nonsense'], "unknown node 'nonsense'; usage: python -m ins_sim.ros.main NODE")])
def test_no_node_is_exit_code_2(words, said, capsys):
    """Without the name of a node the exit code is 2, and the message lists the nodes."""
    assert main(words) == 2
    error = capsys.readouterr().err
    assert error.startswith(said) and 'aided_navigator' in error and error.count('\n') == 1
