"""The transform map -> odom, from the aided solution and the free INS at the same instants."""

from ins_sim.core.streams.pairs import StampPairs
from ins_sim.messages import topics
from ins_sim.messages.plausible import PlausibleReader
from ins_sim.messages.transforms import pose_between
from .backlog import HandQueue
from .patience import MISSING_S


class MapToOdom:
    """
    Reads ins/odometry beside the solutions of a node, and broadcasts map -> odom.

    An aided solution waits for the INS of its instant, so that every one that has both is
    published.  node: StageNode; depth: of the queue.  reached_ns: the stamp of the INS that came
    last, or None.
    """

    def __init__(self, node, broadcaster, depth):
        self._node, self._broadcaster, self._patient = node, broadcaster, True
        self.reached_ns = None
        self._reader = PlausibleReader(topics.INS_ODOMETRY, ((0, 3), (3, 7)))
        self.queue = HandQueue(node, topics.INS_ODOMETRY, depth)
        self._pairs = StampPairs(depth)

    @property
    def waiting(self):
        """Return whether a solution waits for the INS."""
        return self._patient and self._pairs.waiting

    def clear(self):
        """Forget what has come."""
        self._pairs.clear()

    def solved(self, stamp_ns, pose):
        """Take the pose of the aided solution."""
        self._send(self._pairs.push_first(stamp_ns, pose))

    def take(self):
        """Take the solutions of the INS that have come."""
        for data in self._node.taken_of(self.queue):
            try:
                stamp_ns, place, turn = self._reader.read(data)
            except ValueError as error:
                self._node.fault(str(error))
            else:
                self._patient, self.reached_ns = True, stamp_ns
                self._send(self._pairs.push_second(stamp_ns, (*place, *turn)))

    def miss(self):
        """Say that nothing has come, and wait no longer until something comes."""
        self._patient = False
        self._node.fault(f'no message on {topics.INS_ODOMETRY.name} in {MISSING_S:g} s; expected '
                         'the odom of every solution (tf.source aided): no map -> odom without it')

    def _send(self, pairs):
        for stamp_ns, solved, free in pairs:
            self._broadcaster.send(stamp_ns, pose_between(solved, free))
