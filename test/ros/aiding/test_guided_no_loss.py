"""Six nodes in real time with the guidance loop closed over DDS lose nothing in ten minutes."""

import math

from ins_sim import graph
from ins_sim.messages import topics
import numpy as np
import pytest
from support.live import Chain, Listener, run_in_real_time, warnings_of_loss

pytest.importorskip('rclpy')
pytestmark = [pytest.mark.live, pytest.mark.figures]

RATE_HZ, SECONDS = 100, 600
FILES = ('default', 'guided_flight')
VALUES = {'motion_generator:duration_s': float(SECONDS)}
HEARD = (topics.TRUTH_IMU, topics.IMU_RAW, topics.INS_ODOMETRY, topics.AIDED_ODOMETRY)


def test_ten_minutes_lose_nothing_and_the_loop_stays_closed(ros_domain, tmp_path, figures):
    """
    Each topic is complete from its first message on, the sideslip decays, no warning of loss.

    The vehicle starts 100 m to the right of the leg, and the eskf with perfect instruments knows
    its position. Messages sent before DDS discovery are received by no node.
    """
    chain = Chain(ros_domain, tmp_path)
    listener = Listener(ros_domain, HEARD, later=topics.GUIDANCE)
    try:
        nodes, nodes[graph.MASTER], _ = run_in_real_time(chain, listener, HEARD[1:], VALUES, FILES)
        texts = [chain.text(node) for node in nodes.values()]
    finally:
        codes = chain.end()
        listener.close()
    assert set(codes.values()) == {0}
    warnings = warnings_of_loss(texts)
    lost = 0
    for topic in (*HEARD, *topics.GUIDANCE):
        stamps = np.array(sorted(listener.heard[topic.name]))
        assert stamps[0] < 5e9
        # The last control period is not flown.
        last = SECONDS * RATE_HZ - (topic in topics.GUIDANCE)
        missing = last - round(stamps[0] * 1e-9 * RATE_HZ) + 1 - len(stamps)
        print(f'{topic.name}: {len(stamps)} heard from {stamps[0] * 1e-9:.2f} s on, '
              f'{missing} lost, behind {stamps[:-1][np.diff(stamps) > 10**9 // RATE_HZ]} ns')
        lost += missing
    commands = listener.heard[topics.GUIDANCE_COMMAND.name]
    rows = np.array([commands[t] for t in sorted(commands)])[-SECONDS * RATE_HZ // 2:]
    command_deg, offset_m = np.degrees(np.abs(rows[:, 0]).max()), np.abs(rows[:, 1]).max()
    print(f'in the second half |command| <= {command_deg:.2e} deg, |z| <= {offset_m:.2e} m')
    figures.record('guided.live.lost', lost, 'messages', 0, 'asked')
    figures.record('guided.live.command', command_deg, 'deg')
    figures.record('guided.live.offset', offset_m, 'm')
    assert lost == 0, warnings
    assert command_deg < 0.05 and offset_m < 1.0 and math.isfinite(offset_m)
    assert not warnings, warnings
