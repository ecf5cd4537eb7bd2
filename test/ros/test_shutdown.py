"""A signal at any time ends every node with code 0 and without a traceback."""

import random
import signal
import subprocess
import sys
import time

from support.live import Chain, GUARD_S, wait_handlers
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

TRIES = 30
AT_ONCE = 10
SIGNALS = {'SIGINT': (signal.SIGINT,), 'SIGINT twice': (signal.SIGINT, signal.SIGINT),
           'SIGTERM': (signal.SIGTERM,)}
PARAMETERS = {'rate_hz': 200.0, 'duration_s': 0.0}
# This changes the handlers again whenever the process has started to ignore signals.
HANDLERS = """
from ins_sim.ros.process.runtime import Stop
Stop().install()
print('ready', flush=True)
for _ in range(5000):
    stop = Stop()
    stop.install()
    while not stop:
        pass
"""


@pytest.mark.parametrize('name', SIGNALS)
def test_signals(name, ros_domain, tmp_path):
    """
    30 of 30 signals, five to each node, end it cleanly while nodes exchange messages.

    Some signals arrive while the process still imports, some while it publishes.
    """
    rng = random.Random(name)
    nodes = ('motion_generator', 'imu_sensor', 'strapdown', 'velocity_meter', 'gnss',
             'aided_navigator')
    chain = Chain(ros_domain, tmp_path)
    for first in range(0, TRIES, AT_ONCE):
        started = [chain.start(nodes[k % 6], PARAMETERS) for k in range(first, first + AT_ONCE)]
        for process in started:
            wait_handlers(process)
        for process in started:
            time.sleep(rng.choice((0.0, 0.1, 0.4)))
            for k, number in enumerate(SIGNALS[name]):
                time.sleep(k * rng.choice((0.0, 0.01, 0.1)))
                process.send_signal(number)
        for process in started:
            assert process.wait(GUARD_S) == 0, chain.text(process)
            assert 'Traceback' not in chain.text(process)
    assert len(chain.processes) == TRIES


def test_signals_in_the_moment_of_a_change_of_handlers():
    """Of many signals some arrive within signal.signal itself, and nothing is printed."""
    with subprocess.Popen([sys.executable, '-c', HANDLERS], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as process:
        process.stdout.readline()
        sent = 0
        while process.poll() is None:
            process.send_signal(signal.SIGINT)
            sent += 1
        said = process.stderr.read()
    assert process.returncode == 0 and said == '', said[-500:]
    assert sent > 5000


def test_a_node_that_hangs_in_its_end_ends():
    """A node blocked in C with the interpreter locked, as by Fast DDS, exits with its code."""
    code = ('import ctypes\n'
            'from ins_sim.ros.process.last_resort import exit_within\n'
            'exit_within(1, 3)\n'
            'ctypes.PyDLL(None).sleep(60)\n')
    start = time.monotonic()
    assert subprocess.run([sys.executable, '-c', code], timeout=GUARD_S).returncode == 3
    # Not before one second, and not after the 60 s for which it is blocked.
    assert 1.0 <= time.monotonic() - start < 60.0
