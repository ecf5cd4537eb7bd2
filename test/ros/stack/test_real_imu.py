"""The node strapdown with a real IMU: no truth, its topics, messages and services."""

from dataclasses import replace
import math

import numpy as np
import pytest
from support.nodes.live_imu import as_sent, play, stage_of, vehicle
from support.nodes.real_imu import messages_of, RealImuGraph

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.frames import MapFrame
from ins_sim.messages import topics
from ins_sim.messages.convert import fix_one, odometry_one
from ins_sim.settings.place import Datum

pytest.importorskip('rclpy')

DATUM = {'datum.latitude_deg': 49.8, 'datum.longitude_deg': 5.7, 'datum.height_m': 90.0}
ODOMETRY = topics.INS_ODOMETRY.reader(((0, 7), (43, 49), (7, 43)))


def test_the_messages_are_those_of_the_stage():
    """Every solution gives Odometry and fix, without errors; samples are acknowledged."""
    imu, fixes = vehicle(length_s=40.0)
    said = play(stage_of(), imu, as_sent(fixes))
    frame = MapFrame(Datum(49.8, 5.7, 90.0), True)
    with RealImuGraph(imu_data=True, **DATUM) as graph:
        graph.send(messages_of(imu, fixes))
        assert not graph.bus.wrong and graph.node.monitor.faults == 0, graph.said
        odometry, fix = graph.heard[topics.INS_ODOMETRY.name], graph.heard[topics.INS_FIX.name]
        assert set(graph.heard) == {topics.INS_ODOMETRY.name, topics.INS_FIX.name,
                                    topics.IMU_DATA.name, topics.ACK.name}
        assert max(graph.heard[topics.ACK.name]) == imu.t_ns[-1]
        assert np.array_equal(said.t_ns, [*odometry]) and [*odometry] == [*fix]
        for solved in said.solved:
            pose, twist = odometry_one(frame, solved.state, solved.rate)
            found = ODOMETRY.read(odometry[solved.t_ns])
            assert found[1] == pose and found[2] == twist
            assert topics.INS_FIX.reader(((0, 3),)).read(fix[solved.t_ns])[1] == fix_one(
                solved.state)


def test_a_stage_fed_by_the_node_has_the_bits_of_navigate():
    """The stage in the node gives the bits of navigate."""
    imu, fixes = vehicle(length_s=40.0)
    other = play(stage_of(), imu, as_sent(fixes))
    with RealImuGraph() as graph:
        kept = []
        graph.node.publish_one = lambda *output: kept.append(output)
        graph.send(messages_of(imu, fixes))
        assert [(stamp, state) for stamp, _, state, _, _ in kept] == [
            (s.t_ns, s.state) for s in other.solved]


def test_levelled_alone_without_fixes():
    """
    Without fixes the IMU is only levelled: heading 0 along x of odom with sigma pi.

    There is no fix and no map -> odom; one warning states what would help.
    """
    imu, _ = vehicle(rest_s=70.0, length_s=70.0, rate_hz=25.0)
    with RealImuGraph(**{'tf.source': 'ins'}) as graph:
        graph.send(messages_of(imu))
        assert topics.INS_FIX.name not in graph.heard
        assert topics.TF_STATIC.name not in graph.heard and graph.heard[topics.TF.name]
        _, pose, _, covariance = ODOMETRY.read(next(iter(graph.heard[
            topics.INS_ODOMETRY.name].values())))
        assert max(map(abs, pose[:3])) < 1e-6 and abs(pose[6]) > 0.9999
        assert abs(math.sqrt(covariance[35]) - math.pi) < 1e-3
        assert graph.said.count('levelled only, the heading is unknown') == 1
        assert 'What would help: initial.position given' in graph.said


def test_map_to_odom_where_the_heading_is_known():
    """With position and heading, map -> odom is constant from the start on."""
    imu, fixes = vehicle(length_s=40.0)
    with RealImuGraph(**{'tf.source': 'ins'}) as graph:
        graph.send(messages_of(imu, fixes))
        assert len(graph.heard[topics.TF_STATIC.name]) == 1
        assert 'the origin of map is the start' in graph.said
        pose = ODOMETRY.read(next(iter(graph.heard[topics.INS_ODOMETRY.name].values())))[1]
        assert max(map(abs, pose[:3])) < 1e-6


def test_a_mounting_from_tf_is_waited_for():
    """Readings wait for /tf_static; imu/data has the orientation of the frame of the IMU."""
    imu, fixes = vehicle(length_s=40.0)
    turn = quaternion.exponential((math.pi, 0.0, 0.0))
    messages = messages_of(imu.turned(quaternion.conjugate(turn)), fixes, 'imu_upside_down')
    with RealImuGraph(imu_data=True) as graph:
        graph.send(messages[:10])
        graph.transforms('base_link', 'mast', turn)
        graph.transforms('mast', 'imu_upside_down', quaternion.IDENTITY)
        graph.send(messages[10:])
        assert '/tf_static from base_link to imu_upside_down' in graph.said
        assert 'a vehicle rarely stands like this' not in graph.said
        same_bits_within(graph, play(stage_of(), imu, fixes))
        stamp_ns, data = next(iter(graph.heard[topics.IMU_DATA.name].items()))
        pose = ODOMETRY.read(graph.heard[topics.INS_ODOMETRY.name][stamp_ns])[1]
        q = topics.IMU_DATA.reader(((0, 4),)).read(data)[1]
        off = quaternion.multiply(quaternion.conjugate(q), quaternion.multiply(pose[3:], turn))
        assert abs(abs(off[3]) - 1.0) < 1e-12


def same_bits_within(graph, said):
    """Assert that the fixes of the node are the solutions, to the rounding of two rotations."""
    read = topics.INS_FIX.reader(((0, 3),)).read
    for solved in said.solved[::50]:
        lat, lon, height = read(graph.heard[topics.INS_FIX.name][solved.t_ns])[1]
        assert abs(math.radians(lat) - solved.state[0]) * 6.4e6 < 1e-6
        assert abs(height - solved.state[2]) < 1e-6


@pytest.mark.parametrize('source, sentence', [
    ('auto', 'is assumed to be base_link: set mounting.rpy_deg'),
    ('tf', 'expected a transform from base_link to')])
def test_a_frame_without_a_transform(source, sentence):
    """If TF has no transform one message is logged after 2 s, and the node keeps waiting."""
    imu, fixes = vehicle(length_s=12.0)
    with RealImuGraph(**{'mounting.source': source}) as graph:
        graph.send(messages_of(imu, fixes, 'imu_frame'))
        assert graph.said.count(sentence) == 1
        assert (graph.node.stage.q_bs is None) == (source == 'tf')


def test_a_frame_that_tf_does_not_know():
    """For a frame that TF does not have the nearest one is named, and nothing is aligned."""
    imu, _ = vehicle(length_s=12.0)
    with RealImuGraph() as graph:
        graph.transforms('base_link', 'imu_link', quaternion.IDENTITY)
        graph.send(messages_of(imu, frame='imu_lnk'))
        assert "no frame 'imu_lnk'; the nearest is 'imu_link'" in graph.said
        assert graph.node.stage.state == 'waiting for /tf_static'


def test_services_answer_in_a_sentence():
    """
    ~/align and ~/reset answer in one sentence before, during and after an alignment.

    They do so with initial.source truth too.
    """
    imu, fixes = vehicle(rest_s=25.0, length_s=60.0)
    messages = messages_of(imu, fixes)
    with RealImuGraph(**{'alignment.longest_s': 8.0, 'initial.heading': 'given',
                         'initial.heading_deg': 70.0}) as graph:
        assert graph.call('align') == (False, 'no readings on imu/data_raw to align with')
        graph.send(messages[:200])
        done, text = graph.call('align')
        assert not done and 'an alignment is already running: at rest for' in text
        graph.send(messages[200:600])
        first = len(graph.heard[topics.INS_ODOMETRY.name])
        done, text = graph.call('align')
        assert done and 'the solution continues' in text
        graph.send(messages[600:1200])
        assert graph.node.stage.begun == 2
        stamps = [*graph.heard[topics.INS_ODOMETRY.name]]
        assert stamps == sorted(set(stamps)) and len(stamps) > first + 500
        done, _ = graph.call('align')
        assert done
        graph.send(messages[1200:1600])
        assert graph.node.stage.begun == 2
        assert 'the alignment requested by ~/align was cancelled' in graph.said
        assert graph.call('reset') == (
            True, 'started anew from initial.source alignment; expected a vehicle at rest')
        assert graph.node.stage.run is None
    with RealImuGraph(**{'initial.source': 'truth', 'input': 'rotation_vector'}) as graph:
        assert not graph.call('align')[0] and 'initial.source is truth' in graph.call('align')[1]
        assert graph.call('reset') == (True, 'started anew')


def test_damaged_messages_on_every_input():
    """
    Damaged messages on every input give faults; no node ends, and no NaN is published.

    They are truncated or have random bytes.
    """
    imu, fixes = vehicle(length_s=30.0, rate_hz=25.0)
    rng, messages = np.random.default_rng(5), []
    good = messages_of(imu, fixes)
    others = [(topic.name, topic.writer().pack(int(imu.t_ns[0]), run)) for topic, run in (
        (topics.IMU_MAG, (2e-5, 0.0, -4e-5)), (topics.IMU_PRESSURE, (1e5,)))]
    for name, data in good:
        messages.append((name, data))
        if rng.random() < 0.3:
            name, data = (*others, (name, data))[rng.integers(3)]
            spoiled = np.frombuffer(data, dtype=np.uint8).copy()
            spoiled[rng.integers(4, len(spoiled), 1 + rng.integers(12))] = rng.integers(
                0, 256, dtype=np.uint8)
            messages.append((name, spoiled.tobytes()[:None if rng.random() < 0.7 else
                                                     rng.integers(len(spoiled))]))
    with RealImuGraph(**{'alignment.longest_s': 8.0, 'vertical.channel': 'damped'}) as graph:
        graph.send(messages)
        assert not graph.bus.wrong
        for word in ('Error', 'Traceback', 'line '):
            assert word not in graph.said, graph.said
        assert graph.node.stage.newest_ns is not None and graph.call('reset')[0]


def test_the_shipped_parameters():
    """config/real_imu.yaml aligns a car by the course of its fixes, damped, with imu/data."""
    import yaml
    from ins_sim import resources
    text = yaml.safe_load(resources.config('real_imu').read_text())
    values = {f'{key}.{name}' if isinstance(value, dict) else key: entry
              for key, value in text['/**/strapdown']['ros__parameters'].items()
              for name, entry in (value.items() if isinstance(value, dict) else [('', value)])}
    imu, fixes = vehicle(length_s=40.0)
    with RealImuGraph(**values) as graph:
        graph.send(messages_of(imu, fixes))
        assert graph.node.monitor.faults == 0, graph.said
        fixes = graph.heard[topics.INS_FIX.name]
        assert len(graph.heard[topics.IMU_DATA.name]) == len(fixes) > 900


def test_a_damped_channel_follows_fix_and_pressure():
    """
    A damped channel follows a rise of 10 m in fixes or pressure to within 0.2 m.

    After 40 s, eight time constants of 5 s, the triple pole leaves (1 + 8 + 32) exp(-8) of 10 m,
    0.14 m.
    """
    from ins_sim.core.earth.atmosphere import pressure
    imu, fixes = vehicle(rest_s=60.0, length_s=60.0, rate_hz=25.0)
    t_s = 1e-9 * (imu.t_ns - imu.t_ns[0])
    rise = np.where(t_s > 20.0, 10.0, 0.0)
    pack = topics.IMU_PRESSURE.writer().pack
    raised = [replace_height(f, imu.t_ns, rise) for f in fixes]
    common = {'alignment.longest_s': 8.0, 'vertical.channel': 'damped', 'initial.heading': 'given',
              'initial.heading_deg': 70.0, 'vertical.time_constant_s': 5.0}
    for source in ('fix', 'pressure'):
        with RealImuGraph(**common, **{'vertical.reference': source}) as graph:
            messages = messages_of(imu, raised if source == 'fix' else fixes)
            if source == 'pressure':
                messages = [m for k, one in enumerate(messages) for m in (
                    (topics.IMU_PRESSURE.name, pack(int(imu.t_ns[min(k, len(imu) - 1)]), (
                        pressure(250.0 + rise[min(k, len(imu) - 1)]),))), one)]
            graph.send(messages)
            heights = [topics.INS_FIX.reader(((0, 3),)).read(data)[1][2]
                       for data in graph.heard[topics.INS_FIX.name].values()]
            assert abs(heights[0] - 100.0) < 0.1 and abs(heights[-1] - 110.0) < 0.2


def replace_height(fix, t_ns, rise):
    """Return a fix with a height increased by the rise at its stamp."""
    return fix._replace(height=fix.height + float(np.interp(fix.t_ns, t_ns, rise)))


def test_truth_as_the_vertical_channel_is_replaced_and_said():
    """Without truth the vertical channel is damped, with one message."""
    imu, fixes = vehicle(length_s=30.0)
    with RealImuGraph(**{'vertical.channel': 'truth'}) as graph:
        graph.send(messages_of(imu, fixes))
        assert graph.said.count('the channel is damped towards vertical.reference, fix') == 1
        assert graph.heard[topics.INS_FIX.name]


def test_an_accelerometer_in_g_is_named_and_its_unit_can_be_set():
    """An accelerometer in g is named and not aligned; units.force g converts it."""
    imu, fixes = vehicle(length_s=40.0)
    in_g = messages_of(replace(imu, f=imu.f / 9.80665), fixes)
    with RealImuGraph() as graph:
        graph.send(in_g)
        assert graph.said.count('is it in g?') == 1 and not graph.heard[topics.INS_FIX.name]
    with RealImuGraph(**{'units.force': 'g'}) as graph:
        graph.send(in_g)
        assert graph.heard[topics.INS_FIX.name]
