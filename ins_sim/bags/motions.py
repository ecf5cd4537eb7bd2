"""The motion that settings name, whether a closed form, a CSV file or a bag."""

from pathlib import Path

from ..core import motions

SUFFIXES = ('.mcap', '.db3')


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


def is_bag(path):
    """Return whether a path is a folder, or named as a file of a bag."""
    return Path(path).suffix in SUFFIXES or (bool(str(path)) and Path(path).is_dir())
