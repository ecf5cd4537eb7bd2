"""
A recorded IMU with its reference, from a rosbag2 bag or from CSV files, without ROS.

Everything that is read from a bag is read here, by two functions: ``_topics`` and ``_messages``.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..core import csv_columns
from ..core.catalogue import nearest
from ..core.initial_state import Sources
from ..core.recorded_imu import RecordedImu
from ..core.recording import continuous
from ..core.reference import Odometry, Reference, rising, Track

IMU = ('sensor_msgs/msg/Imu',)
FIX = ('sensor_msgs/msg/NavSatFix',)
ODOMETRY = ('nav_msgs/msg/Odometry',)
VELOCITY = ('geometry_msgs/msg/TwistStamped', 'geometry_msgs/msg/TwistWithCovarianceStamped')
TF = ('tf2_msgs/msg/TFMessage',)
CSV = ('.csv', '.csv.gz')


def read(path, settings):
    """
    Return the Sources of NavigateSettings in a bag (a folder) or a CSV file of an IMU.

    Raises ValueError or OSError in one sentence where the path, a topic or a message is not as
    expected.
    """
    path = Path(path)
    if not path.exists():
        raise FileNotFoundError(f'{path} does not exist; expected a rosbag2 bag or a CSV file')
    if path.name.endswith(CSV):
        sources = Sources(path.name, csv_columns.read_imu(path), 'imu')
    else:
        sources = _bag(path, settings)
    if settings.reference.path:
        sources = replace(sources, odometry=None,
                          reference=csv_columns.read_reference(settings.reference.path))
    return sources


def _bag(path, settings):
    from rosbags.highlevel import AnyReader, AnyReaderError
    from rosbags.typesys import get_typestore, Stores
    wanted = settings.reference
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as bag:
            topics = _topics(bag)
            topic = _choose(path, topics, IMU, settings.topic, 'topic')
            if topic is None:
                raise ValueError(f'{path} has no sensor_msgs/Imu; it has '
                                 f'{", ".join(sorted(topics)) or "no topic"}')
            fix, odometry, velocity = (
                _choose(path, topics, types, getattr(wanted, key), f'reference.{key}')
                for key, types in (('fix', FIX), ('odometry', ODOMETRY), ('velocity', VELOCITY)))
            imu, frame, notes = _imu(bag, topic, f'{path}: {topic}')
            return Sources(
                f'{path.name} {topic}', imu, frame,
                _reference(bag, fix, velocity), _odometry(bag, odometry),
                _static_transforms(bag, topics), tuple(notes))
    except (AnyReaderError, FileNotFoundError) as error:
        raise ValueError(f'{path} is no readable bag: {error}') from None


def _topics(bag):
    """Return {topic: message type} of an open bag."""
    return {c.topic: c.msgtype for c in bag.connections}


def _messages(bag, topic):
    """Yield the log time, ns, and the message of each message on a topic."""
    connections = [c for c in bag.connections if c.topic == topic]
    for connection, log_ns, data in bag.messages(connections=connections):
        yield log_ns, bag.deserialize(data, connection.msgtype)


def _choose(path, topics, types, wanted, key):
    """Return the name of the topic of one of the types that is wanted, or None."""
    if wanted == 'none':
        return None
    known = sorted(name for name, type_name in topics.items() if type_name in types)
    if wanted == 'auto':
        if len(known) > 1:
            raise ValueError(f'{path} has {len(known)} topics of {_short(types)}: '
                             f'{", ".join(known)}; expected {key} to name one'
                             + ('' if key == 'topic' else ', or none'))
        return known[0] if known else None
    name = wanted if wanted in topics else '/' + wanted.lstrip('/')
    if name not in topics:
        what = f'; the nearest is {nearest(name, known)!r}' if known else ''
        raise ValueError(f'{path} has no topic {wanted!r}, which is {key}{what}')
    if topics[name] not in types:
        raise ValueError(f'{path}: {name}, which is {key}, has type '
                         f'{topics[name].replace("/msg/", "/")}; expected {_short(types)}')
    return name


def _short(types):
    return ' or '.join(t.replace('/msg/', '/') for t in types)


def _stamp(message):
    stamp = message.header.stamp
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def _vector(v):
    return v.x, v.y, v.z


def _imu(bag, topic, name):
    """Return RecordedImu, frame and notes of a topic."""
    frames, rows, stamps, logs = [], [], [], []
    for log_ns, m in _messages(bag, topic):
        q = m.orientation
        if m.angular_velocity_covariance[0] == -1.0 or m.linear_acceleration_covariance[0] == -1.0:
            raise ValueError(f'{name} says by a covariance of -1 that it has no rate or no '
                             'acceleration (REP-145); expected both')
        unknown = m.orientation_covariance[0] == -1.0
        rows.append((*_vector(m.angular_velocity), *_vector(m.linear_acceleration),
                     *((np.nan,) * 4 if unknown else (q.x, q.y, q.z, q.w))))
        stamps.append(_stamp(m))
        logs.append(log_ns)
        if m.header.frame_id not in frames:
            frames.append(m.header.frame_id)
    if not rows:
        raise ValueError(f'{name} is empty; expected messages')
    if len(frames) > 1:
        raise ValueError(f'{name} has the frames {", ".join(map(repr, frames[:4]))}; expected one '
                         'IMU on a topic')
    values, notes = np.array(rows, dtype=float), []
    norm = np.linalg.norm(values[:, 6:], axis=1)
    q_ns = np.where((np.abs(norm - 1.0) < 0.01)[:, None], values[:, 6:], np.nan) / norm[:, None] \
        if norm.any() else np.full((len(rows), 4), np.nan)
    t_ns = np.array(stamps, dtype=np.int64)
    if not t_ns.any():
        t_ns = np.array(logs, dtype=np.int64)
        notes.append('the stamps of the IMU are all zero: the times of logging are used')
    return RecordedImu(t_ns, values[:, :3], values[:, 3:6], q_ns), frames[0].lstrip('/'), notes


def _reference(bag, fix, velocity):
    position = speed = None
    if fix is not None:
        rows = [(_stamp(m), (np.radians(m.latitude), np.radians(m.longitude), m.altitude))
                for _, m in _messages(bag, fix) if m.status.status >= 0]
        position = _track(rows)
        if position is not None:
            position.values[:, 1] = np.unwrap(position.values[:, 1])
    if velocity is not None:
        speed = _track([(_stamp(m), _vector(getattr(m.twist, 'twist', m.twist).linear))
                        for _, m in _messages(bag, velocity)])
    if position is None and speed is None:
        return None
    return Reference(', '.join(name for name, track in ((fix, position), (velocity, speed))
                               if track is not None), position, speed)


def _track(rows):
    """Return the Track of (stamp, values) in the order of the stamps, or None."""
    if not rows:
        return None
    t_ns, values = zip(*rows)
    t_ns, values = rising(np.array(t_ns, dtype=np.int64), np.array(values, dtype=float))
    return Track(t_ns, values) if len(t_ns) else None


def _odometry(bag, topic):
    if topic is None:
        return None
    frame, rows = '', []
    for _, m in _messages(bag, topic):
        q, frame = m.pose.pose.orientation, m.header.frame_id
        rows.append((_stamp(m), (*_vector(m.pose.pose.position), q.x, q.y, q.z, q.w,
                                 *_vector(m.twist.twist.linear))))
    track = _track([row for row in rows if 0.99 < np.linalg.norm(row[1][3:7]) < 1.01])
    if track is None:
        return None
    v = track.values
    return Odometry(topic, frame, track.t_ns, v[:, :3],
                    continuous(v[:, 3:7] / np.linalg.norm(v[:, 3:7], axis=1, keepdims=True)),
                    v[:, 7:])


def _static_transforms(bag, topics):
    """Return {(parent, child): q from child to parent} of every topic named tf_static."""
    transforms = {}
    for topic, type_name in topics.items():
        if type_name in TF and topic.rpartition('/')[2] == 'tf_static':
            for _, message in _messages(bag, topic):
                for t in message.transforms:
                    q = t.transform.rotation
                    ends = t.header.frame_id.lstrip('/'), t.child_frame_id.lstrip('/')
                    transforms[ends] = (q.x, q.y, q.z, q.w)
    return transforms
