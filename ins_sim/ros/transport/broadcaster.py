"""Publish transforms on /tf and /tf_static, if tf2_msgs is installed."""

from collections import deque

from ins_sim.messages import topics
from ins_sim.messages.transforms import read_transforms, TransformWriter
from . import qos
from .backlog import HandQueue

# Depth of the queues of /tf, the value that tf2 uses.
DEPTH = 100
# Number of our own messages that are remembered: more than a queue of /tf holds.
REMEMBERED = 4 * DEPTH


class Broadcaster:
    """
    Publishes the transforms of a vehicle that a node is responsible for, according to tf.source.

    The package tf2_msgs is imported only if tf.source asks for transforms. Without it (it is not
    among the ROS packages on PyPI) a warning is logged and nothing is published. If another node
    publishes the same frame, this is reported on /diagnostics.

    Parameters
    ----------
    node : Node with a ``monitor``
    settings : settings of the node, with ``frames`` and ``tf``
    moving : {tf.source: (parent, child)} of the transform on /tf, as names of ``frames``
    fixed : {tf.source: (parent, child, pose)} on /tf_static; the key '' is for every source
    """

    def __init__(self, node, settings, moving=None, fixed=None):
        source, self._names = settings.tf.source, settings.frames.names()
        self._node, self._pack, self._static = node, None, None
        self.publish, self.queue, self._sent = None, None, deque(maxlen=REMEMBERED)
        moving, fixed = (moving or {}).get(source), fixed or {}
        self._fixed = None if source == 'none' else fixed.get(source, fixed.get(''))
        try:
            if moving is not None:
                self._make_moving(moving)
            if self._fixed is not None:
                self._static = qos.make_publisher(node, topics.TF_STATIC, 1)
        except ImportError:
            self.publish = self._static = None
            node.get_logger().warning(
                f'tf.source is {source}, but tf2_msgs cannot be imported; expected that ROS '
                'package (apt: ros-jazzy-tf2-msgs): no transforms are published')

    def _make_moving(self, moving):
        publisher = qos.make_publisher(self._node, topics.TF, DEPTH)
        self.queue = HandQueue(self._node, topics.TF, DEPTH)
        self._placed = [self._names[frame] for frame in moving]
        self._pack, self._publish = TransformWriter(self._placed).pack, publisher.publish
        self.publish = self._remember
        self._node.monitor.add(self.describe)

    def _remember(self, data):
        self._sent.append(data)
        self._publish(data)

    def send(self, stamp_ns, pose):
        """Publish the moving transform, if the node has one."""
        if self.publish is not None:
            self.publish(self._pack(stamp_ns, pose))

    def send_fixed(self, stamp_ns):
        """Publish the static transform, if the node has one, with a stamp of the run."""
        if self._static is not None:
            parent, child, pose = self._fixed
            self._static.publish(TransformWriter(
                (self._names[parent], self._names[child])).pack(stamp_ns, pose))

    def describe(self):
        """Return a fault if another node publishes our frame, else '', and no values."""
        wrong, sent = '', set(self._sent)
        parent, child = self._placed
        for _ in range(DEPTH):
            if (data := self.queue.take()) is None:
                break
            if data in sent:
                continue
            try:
                others = [other for other, placed, *_ in read_transforms(data) if placed == child]
            except ValueError as error:
                wrong = f'{topics.TF.name}: {error}'
            else:
                if others:
                    wrong = (f'{topics.TF.name}: another node publishes {child!r} in '
                             f'{others[0]!r}, and this node publishes it in {parent!r}; '
                             'expected one source for each frame: the same tf.source in all '
                             'nodes, no other localization node at the same time, and a separate '
                             'frames.prefix for each vehicle')
        return wrong, ()
