"""Compute the transform map -> odom from the aided solution and the free INS solution."""

from ins_sim.core.streams.pairs import StampPairs
from ins_sim.messages import topics
from ins_sim.messages.plausible import PlausibleReader
from ins_sim.messages.transforms import pose_between
from .backlog import HandQueue
from .patience import MISSING_S


class MapToOdom:
    """
    Subscribes to ins/odometry and broadcasts map -> odom.

    Each aided solution waits for the free INS solution of its instant; the transform is published
    for every instant that has both.

    Parameters
    ----------
    node : StageNode
    broadcaster : Broadcaster
    depth : depth of the queue

    Attributes
    ----------
    reached_ns : stamp of the last free INS solution, ns, or None
    """

    def __init__(self, node, broadcaster, depth):
        self._node, self._broadcaster, self._patient = node, broadcaster, True
        self.reached_ns = None
        self._reader = PlausibleReader(topics.INS_ODOMETRY, ((0, 3), (3, 7)))
        self.queue = HandQueue(node, topics.INS_ODOMETRY, depth)
        self._pairs = StampPairs(depth)

    @property
    def waiting(self):
        """Return whether an aided solution waits for the free INS solution."""
        return self._patient and self._pairs.waiting

    def clear(self):
        """Discard the waiting solutions."""
        self._pairs.clear()

    def solved(self, stamp_ns, pose):
        """Process the pose of an aided solution."""
        self._send(self._pairs.push_first(stamp_ns, pose))

    def take(self):
        """Process the free INS solutions that have arrived."""
        for data in self._node.taken_of(self.queue):
            try:
                stamp_ns, place, turn = self._reader.read(data)
            except ValueError as error:
                self._node.fault(str(error))
            else:
                self._patient, self.reached_ns = True, stamp_ns
                self._send(self._pairs.push_second(stamp_ns, (*place, *turn)))

    def miss(self):
        """Report that no free INS solution has arrived, and stop waiting until one does."""
        self._patient = False
        self._node.fault(f'no message on {topics.INS_ODOMETRY.name} in {MISSING_S:g} s; expected '
                         'a free INS solution for every aided one, because tf.source is aided; '
                         'map -> odom is not published without it')

    def _send(self, pairs):
        for stamp_ns, solved, free in pairs:
            self._broadcaster.send(stamp_ns, pose_between(solved, free))
