"""Mounting of a sensor in the vehicle: the quaternion q_bs from the sensor's frame to b."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics import elementary
from ins_sim.settings.suggest import nearest_name


def levelled_mounting(force, yaw):
    """Return q_bs: the shortest turn that brings a force (3,) up, then one by yaw about up."""
    x, y, z = force.tolist()
    size, level = math.sqrt(x * x + y * y + z * z), math.sqrt(x * x + y * y)
    # upside down any level axis will do
    axis, length = ((y, -x, 0.0), level) if level > 1e-12 * size else ((1.0, 0.0, 0.0), 1.0)
    scale = elementary.atan2(level, z) / length
    return quaternion.multiply(quaternion.exponential((0.0, 0.0, yaw)),
                               quaternion.exponential(tuple(scale * a for a in axis)))


def chained_mounting(transforms, base, frame):
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
        links.setdefault(child, []).append((parent, quaternion.conjugate(q)))
    for name in (base, frame):
        if name not in links:
            raise ValueError(f'/tf_static has no frame {name!r}; the nearest is '
                             f'{nearest_name(name, links)!r}; expected it, or mounting.source '
                             'given')
    known, queue = {base: quaternion.IDENTITY}, [base]
    for name in queue:
        for other, q in links[name]:
            if other not in known:
                known[other] = quaternion.multiply(known[name], q)
                queue.append(other)
    if frame not in known:
        raise ValueError(f'/tf_static does not connect {base!r} with {frame!r}; expected a chain '
                         'of transforms, or mounting.source given')
    return known[frame]
