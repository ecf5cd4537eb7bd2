"""What the nodes would publish on /tf and /tf_static of an offline run."""

from ins_sim.messages import placements, topics
from ins_sim.messages.transforms import pose_between, TransformWriter
from .simulated_aiding import message_columns


class SimulatedTransforms:
    """
    The transforms of a run, by windows.

    settings: SimulationSettings; aided: AidedSimulationSettings, or None.
    """

    def __init__(self, settings, aided):
        generator = settings.motion_generator
        self._source, self._names = generator.tf.source, generator.frames.names()
        self._fixed = [placements.imu_mounting(settings.imu_sensor)]
        if aided is not None:
            self._fixed += [placements.meter_mounting(aided.velocity_meter),
                            placements.gnss_mounting(aided.gnss)]
        if self._source in placements.INS_FIXED:
            self._fixed.append(placements.INS_FIXED[self._source])

    def _packer(self, parent, child):
        return TransformWriter(self._names[parent], self._names[child]).pack

    def blocks(self, stamped, is_first):
        """
        Return {Topic: (stamps_ns (n,), messages (n,))} of a window.

        stamped: {Topic: (stamps_ns, values)} of its other topics; is_first: whether it begins the
        run, of which what is fixed has the first stamp.
        """
        first_ns = int(stamped[topics.TRUTH_ODOMETRY][0][0])
        fixed = [(first_ns, self._packer(parent, child)(first_ns, pose))
                 for parent, child, pose in self._fixed] if is_first else []
        moving = []
        for moves, topic in ((placements.TRUTH_MOVES, topics.TRUTH_ODOMETRY),
                             (placements.INS_MOVES, topics.INS_ODOMETRY)):
            if self._source in moves:
                pack = self._packer(*moves[self._source])
                moving += [(t, pack(t, pose)) for t, pose in _poses(stamped[topic])]
        if self._source in placements.AIDED_MOVES:
            pack = self._packer(*placements.AIDED_MOVES[self._source])
            free = dict(_poses(stamped[topics.INS_ODOMETRY]))
            moving += [(t, pack(t, pose_between(pose, free[t])))
                       for t, pose in _poses(stamped[topics.AIDED_ODOMETRY]) if t in free]
        # Stable: of one instant the strapdown stands before the navigator.
        moving.sort(key=lambda one: one[0])
        return {topics.TF_STATIC: message_columns(fixed), topics.TF: message_columns(moving)}


def _poses(stamped):
    """Return (stamp_ns, pose) of the Odometry of a window."""
    stamps_ns, values = stamped
    return zip(stamps_ns.tolist(), values[:, :7].tolist())
