"""The demo: both parts over DDS, and the state it leaves after an interruption."""

import os
import signal
import subprocess
import sys
import time

from support.live import GUARD_S
import pytest
from support.places import ROOT

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live


def start(folder, duration_s, log):
    """Start the demo in a process group of its own."""
    return subprocess.Popen(
        [sys.executable, '-m', 'ins_sim', 'demo', '-o', str(folder), '--duration',
         str(duration_s)], env={**os.environ, 'PYTHONPATH': str(ROOT)}, stdout=log, stderr=log,
        start_new_session=True)


def members(group):
    """Return the remaining processes of a process group."""
    found = subprocess.run(['ps', '-eo', 'pgid=,pid='], capture_output=True, text=True,
                           check=True).stdout.split()
    return [pid for pgid, pid in zip(found[::2], found[1::2]) if int(pgid) == group]


def test_demo_and_what_interruptions_leave(ros_domain, tmp_path):
    """The demo completes; after SIGTERM or SIGINT: exit 130, old results kept, no process."""
    folder, log = tmp_path / 'demo', tmp_path / 'log'
    with open(log, 'w') as stream:
        assert start(folder, 10.0, stream).wait(GUARD_S) == 0, log.read_text()
    assert 'mean drift east' in log.read_text()
    files = {p: p.stat().st_mtime_ns for p in folder.rglob('*') if p.is_file()}
    for part in ('motion_2', 'cruise'):
        assert {'errors.png', 'report.html', 'parameters.yaml'} <= {
            p.name for p in folder.glob(f'{part}/*')}
        assert (folder / part / 'bag' / 'metadata.yaml') in files
    for number in (signal.SIGTERM, signal.SIGINT):
        with open(log, 'w') as stream:
            demo = start(folder, 3000.0, stream)
            end = time.monotonic() + GUARD_S
            while len(members(demo.pid)) < 4 and time.monotonic() < end:
                time.sleep(0.1)
            time.sleep(2.0)
            demo.send_signal(number)
            assert demo.wait(GUARD_S) == 130, log.read_text()
        assert 'interrupted' in log.read_text() and 'Traceback' not in log.read_text()
        assert members(demo.pid) == []
        assert {p: p.stat().st_mtime_ns for p in folder.rglob('*') if p.is_file()} == files


def test_a_killed_demo_leaves_no_node(ros_domain, tmp_path):
    """After SIGKILL, which cannot be caught, the nodes end together with the demo."""
    with open(tmp_path / 'log', 'w') as stream:
        demo = start(tmp_path / 'demo', 3000.0, stream)
    end = time.monotonic() + GUARD_S
    while len(members(demo.pid)) < 4 and time.monotonic() < end:
        time.sleep(0.1)
    assert len(members(demo.pid)) == 4
    demo.kill()
    demo.wait()
    while members(demo.pid) and time.monotonic() < end:
        time.sleep(0.1)
    assert members(demo.pid) == []
