"""The motion that settings name, whether a closed form, a CSV file or a bag."""

from .storages import is_bag
from ..core import motions


def make_motion(settings):
    """
    Return the motion of MotionGeneratorSettings or ImuSensorSettings.

    It is that of ``core.motions.make_motion``, or the RecordedMotion of the truth in a bag.
    Raises ValueError or OSError in one sentence on settings or a recording that cannot be used.
    """
    motion = settings.motion
    if motion.kind != 'recording' or not is_bag(motion.recording.path):
        return motions.make_motion(motion, settings.datum, settings.earth)
    # the readers of bags are off the way of a node that needs none
    from .recorded_truth import read_poses
    from ..core.recording import RecordedMotion
    recording = motion.recording
    return RecordedMotion(recording, settings.earth,
                          read_poses(recording.path, recording.topic, settings.datum))
