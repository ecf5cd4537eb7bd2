"""Playing the bag of an offline run: the nodes read the epoch from it and give the same bits."""

from ins_sim.bags.bag_reader import open_bag
from ins_sim.cli.main import main
from ins_sim.messages import topics
import numpy as np
import pytest
from support.live import Listener

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

NOISE = {'rate_hz': 100.0, 'duration_s': 5.0, 'seed': 4, 'motion.kind': 'racetrack',
         'gyro.errors.angle_random_walk_deg_sqrt_h': [0.1, 0.1, 0.1],
         'accelerometer.errors.velocity_random_walk_m_s_sqrt_h': [0.1, 0.1, 0.1]}
SOURCES = (topics.TRUTH_ODOMETRY.name, topics.TRUTH_IMU.name)


def test_noise_is_that_of_the_recorded_run(chain, ros_domain, tmp_path):
    """
    Errors are drawn by motion time, so the readings have the bits of those in the bag.

    Only two topics are requested; the announcement is played before them nevertheless.
    """
    words = [w for name, value in {**NOISE, 'source': 'stream'}.items()
             for w in ('-p', f'{name}:={value}')]
    bag = tmp_path / 'bag'
    assert main(['simulate', '--no-twin', '-o', str(tmp_path / 'run'), '--bag', str(bag),
                 *words]) == 0
    listener = Listener(ros_domain, (topics.IMU_RAW,))
    try:
        nodes = [chain.start(node, NOISE) for node in ('imu_sensor', 'strapdown')]
        player = chain.start_verb('play', bag, '--lock-step', 'strapdown', 'listener', '--topics',
                                  *SOURCES)
        listener.poll_until(lambda: player.poll() is not None)
        listener.poll_until(lambda: len(listener.heard[topics.IMU_RAW.name]) == 501)
        assert set(chain.end().values()) == {0}, chain.text(player)
        heard = listener.heard[topics.IMU_RAW.name]
    finally:
        listener.close()
    assert all('no node announces' not in chain.text(node) for node in nodes)
    with open_bag(bag) as opened:
        table = opened.arrays(topics.IMU_RAW.name)
    assert table['stamp_ns'][0] == 1735689600 * 10**9
    assert sorted(heard) == table['stamp_ns'].tolist()
    assert np.array_equal([heard[t] for t in sorted(heard)], np.concatenate(
        [table['angular_velocity'], table['linear_acceleration']], axis=1))
