"""Create the motion of the settings, in closed form or from a CSV file or a bag."""

import warnings

from ins_sim.bags.storages import is_bag
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.motion.motion import Motion
from ins_sim.settings.catalogue import values_of


def read_motion(settings) -> Motion:
    """
    Return the motion of MotionGeneratorSettings or ImuSensorSettings.

    Assumptions, cuts, smoothing and noise of a recording are reported as warnings.  Raises
    ValueError or OSError if the settings or the recording cannot be used.
    """
    motion = settings.motion
    if motion.kind != 'recording':
        return make_motion(motion, settings.datum, settings.earth)
    # Imported lazily: splines need SciPy, and nodes that do not need them start faster.
    from ins_sim.core.motion.recorded.spline import RecordedMotion
    flown = RecordedMotion(_read_poses(motion.recording, settings.datum), motion.recording,
                           settings.earth)
    for sentence in flown.warnings:
        warnings.warn(sentence, stacklevel=1)
    return flown


def _read_poses(recording, datum):
    if is_bag(recording.path):
        from .bag_truth import read_poses
        return read_poses(recording.path, recording.topic, datum, origin=recording.origin)
    from .csv_flight import read_poses
    if recording.topic != 'auto':
        raise ValueError(f'motion.recording.topic is {recording.topic!r}, but {recording.path} is '
                         'not a bag; expected auto')
    if recording.origin != 'fix':
        raise ValueError(f'motion.recording.origin is {recording.origin}, but {recording.path} is '
                         'not a bag; expected fix')
    return read_poses(recording.path, values_of(recording.columns))
