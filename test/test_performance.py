"""What the core costs in pure Python; the figures are printed."""

import importlib.util
from pathlib import Path
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope='module')
def benchmark():
    """Return the module benchmarks/core_step.py."""
    spec = importlib.util.spec_from_file_location('core_step', ROOT / 'benchmarks/core_step.py')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize('output', ['rotation_vector', 'integrated'])
def test_one_step_of_imu_and_strapdown(benchmark, output):
    """At most 60 us of CPU together, with three delays, solution, errors and drift."""
    imu, navigator = benchmark.step_us(output=output)
    print(f'\n{output}: IMU {imu:.1f} us + strapdown {navigator:.1f} us = '
          f'{imu + navigator:.1f} us (60)')
    assert imu + navigator <= 60.0


def test_one_step_of_tuned_gyros_with_every_error(benchmark):
    """At most 120 us of CPU, from the bytes of the truth to those of reading and parity."""
    us = benchmark.tuned_step_us()
    print(f'\ntwo tuned gyros and every error: {us:.1f} us (120)')
    assert us <= 120.0


@pytest.mark.slow
def test_an_hour_offline(benchmark):
    """One hour of motion 2 at 100 Hz in at most 60 s."""
    seconds = benchmark.hour_s()
    print(f'\none hour of motion 2 at 100 Hz: {seconds:.1f} s of CPU (60)')
    assert seconds <= 60.0


@pytest.mark.parametrize('node', ['motion_generator', 'imu_sensor', 'strapdown', 'gnss',
                                  'velocity_meter', 'aided_navigator'])
def test_a_node_imports_nothing_heavy(node):
    """No SciPy, Numba or matplotlib on the way of a node's start."""
    pytest.importorskip('rclpy')
    code = (f'import sys, ins_sim.ros.nodes.{node}\n'
            'heavy = {"scipy", "numba", "matplotlib", "rosbags", "rich"}\n'
            'print(sorted(heavy & set(sys.modules)))')
    found = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True,
                           check=True, cwd=ROOT)
    assert found.stdout.strip() == '[]'
