"""Read a recorded IMU and its reference from a rosbag2 bag or CSV files, without ROS."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ins_sim.bags.bag_reader import open_bag
from ins_sim.core.attitude.interpolation import continuous_quaternions
from ins_sim.core.postprocessing.sources import NO_FIXES, Sources
from ins_sim.core.postprocessing.reference import (keep_rising, OdometryReference, Reference,
                                                   SampledTrack)
from ins_sim.messages import topics, transforms
from . import bag_imu, csv_imu, positions
from .csv_text import is_csv
from .topic_choice import choose_topic

TWIST = 'geometry_msgs/msg/TwistStamped'
TWIST_WITH_COVARIANCE = 'geometry_msgs/msg/TwistWithCovarianceStamped'
TF = 'tf2_msgs/msg/TFMessage'


def read_imu(path, settings):
    """
    Return the Sources that NavigateSettings select in a bag or a CSV file of an IMU.

    Raises ValueError or OSError if the path, a topic or a message cannot be used.
    """
    path = Path(path)
    if not path.exists():
        raise FileNotFoundError(f'{path} does not exist; expected a rosbag2 bag or a CSV file')
    if is_csv(path):
        imu, notes = csv_imu.read_imu(path, settings.columns, settings.units)
        sources = Sources(path.name, imu, 'imu', notes=tuple(notes))
    else:
        sources = _bag(path, settings)
    return with_reference(sources, settings)


def with_reference(sources, settings):
    """Return Sources with the reference file of NavigateSettings, if one is given."""
    wanted = settings.reference
    if wanted.path:
        reference, notes = csv_imu.read_reference(wanted.path, wanted.columns,
                                                  settings.accept.zero_fixes)
        sources = replace(sources, odometry=None, reference=reference,
                          notes=(*sources.notes, *notes))
    return sources


def _bag(path, settings):
    wanted = settings.reference
    with open_bag(path) as bag:
        topic = choose_topic(bag, [topics.IMU], settings.topic, 'topic', needed=True)
        fix, odometry, velocity = (
            choose_topic(bag, types, getattr(wanted, key), f'reference.{key}')
            for key, types in (('fix', [topics.FIX]), ('odometry', [topics.ODOMETRY]),
                               ('velocity', [TWIST, TWIST_WITH_COVARIANCE])))
        imu, frame, notes = bag_imu.read_imu_messages(bag, topic, settings)
        reference, without = _reference(bag, fix, velocity, settings.accept.zero_fixes, notes)
        return Sources(f'{path.name} {topic}', imu, frame, reference,
                       _odometry(bag, odometry, notes), _static_transforms(bag), tuple(notes),
                       without)


def _reference(bag, fix, velocity, keep_zero, notes):
    """Return the Reference or None, and the reason if it has no position."""
    position, without = (None, NO_FIXES) if fix is None else _fixes(bag, fix, keep_zero, notes)
    speed = None if velocity is None else _velocities(bag, velocity, notes)
    if position is None and speed is None:
        return None, without
    return Reference(', '.join(name for name, track in ((fix, position), (velocity, speed))
                               if track is not None), position, speed), without


def _fixes(bag, topic, keep_zero, notes):
    """Return the SampledTrack of the valid fixes, or None and the reason."""
    table = bag.arrays(topic, ('latitude', 'longitude', 'altitude', 'status'))
    if not len(table):
        return None, f'{topic} has no message'
    lat, lon, height = table['latitude'], table['longitude'], table['altitude']
    good, dropped = positions.usable(lat, lon, height, table['status'], keep_zero)
    without = ''
    if dropped:
        without = positions.sentence(topic, 'fixes', len(table), dropped)
        notes.append(without)
    return _track(table['stamp_ns'][good], positions.track(lat[good], lon[good],
                                                           height[good])), without


def _velocities(bag, topic, notes):
    table = bag.arrays(topic, ('linear',))
    return _track(table['stamp_ns'], positions.plausible(topic, table['linear'],
                                                         positions.MOST_M_S, 'm/s', notes))


def _track(t_ns, values):
    """Return the Track sorted by stamps, or None."""
    t_ns, values = keep_rising(t_ns, values)
    return SampledTrack(t_ns, values) if len(t_ns) else None


def _odometry(bag, topic, notes):
    if topic is None:
        return None
    table = bag.arrays(topic, ('position', 'orientation', 'linear'))
    with np.errstate(over='ignore', invalid='ignore'):
        norm = np.linalg.norm(table['orientation'], axis=1)
    good = (norm > 0.99) & (norm < 1.01)
    if not good.all():
        notes.append(f'{topic}: {np.count_nonzero(~good)} of {len(table)} poses dropped, because '
                     f'their orientation is not a rotation: the first has the norm '
                     f'{norm[np.argmin(good)]:.4g}')
    table = table[good]
    r, v_b = (positions.plausible(f'{topic} {field}', table[field], most, unit, notes)
              for field, most, unit in (('position', positions.MOST_M, 'm'),
                                        ('linear', positions.MOST_M_S, 'm/s')))
    track = _track(table['stamp_ns'], np.concatenate([r, table['orientation'], v_b], axis=1))
    if track is None:
        return None
    v, frame = track.values, bag.frames(topic)[-1][0]
    q = continuous_quaternions(v[:, 3:7] / np.linalg.norm(v[:, 3:7], axis=1, keepdims=True))
    return OdometryReference(topic, frame, track.t_ns, v[:, :3], q, v[:, 7:])


def _static_transforms(bag):
    """Return {(parent, child): q from child to parent} of all topics named tf_static."""
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
                             f'not a {TF} ({error})') from None
