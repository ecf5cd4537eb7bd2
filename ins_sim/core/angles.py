"""Roll, pitch and compass heading against q_nb: arrays, rad, any leading shape."""

import numpy as np

from . import attitude, taylor


def from_compass(roll, pitch, heading):
    """
    Return q_nb (n, 4) of (n,) roll (right side down), pitch (nose up), heading (clockwise).

    It is ``attitude.from_angles`` with psi = -heading.
    """
    angles = (-np.asarray(heading, dtype=float), pitch, roll)
    q = attitude.from_angles(*(taylor.Series(np.atleast_1d(np.asarray(a, dtype=float))[None])
                               for a in angles))
    return np.stack([x.value for x in q], axis=-1)


def to_compass(q_nb):
    """Return roll, pitch, heading (0 to 2 pi) of q_nb (..., 4)."""
    q = np.moveaxis(np.asarray(q_nb, dtype=float), -1, 0)
    zero, one = np.zeros_like(q[0]), np.ones_like(q[0])
    # the vertical in b gives roll and pitch, the forward axis in n the heading
    up = attitude.rotate_back(q, (zero, zero, one))
    east, north, _ = attitude.rotate(q, (one, zero, zero))
    pitch = np.arctan2(up[0], np.hypot(up[1], up[2]))
    return np.arctan2(up[1], up[2]), pitch, np.arctan2(east, north) % (2.0 * np.pi)
