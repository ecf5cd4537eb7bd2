"""Transforms on /tf and /tf_static for an offline run, as the nodes would publish them."""

from itertools import groupby
from operator import itemgetter

from ins_sim.messages import placements, topics
from ins_sim.messages.transforms import pose_between, TransformWriter
from .aiding import message_columns


class SimulatedTransforms:
    """
    Transforms of a run, window by window.

    settings: SimulationSettings; aided: AidedSimulationSettings, or None.
    """

    def __init__(self, settings, aided):
        generator = settings.motion_generator
        self._source, self._names = generator.tf.source, generator.frames.names()
        self._writers = {}
        self._fixed = [placements.imu_mounting(settings.imu_sensor)]
        if aided is not None:
            self._fixed += [placements.meter_mounting(aided.velocity_meter),
                            placements.gnss_mounting(aided.gnss)]
        if self._source in placements.INS_FIXED:
            self._fixed.append(placements.INS_FIXED[self._source])

    def blocks(self, stamped, is_first):
        """
        Return {Topic: (stamps_ns (n,), messages (n,))} of a window.

        Transforms of the same instant are in one message.

        Parameters
        ----------
        stamped : {Topic: (stamps_ns, values)} of the other topics of the window
        is_first : whether the window begins the run: the fixed transforms are then included, with
            its first stamp

        """
        first_ns = int(stamped[topics.TRUTH_ODOMETRY][0][0])
        fixed = [(first_ns, (parent, child), pose)
                 for parent, child, pose in self._fixed] if is_first else []
        moving = []
        for moves, topic in ((placements.TRUTH_MOVES, topics.TRUTH_ODOMETRY),
                             (placements.INS_MOVES, topics.INS_ODOMETRY)):
            if self._source in moves:
                moving += [(t, moves[self._source], pose) for t, pose in _poses(stamped[topic])]
        if self._source in placements.AIDED_MOVES:
            pair = placements.AIDED_MOVES[self._source]
            free = dict(_poses(stamped[topics.INS_ODOMETRY]))
            moving += [(t, pair, pose_between(pose, free[t]))
                       for t, pose in _poses(stamped[topics.AIDED_ODOMETRY]) if t in free]
        # The sort is stable: at the same instant the strapdown precedes the navigator.
        moving.sort(key=lambda one: one[0])
        return {topics.TF_STATIC: message_columns(self._messages(fixed)),
                topics.TF: message_columns(self._messages(moving))}

    def _messages(self, transforms):
        """Return (stamp_ns, message) of transforms (stamp_ns, (parent, child), pose), sorted."""
        found = []
        for t, same in groupby(transforms, itemgetter(0)):
            _, pairs, poses = zip(*same)
            if pairs not in self._writers:
                self._writers[pairs] = TransformWriter(*(
                    tuple(self._names[frame] for frame in pair) for pair in pairs))
            found.append((t, self._writers[pairs].pack(t, *poses)))
        return found


def _poses(stamped):
    """Return (stamp_ns, pose) of the Odometry of a window."""
    stamps_ns, values = stamped
    return zip(stamps_ns.tolist(), values[:, :7].tolist())
