"""Frames, transforms and the announced run in the bags of offline runs."""

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.qos import read_profiles
from ins_sim.cli.main import main
from ins_sim.io import simulated
from ins_sim.messages import topics
from ins_sim.messages.run_announcement import read_announcement, RunAnnouncement
from ins_sim.messages.transforms import read_transforms
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.aided.runs import flown, settings

EPOCH_NS = 1735689600 * 10**9
LENGTH_S = 20
FLIGHT = (f'duration_s:={LENGTH_S}.0', 'window.cycles:=200', 'lever_arm_m:=[1.0, 2.0, 3.0]',
          'antennas.mounting_yaw_arcmin:=30.0', 'frames.prefix:=uav1', 'frames.odom:=ins_odom')
FIXED = {'uav1/imu_link': (0.0, 0.0, 0.0), 'uav1/gnss_link': (1.0, 2.0, 3.0),
         'uav1/velocity_meter_link': (0.0, 0.0, 0.0)}


@pytest.fixture(scope='module')
def bags(tmp_path_factory):
    """Return a function that gives the path of the bag of a flight for a source of transforms."""
    made = {}

    def bag(source):
        if source not in made:
            chosen = settings(*FLIGHT, f'tf.source:={source}')
            _, free, solution = flown(chosen)
            made[source] = tmp_path_factory.mktemp(source) / 'bag'
            simulated.write_bag(made[source], chosen.simulation, free,
                                simulated.select_topics(chosen.simulation, None, True),
                                aided=(chosen, solution))
        return made[source]

    return bag


def transforms(path, name):
    """Return {(parent, child): {stamp: pose}} of a topic of a bag."""
    found = {}
    with open_bag(path) as bag:
        for _, log_ns, data in bag.messages([name]):
            for parent, child, stamp_ns, pose in read_transforms(bytes(data)):
                assert stamp_ns == log_ns
                found.setdefault((parent, child), {})[stamp_ns] = pose
    return found


def odometry(path, topic):
    """Return {stamp: pose} of an Odometry."""
    with open_bag(path) as bag:
        table = bag.arrays(topic.name)
    rows = np.concatenate([table['position'], table['orientation']], axis=1)
    return dict(zip(table['stamp_ns'].tolist(), map(tuple, rows.tolist())))


def test_frames_of_all_topics(bags):
    """Every topic has the frame prefix; truth and aided solution are in map, free INS in odom."""
    with open_bag(bags('truth')) as bag:
        frames = {topic.name: bag.frames(topic.name)[0] for topic in (*topics.DATA, *topics.AIDING)
                  if topic is not topics.METER_RECORD}
        record = bag.topics['/velocity_meter/record'].name
        data = bytes(next(iter(bag.messages([record])))[2])
    assert b'uav1/velocity_meter_link\0' in data
    assert all(name.startswith('uav1/') for names in frames.values() for name in names)
    assert frames['truth/odometry'] == frames['aided/odometry'] == ('uav1/map', 'uav1/base_link')
    assert frames['ins/odometry'] == ('uav1/ins_odom', 'uav1/base_link')
    assert frames['imu/data_raw'] == ('uav1/imu_link',)
    assert frames['gnss/fix'] == ('uav1/gnss_link',)
    # Errors have a frame that exists in TF.
    for topic in (*topics.ERRORS, *topics.AIDED_ERRORS, *topics.AIDED_SIGMAS):
        assert frames[topic.name] == ('uav1/map',)


def test_the_run_is_announced(bags):
    """sim/run is written once, with transient local durability, stamped with the first sample."""
    with open_bag(bags('truth')) as bag:
        (name, log_ns, data), = bag.messages([topics.RUN.name])
        durabilities = {n: read_profiles(channel.qos)[0]['durability']
                        for n, channel in bag.topics.items()}
    assert log_ns == EPOCH_NS
    assert read_announcement(bytes(data)) == RunAnnouncement(EPOCH_NS, 0, 100.0,
                                                             LENGTH_S * 10**9)
    latched = {n for n, text in durabilities.items() if text == 'transient_local'}
    assert latched == {'/sim/run', '/tf_static'}


@pytest.mark.parametrize('source', ['truth', 'ins', 'aided'])
def test_instruments_stand_fixed(source, bags):
    """/tf_static has lever arms and mounting, and map to odom if the free INS is the source."""
    fixed = transforms(bags(source), '/tf_static')
    with open_bag(bags(source)) as bag:
        assert len([*bag.messages(['/tf_static'])]) == 1
    where = {child: (parent, *poses.items()) for (parent, child), poses in fixed.items()}
    odom = where.pop('uav1/ins_odom', None)
    assert (odom is not None) == (source == 'ins')
    if odom:
        assert odom == ('uav1/map', (EPOCH_NS, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)))
    assert {child: found[1][1][:3] for child, found in where.items()} == FIXED
    assert all(len(found) == 2 and found[0] == 'uav1/base_link' and found[1][0] == EPOCH_NS
               for found in where.values())
    yaw = Rotation.from_quat(where['uav1/velocity_meter_link'][1][1][3:]).as_rotvec()
    assert np.allclose(yaw, [0.0, 0.0, np.radians(0.5)], rtol=1e-12, atol=0.0)


def test_truth_and_ins_place_the_vehicle(bags):
    """The transforms on /tf equal the poses of the Odometry messages of their source."""
    assert transforms(bags('truth'), '/tf') == {
        ('uav1/map', 'uav1/base_link'): odometry(bags('truth'), topics.TRUTH_ODOMETRY)}
    assert transforms(bags('ins'), '/tf') == {
        ('uav1/ins_odom', 'uav1/base_link'): odometry(bags('ins'), topics.INS_ODOMETRY)}


def test_the_chain_of_the_aided_solution(bags):
    """map -> odom -> base_link is the aided pose, to the rounding of coordinates of 4 km."""
    found = transforms(bags('aided'), '/tf')
    free, moved = found['uav1/ins_odom', 'uav1/base_link'], found['uav1/map', 'uav1/ins_odom']
    assert len(found) == 2 and free == odometry(bags('aided'), topics.INS_ODOMETRY)
    aided = odometry(bags('aided'), topics.AIDED_ODOMETRY)
    assert set(moved) == set(aided) == set(free) and len(aided) > 1900
    a, b, c = (np.array([poses[t] for t in sorted(aided)]) for poses in (moved, free, aided))
    turn = Rotation.from_quat(a[:, 3:])
    assert np.abs(turn.apply(b[:, :3]) + a[:, :3] - c[:, :3]).max() < 1e-11
    assert (turn * Rotation.from_quat(b[:, 3:]) * Rotation.from_quat(c[:, 3:]).inv()
            ).magnitude().max() < 1e-14


def test_without_a_source_there_is_no_tf(tmp_path, capsys):
    """Without a source there is no TF; an unknown source and the epoch 'now' are refused."""
    words = ['simulate', '--no-twin', '-p', 'duration_s:=1.0', '-p', 'motion.kind:=static', '-o']
    assert main([*words, str(tmp_path / 'a'), '--bag', str(tmp_path / 'bag'), '-p',
                 'time.epoch:=now']) == 0
    with open_bag(tmp_path / 'bag') as bag:
        assert not {'/tf', '/tf_static'} & set(bag.topics) and '/sim/run' in bag.topics
        assert bag.frames('ins/odometry') == [('odom', 'base_link')]
        (_, log_ns, data), = bag.messages([topics.RUN.name])
        assert log_ns > EPOCH_NS + 10**15
    capsys.readouterr()
    assert main([*words, str(tmp_path / 'b'), '--bag', str(tmp_path / 'bag_b'), '-p',
                 'tf.source:=aided']) == 2
    said = capsys.readouterr().err
    assert said.count('\n') == 1 and not (tmp_path / 'b').exists()
    assert 'tf.source is aided without velocity_meter, gnss and aided_navigator; expected' in said
