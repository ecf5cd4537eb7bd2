"""A short soak run prints its results and loses nothing at a low rate."""

import os
import re
import subprocess
import sys

import pytest
from support.live import GUARD_S
from support.places import ROOT

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live
NODES = ('recorder', 'strapdown', 'imu_sensor', 'motion_generator')


@pytest.mark.slow
def test_a_short_soak(ros_domain, tmp_path):
    """The exit code is 0; losses, latency, memory, handles, CPU and load are printed."""
    ended = subprocess.run(
        [sys.executable, ROOT / 'tools' / 'soak.py', '10', '100', tmp_path / 'soak'],
        env={**os.environ, 'PYTHONPATH': str(ROOT)}, capture_output=True, text=True,
        timeout=10.0 + GUARD_S, stdin=subprocess.DEVNULL)
    said = ended.stdout
    assert ended.returncode == 0, said + ended.stderr
    for name in NODES:
        assert re.search(rf'^{name}: [\d.]+ MB, [-+][\d.]+ MB a day, \d+ to \d+ handles, [\d.]+ % '
                         'of a core$', said, re.MULTILINE), said
    for name in ('truth/imu', 'imu/data_raw', 'ins/odometry'):
        assert re.search(rf'^{name}: \d+ recorded, 0 lost, 0 holes in the bag$', said,
                         re.MULTILINE), said
    assert 'latency of the solution behind the truth, ms: 50 %' in said
    assert 'other processes: ' in said and ' warnings, 0 lost' in said
