"""A node that writes topics into a bag, byte for byte."""

from pathlib import Path
import shutil

from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader, SECOND, Writer
from rclpy.node import Node

from . import qos
from .queue import DrivingQueue


class BagRecorder(Node):
    """
    Writes the messages of Topics into a bag (storage 'sqlite3' or 'mcap').

    A message is logged at its own stamp, and a sample that lock-step repeats is written once.
    The bag appears at path only when ``close`` has completed it.  acknowledge: name of the
    topic whose stamps are acknowledged as 'recorder', or None; the first acknowledgement comes
    when every topic has been heard.
    """

    def __init__(self, path, wanted=topics.DATA, storage='sqlite3', depth=2000,
                 acknowledge=topics.TRUTH_IMU.name, name='recorder', **kwargs):
        super().__init__(name, **kwargs)
        from rosbags.rosbag2 import StoragePlugin, Writer as BagWriter
        from rosbags.typesys import get_typestore, Stores
        self.path = Path(path)
        if self.path.exists():
            raise ValueError(f'{self.path} exists; expected a new path for the bag')
        # a bag that is cut short must not look whole, so it grows under another name
        self._folder = self.path.with_name(self.path.name + '.part')
        shutil.rmtree(self._folder, ignore_errors=True)
        self._folder.mkdir(parents=True)
        self._bag = BagWriter(self._folder / self.path.name, version=9,
                              storage_plugin=StoragePlugin[storage.upper()])
        self._bag.open()
        store = get_typestore(Stores.ROS2_JAZZY)
        self.counts = {topic.name: 0 for topic in wanted}
        self._stamp_reader, self._ack = Reader(topics.CLOCK).read, Writer(topics.HEADER, name)
        self._ack_publisher = qos.ack_publisher(self)
        self._unacknowledged = None
        self.last_stamp_ns = 0
        self._queues = [self._queue(topic, store, depth, topic.name == acknowledge)
                        for topic in wanted]

    def _queue(self, topic, store, depth, acknowledged):
        name = self.resolve_topic_name(topic.name)
        connection = self._bag.add_connection(name, topic.type_name, typestore=store)
        write, read_stamp, counts = self._bag.write, self._stamp_reader, self.counts
        last = None

        def on_data(data):
            nonlocal last
            stamp_ns, _ = read_stamp(data)
            if acknowledged:
                # a repeated sample is acknowledged too: the first answer may have been lost
                self._unacknowledged = self.last_stamp_ns = stamp_ns
            if data != last:
                last = data
                write(connection, stamp_ns, data)
                counts[topic.name] += 1

        return DrivingQueue(self, topic, depth, on_data, self._on_drained)

    def _on_drained(self):
        # until every topic is heard nothing is acknowledged, so that lock-step repeats sample 0
        if self._unacknowledged is not None and all(self.counts.values()):
            self._ack_publisher.publish(self._ack.pack(self._unacknowledged))
            self._unacknowledged = None

    @property
    def last_s(self):
        """Return the stamp of the last acknowledged message, s."""
        return self.last_stamp_ns / SECOND

    def close(self):
        """Complete the bag and move it to its path."""
        self._bag.close()
        (self._folder / self.path.name).rename(self.path)
        self._folder.rmdir()

    def discard(self):
        """Close and delete an incomplete bag."""
        self._bag.close()
        shutil.rmtree(self._folder, ignore_errors=True)
