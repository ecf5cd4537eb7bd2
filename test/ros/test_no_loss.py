"""The live chain of three nodes loses no sample, in real time at 1 kHz and in lock-step."""

from ins_sim.messages import topics
from support.live import Chain, GUARD_S, Listener
import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live


@pytest.mark.parametrize('rate_hz, duration_s, factor', [(1000, 5, 1.0), (100, 200, 0.0)],
                         ids=['real time at 1 kHz', 'lock-step'])
def test_no_solution_is_lost(rate_hz, duration_s, factor, ros_domain, tmp_path):
    """
    From the first received solution on, the listener receives every one to the last instant.

    Messages sent before DDS discovery are received by no node. Speed and latency of the same runs
    are printed by benchmarks/live_chain.py.
    """
    chain, listener = Chain(ros_domain, tmp_path), Listener(ros_domain, (topics.INS_ODOMETRY,))
    parameters = {'rate_hz': float(rate_hz), 'duration_s': float(duration_s),
                  'pacing.real_time_factor': factor}
    heard, end_ns = listener.heard['ins/odometry'], duration_s * 10**9
    try:
        for node in ('strapdown', 'imu_sensor'):
            chain.wait_text(chain.start(node, parameters), 'waiting for')
        generator = chain.start('motion_generator', parameters)
        listener.poll_until(lambda: generator.poll() is not None, GUARD_S + duration_s)
        listener.poll_until(lambda: end_ns in heard)
    finally:
        codes = chain.end()
        listener.close()
    assert set(codes.values()) == {0}
    stamps = np.array(sorted(heard))
    print(f'\n{len(stamps)} solutions from {stamps[0] * 1e-9:.3f} s on')
    assert (np.diff(stamps) == round(1e9 / rate_hz)).all() and stamps[-1] == end_ns
