"""The examples of docs/how_to/test_your_filter.md run unchanged."""

import importlib.util
import os
import re
import subprocess
import sys

import pytest
from support.places import ROOT

PAGE = (ROOT / 'docs' / 'how_to' / 'test_your_filter.md').read_text()
BLOCKS = re.findall(r'```python\n(.*?)```', PAGE, re.DOTALL)
COMPLEMENTARY, NODE, LAUNCHED = BLOCKS


def run_pytest(folder, code):
    """Run a test file in a process and return its output."""
    (folder / 'test_example.py').write_text(code)
    words = [sys.executable, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', folder]
    found = subprocess.run(words, env={**os.environ, 'PYTHONPATH': str(ROOT)}, text=True,
                           capture_output=True, check=False)
    assert found.returncode == 0, found.stdout + found.stderr
    return found.stdout


def test_the_complementary_filter(tmp_path):
    """The complementary filter has some 40 lines and passes its test on 30 s of readings."""
    pytest.importorskip('rclpy')
    lines = [line for line in COMPLEMENTARY.splitlines() if line.strip()]
    assert len(lines) <= 40
    assert '1 passed' in run_pytest(tmp_path, COMPLEMENTARY)


def test_a_worse_filter_fails(tmp_path):
    """A filter with gyros alone fails the test of the page: it drifts by 0.8 deg in 30 s."""
    pytest.importorskip('rclpy')
    code = COMPLEMENTARY.replace('time_constant_s=5.0', 'time_constant_s=1e9')
    with pytest.raises(AssertionError, match='1 failed'):
        run_pytest(tmp_path, code)


def test_the_others_can_be_read():
    """The other examples, which need further packages, compile."""
    for code in (NODE, LAUNCHED):
        compile(code, 'testing.md', 'exec')


@pytest.mark.live
@pytest.mark.skipif(not importlib.util.find_spec('launch_testing'), reason='no launch_testing')
def test_launch_testing(tmp_path, ros_domain):
    """The example for launch_testing passes under its runner, where it is installed."""
    path = tmp_path / 'test_launched.py'
    path.write_text(LAUNCHED)
    subprocess.run([sys.executable, '-m', 'launch_testing.launch_test', path], check=True)
