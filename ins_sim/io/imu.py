"""A recorded IMU with its reference, from a rosbag2 bag or from CSV files, without ROS."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ins_sim.bags.bag_reader import open_bag
from ins_sim.core.attitude.interpolation import continuous_quaternions
from ins_sim.core.postprocessing.initial_state import Sources
from ins_sim.core.postprocessing.reference import (keep_rising, OdometryReference, Reference,
                                                   SampledTrack)
from ins_sim.messages import topics, transforms
from . import bag_imu, csv_imu
from .csv_table import SUFFIXES
from .topic_choice import choose_topic

TWIST = 'geometry_msgs/msg/TwistStamped'
TWIST_WITH_COVARIANCE = 'geometry_msgs/msg/TwistWithCovarianceStamped'
TF = 'tf2_msgs/msg/TFMessage'


def read_imu(path, settings):
    """
    Return the Sources of NavigateSettings in a bag or a CSV file of an IMU.

    Raises ValueError or OSError in one sentence where the path, a topic or a message is not as
    expected.
    """
    path = Path(path)
    if not path.exists():
        raise FileNotFoundError(f'{path} does not exist; expected a rosbag2 bag or a CSV file')
    if path.name.endswith(SUFFIXES):
        sources = Sources(path.name, csv_imu.read_imu(path), 'imu')
    else:
        sources = _bag(path, settings)
    return with_reference(sources, settings)


def with_reference(sources, settings):
    """Return Sources with the reference of the file that NavigateSettings name, if any."""
    if settings.reference.path:
        sources = replace(sources, odometry=None,
                          reference=csv_imu.read_reference(settings.reference.path))
    return sources


def _bag(path, settings):
    wanted = settings.reference
    with open_bag(path) as bag:
        topic = choose_topic(bag, [topics.IMU], settings.topic, 'topic', needed=True)
        fix, odometry, velocity = (
            choose_topic(bag, types, getattr(wanted, key), f'reference.{key}')
            for key, types in (('fix', [topics.FIX]), ('odometry', [topics.ODOMETRY]),
                               ('velocity', [TWIST, TWIST_WITH_COVARIANCE])))
        imu, frame, notes = bag_imu.read_imu_messages(bag, topic)
        return Sources(f'{path.name} {topic}', imu, frame, _reference(bag, fix, velocity),
                       _odometry(bag, odometry), _static_transforms(bag), tuple(notes))


def _reference(bag, fix, velocity):
    position = None if fix is None else _fixes(bag, fix)
    speed = None if velocity is None else _velocities(bag, velocity)
    if position is None and speed is None:
        return None
    return Reference(', '.join(name for name, track in ((fix, position), (velocity, speed))
                               if track is not None), position, speed)


def _fixes(bag, topic):
    table = bag.arrays(topic, ('latitude', 'longitude', 'altitude', 'status'))
    table = table[table['status'] >= 0]
    position = _track(table['stamp_ns'], np.stack([
        np.radians(table['latitude']), np.radians(table['longitude']), table['altitude']], -1))
    if position is not None:
        position.values[:, 1] = np.unwrap(position.values[:, 1])
    return position


def _velocities(bag, topic):
    table = bag.arrays(topic, ('linear',))
    return _track(table['stamp_ns'], table['linear'])


def _track(t_ns, values):
    """Return the Track in the order of the stamps, or None."""
    t_ns, values = keep_rising(t_ns, values)
    return SampledTrack(t_ns, values) if len(t_ns) else None


def _odometry(bag, topic):
    if topic is None:
        return None
    table = bag.arrays(topic, ('position', 'orientation', 'linear'))
    norm = np.linalg.norm(table['orientation'], axis=1)
    table = table[(norm > 0.99) & (norm < 1.01)]
    track = _track(table['stamp_ns'], np.concatenate(
        [table['position'], table['orientation'], table['linear']], axis=1))
    if track is None:
        return None
    v, frame = track.values, bag.frames(topic)[-1][0]
    q = continuous_quaternions(v[:, 3:7] / np.linalg.norm(v[:, 3:7], axis=1, keepdims=True))
    return OdometryReference(topic, frame, track.t_ns, v[:, :3], q, v[:, 7:])


def _static_transforms(bag):
    """Return {(parent, child): q from child to parent} of every topic named tf_static."""
    static = {}
    for topic, channel in bag.topics.items():
        if channel.type_name == TF and topic.rpartition('/')[2] == 'tf_static':
            for parent, child, q in _rotations(bag, channel):
                static[parent.lstrip('/'), child.lstrip('/')] = q
    return static


def _rotations(bag, channel):
    """Yield the transforms of a topic of TFMessages in the order of the log times."""
    if channel.encoding != 'cdr':
        raise ValueError(f'{bag.path}: {channel.name} is serialized as {channel.encoding!r}; '
                         'expected cdr')
    for _, log_ns, data in bag.messages([channel.name]):
        try:
            yield from transforms.read_rotations(data)
        except ValueError as error:
            raise ValueError(f'{bag.path}: {channel.name} has a message at {log_ns} ns that is '
                             f'no {TF} ({error})') from None
