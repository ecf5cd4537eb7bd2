<<<<<<< HEAD
"""Reading what nodes publish back from a rosbag2 bag, without ROS."""

import numpy as np

from ..core.records import ImuSamples, NavErrors
=======
"""Reading what the nodes publish back from a bag, without ROS."""

import numpy as np

from .bag_reader import open_bag
from ..core.records import NavErrors
>>>>>>> 524d3af352e8622d90d90e01c1c03ee06c3b3d14
from ..messages import topics


def read_errors(path, namespace=''):
    """
    Return the NavErrors of ins/error/* in a bag; t_ns are the stamps.

    Raises ValueError if a topic is missing, or the four do not have the same stamps.
    """
    prefix = f'/{namespace.strip("/")}/' if namespace else '/'
    names = [prefix + topic.name for topic in topics.ERRORS]
    with open_bag(path) as bag:
        tables = bag.tables(dict.fromkeys(names))
    for name, table in tables.items():
        if not len(table):
            raise ValueError(f'{path} has no message on {name}')
    t_ns = tables[names[0]]['stamp_ns']
    if any(not np.array_equal(t_ns, table['stamp_ns']) for table in tables.values()):
        raise ValueError(f'{path}: the topics under {prefix}ins/error have different stamps; '
                         'expected all four of every output')
<<<<<<< HEAD
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
=======
    return NavErrors(t_ns, *(table['vector'] for table in tables.values()))
>>>>>>> 524d3af352e8622d90d90e01c1c03ee06c3b3d14
