"""The recorded data that ``navigate`` receives."""

from dataclasses import dataclass

# Default reason for a missing position.
NO_FIXES = 'there is no NavSatFix and no reference.path'


@dataclass(frozen=True)
class Sources:
    """
    A recording.

    imu: RecordedImu in the frame of the sensor; frame: name of this frame; reference: Reference or
    None; odometry: OdometryReference or None; transforms: {(parent, child): q} of /tf_static, or
    None; notes: messages of the readers; without_position: why the reference has no position.
    """

    name: str
    imu: object
    frame: str
    reference: object = None
    odometry: object = None
    transforms: object = None
    notes: tuple = ()
    without_position: str = NO_FIXES
