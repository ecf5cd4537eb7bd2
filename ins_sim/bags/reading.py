"""Reading what the nodes publish back from a rosbag2 bag, without ROS."""

import numpy as np

from ..core.records import NavErrors
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
