"""Reading what the nodes publish back from a bag, without ROS."""

import numpy as np

from .bag_reader import open_bag
from ..core.records import NavErrors
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
