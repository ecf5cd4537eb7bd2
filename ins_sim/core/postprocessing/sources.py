"""What was recorded, as it is handed to ``navigate``."""

from dataclasses import dataclass

# Why there is no position, where nobody says more.
NO_FIXES = 'there is no NavSatFix and no reference.path'


@dataclass(frozen=True)
class Sources:
    """
    What was recorded.

    name; imu: RecordedImu in the frame of the sensor; frame: its name; reference: Reference or
    None; odometry: Odometry or None; transforms: {(parent, child): q} of /tf_static; notes: what
    the reading found, in sentences; without_position: why the reference has no position.
    """

    name: str
    imu: object
    frame: str
    reference: object = None
    odometry: object = None
    transforms: object = None
    notes: tuple = ()
    without_position: str = NO_FIXES
