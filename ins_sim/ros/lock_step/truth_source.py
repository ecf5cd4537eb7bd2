"""Compute the truth of a run as serialized messages, block by block."""

import math

import numpy as np

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.motion import check_length, check_places
from ins_sim.core.numerics.instants import period_ns
from ins_sim.io.motion import read_motion
from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND, STAMP_END_NS
from ins_sim.messages.convert import truth_blocks
from ins_sim.messages.run_announcement import RunAnnouncement
from ins_sim.messages.transforms import TransformWriter
from ins_sim.settings.guidance import check_control_rate

BLOCK = 256
STAMP_END_S = STAMP_END_NS // SECOND
# Length of the part of an endless run whose positions are checked before the start, s.
LOOK_S = 86400.0
# Margin for the stamps of sensor samples, which latency and jitter make later than the truth, ns.
END_NS = 10 * SECOND


class TruthSource:
    """
    Serialized truth messages of each sample of a run, in the order of topics.TRUTH.

    If tf.source is ``truth``, the message for /tf follows them. Raises ValueError if the settings
    name no motion, or a run longer than the motion.

    Attributes
    ----------
    epoch_ns, first_ns : stamp of motion time zero; motion time of sample 0, ns
    dt_ns : sampling period, ns
    count : number of samples
    endless : whether the run has no end of its own, so that it ends at the last ROS stamp
    announcement : RunAnnouncement
    guided : GuidedMotion, whose samples are known only after its commands, or None
    """

    def __init__(self, settings):
        self._motion = motion = read_motion(settings)
        self.guided = motion if settings.motion.kind == 'guided' else None
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        names = settings.frames.names()
        self._writers = [(topic, topic.named(names).writer()) for topic in topics.TRUTH]
        self.first_ns = round(settings.start_s * SECOND)
        self.epoch_ns = settings.time.epoch_ns(self.first_ns, live=True)
        self.dt_ns = period_ns(settings.rate_hz)
        length_s = settings.duration_s
        if self.guided:
            check_control_rate(settings.motion.guided, 'motion_generator', settings.rate_hz)
            length_s = motion.length_s(settings.start_s, length_s)
        elif length_s:
            check_length(settings, motion)
        elif motion.end_s < math.inf:
            length_s = motion.end_s - settings.start_s
        else:
            check_places(motion, settings.start_s, LOOK_S)
        last_s = self.epoch_ns / SECOND + settings.start_s + length_s
        if last_s >= STAMP_END_S:
            raise ValueError(f'time.epoch_s + start_s + duration_s is {last_s:g} s; expected less '
                             f'than {STAMP_END_S} s, which a ROS stamp can hold')
        # An endless run ends at the largest ROS stamp.
        last_ns = round(length_s * SECOND) if length_s else STAMP_END_S * SECOND - END_NS - \
            self.stamp_ns(0)
        self.endless, self.count = not length_s, last_ns // self.dt_ns + 1
        if self.count < 1:
            raise ValueError(f'the first stamp is {last_s:g} s; expected less than '
                             f'{STAMP_END_S - END_NS // SECOND} s in a run without duration_s, '
                             'because it would exceed the largest stamp of ROS')
        self._transforms = None
        if settings.tf.source == 'truth':
            self._transforms = TransformWriter(topics.TRUTH_ODOMETRY.named(names).frames).pack
        self.announcement = RunAnnouncement(self.epoch_ns, self.first_ns, settings.rate_hz,
                                            self.first_ns + (self.count - 1) * self.dt_ns)
        self.restart()

    def restart(self):
        """Go back to the start of the run; a guided motion forgets its commands."""
        self._block, self._start = [], 0
        if self.guided:
            self.guided.begin(self.first_ns)

    @property
    def known(self):
        """Return the number of samples whose truth is known."""
        if not self.guided:
            return self.count
        return min(self.count, (self.guided.known_ns - self.first_ns) // self.dt_ns + 1)

    def stamp_ns(self, k):
        """Return the stamp of sample k, ns."""
        return self.epoch_ns + self.first_ns + k * self.dt_ns

    def messages(self, k):
        """Return the messages of sample k, which must be known."""
        if not 0 <= k - self._start < len(self._block):
            self._fill(k)
        return self._block[k - self._start]

    def _fill(self, start):
        k = np.arange(start, min(start + BLOCK, self.known), dtype=np.int64)
        truth = self._motion.at(self.first_ns + k * self.dt_ns)
        values = truth_blocks(self._frame, truth)
        stamps = self.epoch_ns + truth.t_ns
        columns = [writer.pack_block(stamps, values[topic]) for topic, writer in self._writers]
        if self._transforms is not None:
            poses = values[topics.TRUTH_ODOMETRY][:, :7].tolist()
            columns.append([*map(self._transforms, stamps.tolist(), poses)])
        self._block = list(zip(*columns))
        self._start = start
