"""Transforms: bytes as defined by tf2_msgs, and the fixed frames of a vehicle."""

from ins_sim.messages import placements, topics
from ins_sim.messages.transforms import (AT_PARENT, first_stamp, pose_between, read_rotations,
                                         read_transforms, TransformWriter)
from ins_sim.settings.catalogue import build
from ins_sim.settings.gnss import GnssSettings
from ins_sim.settings.velocity_meter import VelocityMeterSettings
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.bags.messages import STORE

POSE = (1.0, -2.0, 3.5, 0.5, -0.5, 0.5, 0.5)


@pytest.mark.parametrize('parent, child', [('map', 'base_link'), ('a', 'ab'), ('uav1/map', 'abc'),
                                           ('abcd', 'abcde'), ('odom', 'x')])
def test_bytes_are_those_of_the_definition(parent, child):
    """rosbags packs the same transform to the same bytes; our reader reads both."""
    data = TransformWriter((parent, child)).pack(1735689600123456789, POSE)
    message = STORE.deserialize_cdr(data, topics.TRANSFORMS)
    one, = message.transforms
    assert (one.header.frame_id, one.child_frame_id) == (parent, child)
    assert (one.header.stamp.sec, one.header.stamp.nanosec) == (1735689600, 123456789)
    moved, turned = one.transform.translation, one.transform.rotation
    assert (moved.x, moved.y, moved.z, turned.x, turned.y, turned.z, turned.w) == POSE
    assert bytes(STORE.serialize_cdr(message, topics.TRANSFORMS)) == data
    assert read_transforms(data) == [(parent, child, 1735689600123456789, POSE)]
    assert read_rotations(data) == [(parent, child, POSE[3:])]
    assert first_stamp(data) == 1735689600123456789
    assert first_stamp(data[:30]) is None and first_stamp(data[:4] + bytes(4)) is None


def test_several_transforms_of_one_instant():
    """Several transforms of one instant, with names of any length, equal the bytes of rosbags."""
    pairs = ('map', 'odom'), ('uav1/odom', 'uav1/base_link'), ('a', 'b')
    poses = [(float(k), *POSE[1:]) for k in range(3)]
    data = TransformWriter(*pairs).pack(10**9 + 5, *poses)
    message = STORE.deserialize_cdr(data, topics.TRANSFORMS)
    assert bytes(STORE.serialize_cdr(message, topics.TRANSFORMS)) == data
    assert read_transforms(data) == [(*pair, 10**9 + 5, pose) for pair, pose in zip(pairs, poses)]
    assert first_stamp(data) == 10**9 + 5


def test_a_pose_that_is_not_finite_is_not_sent():
    """A pose with NaN is refused instead of packed; the message has the stamp."""
    with pytest.raises(ValueError, match='a transform of 1.000000000 s would hold'):
        TransformWriter(('map', 'odom')).pack(10**9, (float('nan'), *POSE[1:]))


def test_map_to_odom_brings_the_free_pose_onto_the_aided_one():
    """T_map_odom T_odom_base = T_map_base, to rounding of coordinates of 1e5 m."""
    random = np.random.default_rng(3)
    for _ in range(20):
        aided, free = ((*random.normal(0.0, 1e5, 3), *Rotation.random(rng=random).as_quat())
                       for _ in range(2))
        odom = pose_between(aided, free)
        turn = Rotation.from_quat(odom[3:])
        assert np.allclose(turn.apply(free[:3]) + odom[:3], aided[:3], rtol=0.0, atol=1e-9)
        back = turn * Rotation.from_quat(free[3:]) * Rotation.from_quat(aided[3:]).inv()
        assert back.magnitude() < 1e-14
    assert pose_between(POSE, POSE) == pytest.approx(AT_PARENT, abs=1e-15)


def test_what_stands_fixed():
    """The GNSS antenna is at its lever arm; the meter is rotated left by its mounting error."""
    gnss = build(GnssSettings, {'lever_arm_m': [1.0, -2.0, 0.5]})
    assert placements.gnss_mounting(gnss) == ('base_link', 'gnss_link', (
        1.0, -2.0, 0.5, 0.0, 0.0, 0.0, 1.0))
    meter = build(VelocityMeterSettings, {'antennas.mounting_yaw_arcmin': 60.0})
    parent, child, pose = placements.meter_mounting(meter)
    assert (parent, child) == ('base_link', 'velocity_meter_link')
    # Forward of the antennas is 1 deg left of forward of the vehicle.
    forward = Rotation.from_quat(pose[3:]).apply([1.0, 0.0, 0.0])
    assert np.allclose(forward, [np.cos(np.pi / 180), np.sin(np.pi / 180), 0.0], atol=1e-15)
    assert placements.imu_mounting(None) == ('base_link', 'imu_link', AT_PARENT)
