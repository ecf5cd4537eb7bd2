"""How a sensor sits in the vehicle: the quaternion q_bs that maps the sensor's frame to b."""

import math

import numpy as np

from . import attitude
from .catalogue import nearest


def from_rpy(roll, pitch, yaw):
    """Return q_bs of roll, pitch, yaw about the fixed axes x, y, z (URDF), floats, rad."""
    return attitude.multiply(
        attitude.exponential((0.0, 0.0, yaw)),
        attitude.multiply(attitude.exponential((0.0, pitch, 0.0)),
                          attitude.exponential((roll, 0.0, 0.0))))


def levelled(force, yaw):
    """Return q_bs: the shortest turn that brings a force (3,) up, then one by yaw about up."""
    x, y, z = (force / np.linalg.norm(force)).tolist()
    # upside down any level axis will do
    axis = (y, -x, 0.0) if math.hypot(x, y) > 1e-12 else (1.0, 0.0, 0.0)
    scale = math.atan2(math.hypot(x, y), z) / math.hypot(*axis)
    return attitude.multiply(attitude.exponential((0.0, 0.0, yaw)),
                             attitude.exponential(tuple(scale * a for a in axis)))


def chain(transforms, base, frame):
    """
    Return q_bs from static transforms, or None where there are none at all.

    transforms: {(parent, child): q} where q maps child to parent, as TF has it; base, frame:
    names.  Raises ValueError, naming the nearest known frame, where one of both is not among
    them or they hang on different trees.
    """
    if not transforms:
        return None
    links = {}
    for (parent, child), q in transforms.items():
        links.setdefault(parent, []).append((child, q))
        links.setdefault(child, []).append((parent, attitude.conjugate(q)))
    for name in (base, frame):
        if name not in links:
            raise ValueError(f'/tf_static has no frame {name!r}; the nearest is '
                             f'{nearest(name, links)!r}; expected it, or mounting.source given')
    known, queue = {base: attitude.IDENTITY}, [base]
    for name in queue:
        for other, q in links[name]:
            if other not in known:
                known[other] = attitude.multiply(known[name], q)
                queue.append(other)
    if frame not in known:
        raise ValueError(f'/tf_static does not connect {base!r} with {frame!r}; expected a chain '
                         'of transforms, or mounting.source given')
    return known[frame]
