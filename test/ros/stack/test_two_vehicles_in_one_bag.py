"""One bag of two vehicles with two namespaces and prefixes, read by other programs."""

from ins_sim.bags.bag_reader import open_bag
from ins_sim.messages import topics
from ins_sim.messages.run_announcement import read_announcement
import numpy as np
import pytest
from support.bags import bag_tools
from support.live import GUARD_S
from support.nodes.recorder import end

pytest.importorskip('rclpy')
pytestmark = [pytest.mark.live, pytest.mark.slow]

LENGTH_S, STEP_NS = 10.0, 20_000_000
VEHICLES = {'left': 'uav1', 'right': 'uav2'}
RECORDED = (topics.RUN, *topics.DATA)
VALUES = {'motion.kind': 'racetrack', 'duration_s': LENGTH_S, 'rate_hz': 50.0,
          'gyro.errors.angle_random_walk_deg_sqrt_h': '[0.1, 0.1, 0.1]',
          'pacing.lock_step': True, 'time.epoch': 'now'}


def test_the_bag_of_two_vehicles(chain, tmp_path):
    """
    The bag has no holes, each message has the frames of its vehicle; other programs read it.

    As in docs/how_to/recipes/two_vehicles.md. Lock-step does not wait for the recorder, because it
    serves two generators: messages sent before it found a topic are missing.
    """
    path = tmp_path / 'bag'
    names = [f'/{vehicle}/{topic.name}' for vehicle in VEHICLES for topic in RECORDED]
    recorder = chain.start_verb('record', *names, '-o', path)
    chain.wait_text(recorder, 'waiting for')
    generators = [start(chain, *vehicle) for vehicle in VEHICLES.items()]
    for generator in generators:
        assert generator.wait(GUARD_S) == 0, chain.text(generator)
    said = end(chain, recorder)
    assert all(said[name][2].startswith('0 lost') for name in names), said
    with open_bag(path) as bag:
        counts = {name: span.count for name, span in bag.spans().items()}
        for vehicle, prefix in VEHICLES.items():
            (_, log_ns, data), = bag.messages([f'/{vehicle}/{topics.RUN.name}'])
            run = read_announcement(bytes(data))
            assert log_ns == run.first_stamp_ns
            for topic in topics.DATA:
                name = f'/{vehicle}/{topic.name}'
                frames = tuple(f'{prefix}/{frame}' for frame in topic.frames)
                assert bag.frames(name) == [frames]
                stamps = bag.arrays(name)['stamp_ns']
                assert set(np.diff(stamps)) == {STEP_NS} and stamps[-1] == run.epoch_ns + 10**10
    assert set(counts) == set(names)
    assert bag_tools.mcap_counts(path) == counts
    others_read(path, counts)


def start(chain, vehicle, prefix):
    """Start the nodes of a vehicle; return its generator."""
    return [chain.start(node, {**VALUES, 'frames.prefix': prefix}, ['-r', f'__ns:=/{vehicle}'])
            for node in ('strapdown', 'imu_sensor', 'motion_generator')][-1]


def others_read(bag, counts):
    """Run the installed programs on the bag; skip the test at the first missing one."""
    for name, findings in bag_tools.LINTERS.items():
        assert findings(bag) == [], name
    pairs = [(f'/{v}/truth/odometry', f'/{v}/ins/odometry') for v in VEHICLES]
    tracks = bag_tools.evo_trajectories(bag, [name for pair in pairs for name in pair])
    assert all(track.num_poses == counts[name] for name, track in tracks.items())
    for truth, ins in pairs:
        # 0.1 deg/sqrt(h) moves an INS by millimetres in ten seconds.
        assert bag_tools.evo_position_rms(tracks[truth], tracks[ins]) < 0.1
    assert bag_tools.served_by_foxglove(bag) == set(counts)
