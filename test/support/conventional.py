"""Motions at the test datum, and rotation matrices by SciPy."""

from scipy.spatial.transform import Rotation
from support.studies import settings

from ins_sim.core.motion.factory import make_motion


def motion_of(kind, **more):
    """Return a motion of one kind at the test datum."""
    s = settings({'motion.kind': kind, 'datum.latitude_deg': 55.0, 'datum.longitude_deg': 37.0},
                 **more).motion_generator
    return make_motion(s.motion, s.datum, s.earth)


def matrix(q):
    """Return the rotation matrix of a quaternion computed by SciPy."""
    return Rotation.from_quat(q).as_matrix()
