"""Live transforms, node objects without DDS: frames, sources, and second publishers."""

from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
from ins_sim.messages.transforms import read_transforms, TransformWriter
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.hostile.flight import COMMON, FLIGHT, HostileFlight, NODES

pytest.importorskip('rclpy')

POSE = (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)


class Placed(HostileFlight):
    """A flight of all nodes with a source of TF; ``tf`` collects (topic, transforms of a node)."""

    def __init__(self, source, **more):
        shared = {'tf.source': source, 'frames.prefix': 'uav1'}
        settings = {node: {**values, **shared, **more.get(node, {})}
                    for node, values in NODES.items()}
        super().__init__(1, settings)
        self.tf, self.poses = [], {}

    def _heard(self, name, data):
        super()._heard(name, data)
        if name in ('/tf', '/tf_static'):
            self.tf += [(name, *one) for one in read_transforms(data)]
        elif name in ('ins/odometry', 'aided/odometry'):
            stamp_ns, *runs = topics.INS_ODOMETRY.reader(((0, 7),)).read(data)
            self.poses[name, stamp_ns] = runs[0]

    def moving(self, parent, child):
        """Return {stamp: pose} of a transform on /tf."""
        return {t: pose for name, *frames, t, pose in self.tf
                if name == '/tf' and frames == [f'uav1/{parent}', f'uav1/{child}']}

    def said(self, node):
        """Return the log messages of a node."""
        return '\n'.join(self.fed.logs[node].kept)

    def look(self):
        """Let every node examine the graph and /tf."""
        for node in self.fed.nodes.values():
            node.monitor.publish()


def pairs_of(flight):
    """Return {(parent, child)} on /tf."""
    return {(parent, child) for name, parent, child, *_ in flight.tf if name == '/tf'}


@pytest.mark.parametrize('source, moves', [
    ('none', set()), ('ins', {('uav1/odom', 'uav1/base_link')}),
    ('aided', {('uav1/odom', 'uav1/base_link'), ('uav1/map', 'uav1/odom')})])
def test_who_places_what(source, moves, ros_domain):
    """Static transforms are sent once at the first stamp, moving ones with every solution."""
    with Placed(source, gnss={'lever_arm_m': [1.0, 2.0, 3.0]}) as flight:
        flight.good(100)
        assert pairs_of(flight) == moves
        fixed = {(parent, child): (t, pose[:3]) for name, parent, child, t, pose in flight.tf
                 if name == '/tf_static'}
        links = {} if source == 'none' else {'imu_link': (0.0, 0.0, 0.0), 'velocity_meter_link':
                                             (0.0, 0.0, 0.0), 'gnss_link': (1.0, 2.0, 3.0)}
        expected = {('uav1/base_link', f'uav1/{link}'): (0, place)
                    for link, place in links.items()}
        if source == 'ins':
            expected['uav1/map', 'uav1/odom'] = 0, (0.0, 0.0, 0.0)
        assert fixed == expected
        if source != 'none':
            assert flight.moving('odom', 'base_link') == {
                t: pose for (name, t), pose in flight.poses.items() if name == 'ins/odometry'}
        flight.look()
        assert 'places' not in ''.join(map(flight.said, flight.fed.nodes))
        assert not flight.rescued


def test_the_truth_places_the_vehicle(ros_domain):
    """The generator publishes map -> base_link with every sample, after its Odometry."""
    generator = {**FLIGHT, 'tf.source': 'truth', 'frames.base_link': 'body'}
    with Placed('none', motion_generator=generator) as flight:
        node = flight.fed.nodes['motion_generator']
        odometry = []
        flight.fed.bus.listen = lambda name, data: (
            flight._heard(name, data),
            name == 'truth/odometry' and odometry.append(
                topics.TRUTH_ODOMETRY.reader(((0, 7),)).read(data)))
        for k in (0, 1, 300):
            node._send(k)
        assert list(flight.moving('map', 'body').items()) == odometry and len(odometry) == 3
        node._send(0)
        node.monitor.publish()
        assert 'places' not in flight.said('motion_generator')


def test_every_aided_solution_has_its_odom(ros_domain):
    """map -> odom -> base_link is the aided pose at every instant, including the last one."""
    with Placed('aided') as flight:
        flight.good(300)
        flight.fed.nodes['aided_navigator']._patience.wait()
        moved, free = flight.moving('map', 'odom'), flight.moving('odom', 'base_link')
        aided = {t: pose for (name, t), pose in flight.poses.items() if name == 'aided/odometry'}
        assert len(aided) == 300 and set(moved) == set(aided) <= set(free)
        for t, pose in aided.items():
            turn = Rotation.from_quat(moved[t][3:])
            assert np.allclose(turn.apply(free[t][:3]) + moved[t][:3], pose[:3], rtol=0.0,
                               atol=1e-11)


def test_without_a_strapdown_the_aided_navigator_goes_on(ros_domain):
    """
    Without ins/odometry the aided navigator logs one message after 5 s and continues.

    It acknowledges before the odom has arrived again.
    """
    with Placed('aided', velocity_meter={'attack_angle': 'none'}) as flight:
        flight.good(10)
        strapdown = flight.fed.nodes['strapdown']
        publish = flight.fed.bus.put
        flight.fed.bus.put = lambda name, data: None if name == 'ins/odometry' else publish(
            name, data)
        flight.good(700)
        said = flight.said('aided_navigator')
        assert 'no message on ins/odometry in 5 s; expected a free INS solution for every aided ' \
            'one, because tf.source is aided; map -> odom is not published without it' in said
        assert flight.fed.bus.newest_ns['aided/odometry'] == 709 * SECOND // 100
        flight.fed.bus.put = publish
        before = len(flight.moving('map', 'odom'))
        flight.good(5)
        assert len(flight.moving('map', 'odom')) >= before + 4 and not strapdown.stop


@pytest.mark.parametrize('source, node, parent, child', [
    ('ins', 'strapdown', 'uav1/map', 'uav1/base_link'),
    ('ins', 'strapdown', 'uav1/odom', 'uav1/base_link'),
    ('aided', 'aided_navigator', 'uav1/map', 'uav1/odom')])
def test_two_sources_of_a_frame_are_named(source, node, parent, child, ros_domain):
    """A second publisher of a frame, such as another tf.source, is named with both parents."""
    with Placed(source) as flight:
        flight.good(10)
        flight.fed.bus.put('/tf', TransformWriter((parent, child)).pack(0, POSE))
        flight.fed.bus.put('/tf', TransformWriter(('uav2/map', 'uav2/base_link')).pack(0, POSE))
        flight.look()
        mine = 'map' if child.endswith('odom') else 'odom'
        assert f"/tf: another node publishes '{child}' in '{parent}', and this node publishes " \
            f"it in 'uav1/{mine}'; expected one source for each frame: the same tf.source in " \
            'all nodes' in flight.said(node)
        others = [name for name in flight.fed.nodes if name != node]
        assert 'another node' not in ''.join(map(flight.said, others))


def test_bytes_that_are_no_transform_are_named(ros_domain):
    """Malformed bytes on /tf are reported with the topic."""
    with Placed('ins') as flight:
        flight.fed.bus.put('/tf', b'\x00\x01')
        flight.look()
        assert '/tf: it ends too early' in flight.said('strapdown') and not flight.rescued


def test_guided_by_the_free_ins(ros_domain):
    """
    Guidance by ins/odometry requires the frames odom and base_link of the vehicle.

    odom is constant in map, at the place where the INS started.
    """
    steered = {**COMMON, 'motion.kind': 'guided', 'duration_s': 0.0, 'time.epoch_s': 0,
               'guidance.topic': 'ins/odometry', 'frames.prefix': 'uav1'}
    with Placed('none') as flight:
        from ins_sim.ros.lock_step.steerer import Steerer
        from ins_sim.ros.lock_step.truth_source import TruthSource
        from ins_sim.settings.catalogue import build
        from ins_sim.settings.motion import MotionGeneratorSettings
        settings = build(MotionGeneratorSettings, steered)
        queue = []

        class Queue:
            def take(self):
                return queue.pop(0) if queue else None

        faults = []
        steerer = Steerer(settings, TruthSource(settings), Queue(), lambda data: None,
                          faults.append)
        odometry = topics.INS_ODOMETRY.named(settings.frames.names())
        queue.append(odometry.writer().pack(
            0, (0.0,) * 6 + (1.0,), (0.0,) * 36, (0.0,) * 6, (0.0,) * 36))
        steerer.reach(1, 1, waits=False)
        assert steerer.heard and not faults
        queue.append(topics.AIDED_ODOMETRY.writer().pack(
            10**7, (0.0,) * 6 + (1.0,), (0.0,) * 36, (0.0,) * 6, (0.0,) * 36))
        steerer.reach(1, 1, waits=False)
        assert "expected 'uav1/odom' and 'uav1/base_link'" in faults[0]
        assert not flight.rescued
