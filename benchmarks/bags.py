"""
CPU time of a message in a bag: our arrays compared with rosbags, in one process.

Run: python benchmarks/bags.py [messages of each topic, by default 100000]
"""

import gc
from pathlib import Path
import shutil
from statistics import median
import sys
import tempfile
from time import process_time

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, Reader, StoragePlugin, Writer
from rosbags.typesys import get_typestore, Stores

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.messages import topics

KINDS = (('mcap', 'none'), ('mcap', 'lz4'), ('mcap', 'zstd'), ('sqlite3', 'none'))
TOPICS = (topics.IMU_RAW, topics.INS_ODOMETRY)
BLOCK = 4096
REPEATS = 7
# The fields that a navigator reads; by default all are read, covariances too.
FIELDS = {'imu/data_raw': ('angular_velocity', 'linear_acceleration'),
          'ins/odometry': ('position', 'orientation', 'linear', 'angular')}


class Bags:
    """One set of messages on imu/data_raw and ins/odometry, written and read in both ways."""

    def __init__(self, n):
        self._folder = Path(tempfile.mkdtemp())
        self._store = get_typestore(Stores.ROS2_JAZZY)
        self._n = n
        rng = np.random.default_rng(0)
        self._stamps = np.arange(n) * 10**7
        self._values = {topic: rng.normal(size=(n, sum(b - a for a, b in topic.writer().runs)))
                        for topic in TOPICS}
        # rosbags begins with message objects, and we with arrays: their creation is not timed.
        self._objects = {topic: [self._store.deserialize_cdr(data, topic.type_name)
                                 for data in topic.writer().pack_block(self._stamps, values)]
                         for topic, values in self._values.items()}

    def write_ours(self, storage, compression):
        """Write from arrays."""
        with BagWriter(self._folder / 'ours', storage, compression) as bag:
            writers = {topic: topic.writer() for topic in TOPICS}
            for topic in TOPICS:
                bag.add_topic(topic.name, topic.type_name)
            for first in range(0, self._n, BLOCK):
                rows = slice(first, first + BLOCK)
                stamps = self._stamps[rows]
                bag.write_blocks({topic.name: (stamps, writers[topic].block(stamps, values[rows]))
                                  for topic, values in self._values.items()})

    def write_theirs(self, storage, compression):
        """Write message by message with serialize_cdr and Writer.write."""
        bag = Writer(self._folder / 'rosbags', version=9,
                     storage_plugin=StoragePlugin[storage.upper()])
        if compression == 'zstd':
            bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        serialize = self._store.serialize_cdr
        with bag:
            ready = [(bag.add_connection('/' + topic.name, topic.type_name,
                                         typestore=self._store), topic.type_name, messages)
                     for topic, messages in self._objects.items()]
            for k, t_ns in enumerate(self._stamps.tolist()):
                for connection, type_name, messages in ready:
                    bag.write(connection, t_ns, serialize(messages[k], type_name))

    def read_ours(self, wanted):
        """Read our bag into arrays."""
        with open_bag(self._folder / 'ours') as bag:
            tables = bag.tables(wanted)
        assert all(len(table) == self._n for table in tables.values())

    def read_theirs(self):
        """Read our bag message by message with messages and deserialize."""
        count, deserialize = 0, self._store.deserialize_cdr
        with Reader(self._folder / 'ours') as bag:
            for connection, _, data in bag.messages():
                deserialize(data, connection.msgtype)
                count += 1
        assert count == 2 * self._n

    def close(self):
        """Delete the bags."""
        shutil.rmtree(self._folder)

    def measure(self, kind):
        """
        Return {operation: median CPU microseconds of a message}, and two {operation: ratio}.

        The first ratio is that of the medians, the second that of the best runs, which other load
        on the machine affects least. The two ways alternate, so that other load affects both.
        """
        everything = dict.fromkeys(FIELDS)
        paths = {'write ours': lambda: self.write_ours(*kind),
                 'write rosbags': lambda: self.write_theirs(*kind),
                 'read all fields': lambda: self.read_ours(everything),
                 'read some fields': lambda: self.read_ours(FIELDS),
                 'read rosbags': self.read_theirs}
        times = {name: [] for name in paths}
        for _ in range(REPEATS):
            for name, path in paths.items():
                if name.startswith('write'):
                    shutil.rmtree(self._folder / name.split()[1], ignore_errors=True)
                gc.collect()
                start = process_time()
                path()
                times[name].append((process_time() - start) / (2 * self._n) * 1e6)

        def faster(figure):
            cost = {name: figure(values) for name, values in times.items()}
            return {'write': cost['write rosbags'] / cost['write ours'],
                    'read all fields': cost['read rosbags'] / cost['read all fields'],
                    'read some fields': cost['read rosbags'] / cost['read some fields']}

        return {name: median(values) for name, values in times.items()}, faster(median), \
            faster(min)


def report(n, kinds=KINDS):
    """Print the results of every kind; return {kind: (ratios of medians, of best runs)}."""
    bags, found = Bags(n), {}
    try:
        for kind in kinds:
            times, *found[kind] = bags.measure(kind)
            print(f'{", ".join(kind)}: us a message: write {times["write ours"]:.2f}, rosbags '
                  f'{times["write rosbags"]:.2f}; read into arrays {times["read all fields"]:.2f} '
                  f'(without covariances {times["read some fields"]:.2f}), rosbags '
                  f'{times["read rosbags"]:.2f}')
            for name, ratios in zip(('medians', 'best runs'), found[kind]):
                print(f'    {name}: write {ratios["write"]:.1f} times faster, read '
                      f'{ratios["read all fields"]:.1f} ({ratios["read some fields"]:.1f})')
    finally:
        bags.close()
    return found


if __name__ == '__main__':
    report(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000)
