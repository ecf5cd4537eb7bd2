"""Read the truth recorded in a bag as poses for a recorded motion."""

import numpy as np

from ins_sim.bags.bag_reader import open_bag
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.recorded.poses import poses_of_truth
from ins_sim.core.numerics.instants import seconds
from ins_sim.messages import topics
from .csv_flight import USED
from .map_origin import given_origin, map_origin
from .topic_choice import choose_topic

KEY = 'motion.recording.topic'
# Topics in the namespace of an odometry whose name ends in truth/odometry.
SIBLINGS = {topics.TRUTH_FIX: ('latitude', 'longitude', 'altitude'),
            topics.TRUTH_ATTITUDE: ('quaternion',)}


def read_poses(path, topic, datum, key=KEY, origin='fix'):
    """
    Return the RecordedPoses of an Odometry topic of a bag.

    Position and attitude are taken from truth/fix and truth/attitude in the same namespace if
    both exist; otherwise the odometry is converted with the origin of its frame (``map_origin``).

    Parameters
    ----------
    path : path of the bag
    topic : topic name, or 'auto' for the only one that ends in truth/odometry
    datum : Datum of the settings
    key : parameter that gives the topic, for messages
    origin : 'fix' to search the origin in the bag, 'datum' to use the datum

    Raises
    ------
    ValueError
        If the topic is missing, has another type or does not hold a motion, or if the origin is
        unknown.
    """
    with open_bag(path) as bag:
        name = choose_topic(bag, [topics.ODOMETRY], topic, key, topics.TRUTH_ODOMETRY.name,
                            needed=True)
        table = bag.arrays(name, ('position', 'orientation', 'linear', 'angular'))
        beside = None if origin == 'datum' else _beside(bag, name)
        notes = ()
        if beside is None and len(table):
            find = given_origin if origin == 'datum' else map_origin
            datum, note = find(bag, name, datum)
            notes = (note,)
    where = f'{path}: {name}'
    if not len(table):
        raise ValueError(f'{where} is empty; expected messages')
    for field in table.dtype.names[2:]:
        _check(where, table['stamp_ns'], field, table[field], np.isfinite(table[field]).all(1))
    if beside:
        table, fix, attitude = _matched(where, table, beside)
        lat_deg, lon_deg, height_m = fix['latitude'], fix['longitude'], fix['altitude']
        q_nb = attitude['quaternion']
    else:
        lat_deg, lon_deg, height_m, q_nb = _from_map(table, datum)
    t_ns = table['stamp_ns']
    for field, values in zip(USED, (lat_deg, lon_deg, height_m)):
        low, high = USED[field]
        _check(where, t_ns, field, values, (values >= low) & (values <= high),
               f'{low:g} to {high:g}')
    norm = np.linalg.norm(q_nb, axis=1)
    _check(where, t_ns, 'norm of the orientation', norm, np.abs(norm - 1.0) < 1e-3, '1')
    return poses_of_truth(str(path), t_ns.copy(), lat_deg, lon_deg, height_m,
                          q_nb / norm[:, None], table['linear'], table['angular'], notes)


def _check(where, t_ns, what, values, good, expected='finite numbers'):
    """Raise ValueError on the first value that is not good."""
    if not good.all():
        k = int(np.argmin(good))
        raise ValueError(f'{where} at {seconds(t_ns[k])}: {what} is {values[k].tolist()}; '
                         f'expected {expected}')


def _beside(bag, name):
    """Return the arrays of truth/fix and truth/attitude next to truth/odometry, or None."""
    ending = topics.TRUTH_ODOMETRY.name
    if not name.endswith(ending):
        return None
    names = {topic: name.removesuffix(ending) + topic.name for topic in SIBLINGS}
    if not all(n in bag.topics for n in names.values()):
        return None
    return [bag.arrays(names[topic], fields, topic.type_name)
            for topic, fields in SIBLINGS.items()]


def _matched(where, table, others):
    """Return the rows whose stamps occur in all arrays, in the order of the first array."""
    found, good = [], np.ones(len(table), dtype=bool)
    for other in others:
        stamps, first = np.unique(other['stamp_ns'], return_index=True)
        k = np.minimum(np.searchsorted(stamps, table['stamp_ns']), max(0, len(stamps) - 1))
        good &= stamps[k] == table['stamp_ns'] if len(stamps) else False
        found.append(first[k] if len(stamps) else k)
    if not good.any():
        raise ValueError(f'{where} has no stamp in common with '
                         f'{" and ".join(topic.name for topic in SIBLINGS)} of the same run; '
                         'expected all three for every sample')
    return table[good], *(other[k[good]] for other, k in zip(others, found))


def _from_map(table, datum):
    """Return lat_deg, lon_deg, height_m (n,) and q_nb (n, 4) of poses in the map frame."""
    frame = MapFrame(datum, False)
    rows = [frame.geodetic_one(*row) for row in zip(
        table['position'].tolist(), table['orientation'].tolist(), table['linear'].tolist())]
    lat, lon, height, _, q_nb = (np.array(column) for column in zip(*rows))
    return np.degrees(lat), np.degrees(lon), height, q_nb
