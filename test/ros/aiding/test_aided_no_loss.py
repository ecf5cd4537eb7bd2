"""Six nodes in real time lose no message."""

from ins_sim.messages import topics
from support.live import Chain, Listener, run_in_real_time, warnings_of_loss
import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

RATE_HZ, SECONDS = 100, 15
# The meter in mode signal, GNSS with an outage in the middle; set for each node, because a node
# section of a file overrides parameters set for all nodes.
VALUES = {'motion_generator:duration_s': float(SECONDS), 'velocity_meter:mode': 'signal',
          'aided_navigator:gnss_model.use': True, 'gnss:outages.start_s': [SECONDS / 3.0],
          'gnss:outages.end_s': [SECONDS / 1.5]}
HEARD = {topics.TRUTH_IMU: RATE_HZ, topics.IMU_RAW: RATE_HZ, topics.INS_ODOMETRY: RATE_HZ,
         topics.AIDED_ODOMETRY: RATE_HZ, topics.AIDED_SIGMAS[2]: RATE_HZ, topics.GNSS_FIX: 1}


@pytest.mark.slow
def test_real_time_loses_nothing(ros_domain, tmp_path):
    """
    In real time each topic is complete from its first received message to the last instant.

    Messages sent before DDS discovery are received by no node. Ten minutes of the same, and the
    CPU time of each node, are printed by benchmarks/live_aided.py.
    """
    chain, listener = Chain(ros_domain, tmp_path), Listener(ros_domain, HEARD)
    awaited = topics.IMU_RAW, topics.INS_ODOMETRY, topics.AIDED_ODOMETRY, topics.GNSS_FIX
    try:
        nodes, _, took_s = run_in_real_time(chain, listener, awaited, VALUES,
                                            ('default', 'route_flight', 'grade_mid'))
        texts = [chain.text(node) for node in nodes.values()]
    finally:
        codes = chain.end()
        listener.close()
    assert set(codes.values()) == {0}
    assert took_s >= SECONDS
    for topic, rate_hz in HEARD.items():
        stamps = np.array(sorted(listener.heard[topic.name]))
        first_s = stamps[0] * 1e-9
        lost = round((SECONDS - first_s) * rate_hz) + 1 - len(stamps)
        print(f'{topic.name}: {len(stamps)} heard from {first_s:.2f} s on, {lost} lost')
        assert lost == 0 and stamps[-1] == SECONDS * 10**9
    warnings = warnings_of_loss(texts)
    assert not warnings, warnings
