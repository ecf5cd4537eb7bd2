"""Mounting of a sensor in the vehicle: the quaternion q_bs from the sensor frame to b."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics import elementary
from ins_sim.settings.suggest import nearest_name

# Shorter quaternions define no rotation; a norm that differs from 1 by more than _UNIT is noted.
_LEAST, _UNIT = 1e-3, 1e-6


def levelled_mounting(force, yaw):
    """Return q_bs: the shortest rotation of a force (3,) to up, then a yaw about up."""
    x, y, z = force.tolist()
    size, level = math.sqrt(x * x + y * y + z * z), math.sqrt(x * x + y * y)
    # If the force points down, any level axis gives the shortest rotation.
    axis, length = ((y, -x, 0.0), level) if level > 1e-12 * size else ((1.0, 0.0, 0.0), 1.0)
    scale = elementary.atan2(level, z) / length
    return quaternion.multiply(quaternion.exponential((0.0, 0.0, yaw)),
                               quaternion.exponential(tuple(scale * a for a in axis)))


def chained_mounting(transforms, base, frame, notes=None):
    """
    Return q_bs from static transforms, or None if there are no transforms at all.

    Parameters
    ----------
    transforms : {(parent, child): q}, q of any norm maps child to parent as in TF
    base, frame : names of the frames b and s
    notes : list to which remarks on the transforms are appended

    Raises
    ------
    ValueError : naming the most similar known frame if one of the frames is unknown; also if the
        frames are in different trees, or if a transform between them is not a rotation

    """
    if not transforms:
        return None
    links = {}
    for parent, child in transforms:
        links.setdefault(parent, []).append((child, (parent, child)))
        links.setdefault(child, []).append((parent, (parent, child)))
    for name in (base, frame):
        if name not in links:
            raise ValueError(f'/tf_static has no frame {name!r}; the nearest is '
                             f'{nearest_name(name, links)!r}; expected this frame, or '
                             'mounting.source given')
    ways, queue = {base: []}, [base]
    for name in queue:
        for other, link in links[name]:
            if other not in ways:
                ways[other] = [*ways[name], link]
                queue.append(other)
    if frame not in ways:
        raise ValueError(f'/tf_static does not connect {base!r} with {frame!r}; expected a chain '
                         'of transforms, or mounting.source given')
    q_bs, at, notes = quaternion.IDENTITY, base, [] if notes is None else notes
    for parent, child in ways[frame]:
        q = _rotation(transforms[parent, child], f'{parent} to {child}', notes)
        forwards = at == parent
        q_bs = quaternion.multiply(q_bs, q if forwards else quaternion.conjugate(q))
        at = child if forwards else parent
    return q_bs


def _rotation(q, name, notes):
    """Return the unit quaternion of a transform, with a note if needed; reject a non-rotation."""
    x, y, z, w = q
    size = math.sqrt(x * x + y * y + z * z + w * w)
    if not (math.isfinite(size) and size > _LEAST):
        raise ValueError(f'/tf_static from {name} has the rotation '
                         f'({x:g}, {y:g}, {z:g}, {w:g}), which is not a rotation; expected a unit '
                         'quaternion, or mounting.source given with mounting.rpy_deg')
    if abs(size - 1.0) <= _UNIT:
        return q
    notes.append(f'/tf_static from {name} has a quaternion of length {size:.9g}: normalised')
    return x / size, y / size, z / size, w / size
