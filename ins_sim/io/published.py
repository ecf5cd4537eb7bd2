"""Read messages of the nodes from a bag, without ROS."""

import numpy as np

from ins_sim.bags.bag_reader import open_bag
from ins_sim.core.timeseries.histories import ImuSamples, NavErrors
from ins_sim.messages import topics
from . import bag_imu
from .topic_choice import choose_topic


def read_errors(path, namespace=''):
    """
    Return the NavErrors of the four ``ins/error`` topics of a bag; t_ns holds the stamps.

    Raises ValueError if a topic is missing, or if their stamps differ.
    """
    prefix = f'/{namespace.strip("/")}/' if namespace else '/'
    names = [prefix + topic.name for topic in topics.ERRORS]
    with open_bag(path) as bag:
        tables = bag.tables(dict.fromkeys(names))
    for name, table in tables.items():
        if not len(table):
            raise ValueError(f'{path} has no message on {name}; expected all four topics of '
                             'ins/error')
    t_ns = tables[names[0]]['stamp_ns']
    if any(not np.array_equal(t_ns, table['stamp_ns']) for table in tables.values()):
        raise ValueError(f'{path}: the topics under {prefix}ins/error have different stamps; '
                         'expected all four topics for every output')
    return NavErrors(t_ns, *(table['vector'] for table in tables.values()))


def read_imu(path, topic=None):
    """
    Return the ImuSamples of the sensor_msgs/msg/Imu messages of a bag, in the order recorded.

    topic is the name, or None for the only one. t_ns holds the header stamps, omega and f angular
    velocity and linear acceleration.  Raises ValueError if there is no such topic, or several.
    """
    with open_bag(path) as bag:
        topic = choose_topic(bag, [topics.IMU], 'auto' if topic is None else topic, '--topic',
                             needed=True)
        imu, _, _ = bag_imu.read_imu_messages(bag, topic)
    return ImuSamples(imu.t_ns, imu.omega, imu.f)
