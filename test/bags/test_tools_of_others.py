"""Bags of offline runs read by mcap, evo, foxglove-sdk and three linters of PyPI."""

from ins_sim.bags.bag_reader import open_bag
from ins_sim.io import simulated
import numpy as np
import pytest
from support.bags import bag_tools
from support.aided.runs import flown, settings

# The linters judge drift only after 5 s.
FLIGHT = ('duration_s:=12.0', 'window.cycles:=50', 'frames.prefix:=uav1', 'tf.source:=aided',
          'imu_data:=true')


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """Return the path of a bag of an aided flight, with transforms and a topic prefix."""
    chosen = settings(*FLIGHT)
    _, free, solution = flown(chosen)
    path = tmp_path_factory.mktemp('tools') / 'bag'
    simulated.write_bag(path, chosen.simulation, free,
                        simulated.select_topics(chosen.simulation, None, True),
                        aided=(chosen, solution))
    return path


def test_mcap_reads_all(bag):
    """mcap finds as many messages of each topic as our reader."""
    with open_bag(bag) as ours:
        expected = {name: span.count for name, span in ours.spans().items()}
    assert bag_tools.mcap_counts(bag) == expected and len(expected) > 20


def test_evo_reads_the_trajectories(bag):
    """The rms position error computed by evo equals that of our own arrays."""
    names = [f'/{name}/odometry' for name in ('truth', 'ins', 'aided')]
    truth, *others = bag_tools.evo_trajectories(bag, names).values()
    with open_bag(bag) as ours:
        at = {name: dict(zip((t := ours.arrays(name))['stamp_ns'].tolist(), t['position']))
              for name in names}
    for name, trajectory in zip(names[1:], others):
        assert trajectory.num_poses == len(at[name])
        errors = np.array([at[name][t] - at[names[0]][t] for t in at[name]])
        rms = np.sqrt((errors ** 2).sum(axis=1).mean())
        # evo matches stamps as float seconds and computes in doubles like us.
        assert bag_tools.evo_position_rms(truth, trajectory) == pytest.approx(rms, rel=1e-9)


def test_foxglove_serves_every_topic(bag):
    """A Foxglove client receives a message of each topic with unchanged bytes and log time."""
    with open_bag(bag) as ours:
        expected = {name for name, span in ours.spans().items() if span.count}
    assert bag_tools.served_by_foxglove(bag) == expected


@pytest.mark.parametrize('name', bag_tools.LINTERS)
def test_linters_find_nothing(name, bag):
    """None of three public linters of bags finds anything above the level of information."""
    assert bag_tools.LINTERS[name](bag) == []
