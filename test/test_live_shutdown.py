"""A signal ends every node with code 0 and without a traceback, whenever it comes."""

import random
import signal
import time

from live import Chain, wait_ready_to_end
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

TRIES = 30
AT_ONCE = 10
SIGNALS = {'SIGINT': (signal.SIGINT,), 'SIGINT twice': (signal.SIGINT, signal.SIGINT),
           'SIGTERM': (signal.SIGTERM,)}
PARAMETERS = {'rate_hz': 200.0, 'duration_s': 0.0}


@pytest.mark.parametrize('name', SIGNALS)
def test_signals(name, ros_domain, tmp_path):
    """
    30 of 30 tries, five of each node, which talk to each other.

    Some signals come while the process still imports, some while it publishes.
    """
    rng = random.Random(name)
    nodes = ('motion_generator', 'imu_sensor', 'strapdown', 'velocity_meter', 'gnss',
             'aided_navigator')
    chain = Chain(ros_domain, tmp_path)
    for first in range(0, TRIES, AT_ONCE):
        started = [chain.start(nodes[k % 6], PARAMETERS) for k in range(first, first + AT_ONCE)]
        for process in started:
            wait_ready_to_end(process)
        for process in started:
            time.sleep(rng.choice((0.0, 0.1, 0.4)))
            for k, number in enumerate(SIGNALS[name]):
                time.sleep(k * rng.choice((0.0, 0.01, 0.1)))
                process.send_signal(number)
        for process in started:
            assert process.wait(30.0) == 0, chain.text(process)
            assert 'Traceback' not in chain.text(process)
    assert len(chain.processes) == TRIES
