"""Reading what nodes publish back from a rosbag2 bag, without ROS."""

import numpy as np

from ..core.records import ImuSamples, NavErrors
from ..messages import topics


def read_errors(path, namespace=''):
    """
    Return the NavErrors of ins/error/* in a bag; t_ns are the stamps.

    Raises ValueError if a topic is missing, or the four do not have the same stamps.
    """
    from rosbags.rosbag2 import Reader
    from rosbags.rosbag2.errors import ReaderError
    prefix = f'/{namespace.strip("/")}/' if namespace else '/'
    wanted = {prefix + topic.name: topic for topic in topics.ERRORS}
    readers = {name: topic.reader().read for name, topic in wanted.items()}
    samples = {name: [] for name in wanted}
    try:
        with Reader(path) as bag:
            connections = [c for c in bag.connections if c.topic in wanted]
            for connection, _, data in bag.messages(connections=connections):
                samples[connection.topic].append(readers[connection.topic](data))
    except ReaderError as error:
        raise ValueError(f'{path} is no readable bag: {error}') from None
    columns = []
    for name, history in samples.items():
        if not history:
            raise ValueError(f'{path} has no message on {name}')
        stamps, vectors = zip(*history)
        columns.append((np.array(stamps, dtype=np.int64), np.array(vectors)))
    t_ns = columns[0][0]
    if any(not np.array_equal(t_ns, stamps) for stamps, _ in columns[1:]):
        raise ValueError(f'{path}: the topics under {prefix}ins/error have different stamps; '
                         'expected all four of every output')
    return NavErrors(t_ns, *(vectors for _, vectors in columns))


def read_imu(path, topic=None):
    """
    Return the ImuSamples of the sensor_msgs/msg/Imu messages of a bag, in the order recorded.

    topic: which, or None for the only one there is; t_ns are the stamps of the headers, omega and
    f angular velocity and linear acceleration.  Raises ValueError where there is no such topic, or
    more than one to choose from.
    """
    from rosbags.rosbag2 import Reader
    from rosbags.rosbag2.errors import ReaderError
    read = topics.IMU_RAW.reader().read
    try:
        with Reader(path) as bag:
            found = [c for c in bag.connections if c.msgtype == topics.IMU]
            topic = _choose(path, topic, sorted({c.topic for c in found}))
            samples = [read(data) for _, _, data in bag.messages(
                connections=[c for c in found if c.topic == topic])]
    except ReaderError as error:
        raise ValueError(f'{path} is no readable bag: {error}') from None
    if not samples:
        raise ValueError(f'{path} has no message on {topic}')
    t_ns, omega, f = zip(*samples)
    return ImuSamples(np.array(t_ns, dtype=np.int64), np.array(omega), np.array(f))


def _choose(path, topic, known):
    """Return the topic that is meant, of those that there are."""
    if not known:
        raise ValueError(f'{path} has no topic of type {topics.IMU}')
    if topic is None and len(known) > 1:
        raise ValueError(f'{path} has {len(known)} topics of type {topics.IMU}; expected '
                         f'--topic with one of {", ".join(known)}')
    if topic is not None and f'/{topic.lstrip("/")}' not in known:
        raise ValueError(f'{path} has no topic {topic} of type {topics.IMU}; expected one of '
                         f'{", ".join(known)}')
    return known[0] if topic is None else f'/{topic.lstrip("/")}'
