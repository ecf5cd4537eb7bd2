"""Reading what nodes publish back from a bag, without ROS."""

import numpy as np

from .bag_reader import open_bag
from ..core.records import ImuSamples, NavErrors
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
    return NavErrors(t_ns, *(table['vector'] for table in tables.values()))


def read_imu(path, topic=None):
    """
    Return the ImuSamples of the sensor_msgs/msg/Imu messages of a bag, in the order recorded.

    topic: which, or None for the only one there is; t_ns are the stamps of the headers, omega and
    f angular velocity and linear acceleration.  Raises ValueError where there is no such topic, or
    more than one to choose from.
    """
    with open_bag(path) as bag:
        known = sorted(c.name for c in bag.topics.values() if c.type_name == topics.IMU)
        topic = _choose(path, topic, known)
        table = bag.arrays(topic, ('angular_velocity', 'linear_acceleration'))
    if not len(table):
        raise ValueError(f'{path} has no message on {topic}')
    return ImuSamples(table['stamp_ns'], table['angular_velocity'], table['linear_acceleration'])


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
