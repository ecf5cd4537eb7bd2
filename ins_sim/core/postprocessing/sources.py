"""The recorded data that ``navigate`` processes."""

from dataclasses import dataclass

# Default reason why there is no position.
NO_FIXES = 'there is no NavSatFix and no reference.path'


@dataclass(frozen=True)
class Sources:
    """
    Recorded data.

    Attributes
    ----------
    name : name of the recorded data
    imu : RecordedImu in the sensor frame
    frame : name of that frame
    reference : Reference or None
    odometry : OdometryReference or None
    transforms : {(parent, child): q} from /tf_static, q maps child to parent; or None
    notes : sentences on findings while reading
    without_position : why the reference has no position

    """

    name: str
    imu: object
    frame: str
    reference: object = None
    odometry: object = None
    transforms: object = None
    notes: tuple = ()
    without_position: str = NO_FIXES
