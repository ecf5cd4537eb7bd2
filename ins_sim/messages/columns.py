"""
Messages as columns: the named fields of many messages in one NumPy structured array.

The names are those of the ROS messages.  The counterpart for writing is ``cdr.Writer.block``.
"""

from functools import lru_cache

import numpy as np

from .cdr import aligned, LAYOUTS, SECOND

_POSE = (('position', 3), ('orientation', 4), ('pose_covariance', 36))
_TWIST = (('linear', 3), ('angular', 3), ('twist_covariance', 36))

# the doubles of each layout in order, with how many of them a field has
DOUBLES = {
    'std_msgs/msg/Header': (),
    'rosgraph_msgs/msg/Clock': (),
    'sensor_msgs/msg/Imu': (
        ('orientation', 4), ('orientation_covariance', 9), ('angular_velocity', 3),
        ('angular_velocity_covariance', 9), ('linear_acceleration', 3),
        ('linear_acceleration_covariance', 9)),
    'nav_msgs/msg/Odometry': _POSE + _TWIST,
    'sensor_msgs/msg/NavSatFix': (
        ('latitude', 1), ('longitude', 1), ('altitude', 1), ('position_covariance', 9)),
    'geometry_msgs/msg/Vector3Stamped': (('vector', 3),),
    'geometry_msgs/msg/QuaternionStamped': (('quaternion', 4),),
    'geometry_msgs/msg/TwistStamped': _TWIST[:2],
}
TIMES = [('log_ns', '<i8'), ('stamp_ns', '<i8')]


@lru_cache(maxsize=1000)
def message_dtype(type_name, lengths=None):
    """
    Return the dtype of a whole message whose strings take these bytes, with their last zero.

    It has 'sec', 'nanosec', the doubles by name and, in NavSatFix, 'status', 'service' and
    'position_covariance_type'.
    """
    layout = LAYOUTS[type_name]
    offset = 12
    for length in (1,) * layout.strings if lengths is None else lengths:
        # CDR counts from behind the encapsulation of four bytes, a multiple of what it aligns to
        # here, save for doubles
        offset = aligned(offset, 4) + 4 + length
    columns = [('sec', '<i4', 4), ('nanosec', '<u4', 8)]
    if layout.status:
        columns += [('status', '<i1', offset), ('service', '<u2', aligned(offset + 1, 2))]
        offset = aligned(offset + 1, 2) + 2
    if layout.doubles:
        offset = 4 + aligned(offset - 4, 8)
    for name, width in DOUBLES[type_name]:
        columns.append((name, '<f8' if width == 1 else ('<f8', (width,)), offset))
        offset += 8 * width
    if layout.end:
        columns.append(('position_covariance_type', '<u1', offset))
    names, formats, offsets = zip(*columns)
    return np.dtype({'names': names, 'formats': formats, 'offsets': offsets,
                     'itemsize': offset + len(layout.end)})


def column_dtype(type_name, fields=None):
    """
    Return the dtype of ``read``: 'log_ns', 'stamp_ns' and the fields, by default all.

    Raises ValueError for a type without a layout and for an unknown field.
    """
    if type_name not in LAYOUTS:
        raise ValueError(f'messages of type {type_name} cannot be read into arrays; expected '
                         f'one of {", ".join(sorted(LAYOUTS))}')
    whole = message_dtype(type_name)
    known = whole.names[2:]
    for name in fields or ():
        if name not in known:
            raise ValueError(f'{type_name} has no field {name!r}; expected one of '
                             f'{", ".join(known)}')
    return np.dtype(TIMES + [(name, whole[name].base, whole[name].shape)
                             for name in (known if fields is None else fields)])


def read(type_name, data, starts, sizes, dtype):
    """
    Return messages as an array of ``column_dtype``, 'log_ns' left zero.

    data: bytes as uint8; starts and sizes (n,) int64: where in data the messages are.  Raises
    ValueError for a message that is too short or no little-endian CDR.
    """
    out = np.zeros(len(starts), dtype=dtype)
    if not len(starts):
        return out
    for rows, lengths in _by_lengths(type_name, data, starts, sizes):
        whole = message_dtype(type_name, lengths)
        _check_sizes(type_name, sizes[rows], whole.itemsize)
        at, part = starts[rows], out if isinstance(rows, slice) else None
        target = np.zeros(len(at), dtype=dtype) if part is None else part
        sec = _take(data, at, whole, 'sec').astype(np.int64)
        target['stamp_ns'] = sec * SECOND + _take(data, at, whole, 'nanosec')
        for name in dtype.names[2:]:
            target[name] = _take(data, at, whole, name)
        if part is None:
            out[rows] = target
    return out


def strings(type_name, data, starts, sizes):
    """Return the distinct strings (frame ids) of messages: a list of tuples as they appear."""
    found = {}
    if not LAYOUTS[type_name].strings:
        return [()] if len(starts) else []
    for rows, lengths in _by_lengths(type_name, data, starts, sizes):
        at, offset, parts = starts[rows], 12, []
        numbers = np.arange(len(starts))[rows]
        for length in lengths:
            offset = aligned(offset, 4) + 4
            parts.append((offset, length))
            offset += length
        block = _windows(data, offset - 12)[at + 12]
        _, first = np.unique(block, return_index=True)
        for k in first.tolist():
            found[int(numbers[k])] = tuple(
                data[at[k] + a:at[k] + a + n - 1].tobytes().decode(errors='replace')
                for a, n in parts)
    return list(dict.fromkeys(found[k] for k in sorted(found)))


def _windows(data, size):
    """Return every run of size bytes of data as one opaque element, without a copy."""
    return np.ndarray((max(0, len(data) - size + 1),), f'V{size}', data, strides=(1,))


def _take(data, starts, whole, name):
    dtype, offset = whole.fields[name]
    return _windows(data, dtype.itemsize)[starts + offset].view(dtype.base).reshape(
        len(starts), *dtype.shape)


def _by_lengths(type_name, data, starts, sizes):
    """Yield (rows, lengths of the strings) of the messages whose strings are equally long."""
    layout = LAYOUTS[type_name]
    everything = slice(None)
    _check_sizes(type_name, sizes, 12)
    heads = _windows(data, 2)[starts].view('<u2')
    if (bad := heads != 0x0100).any():
        head = int(heads[bad][0]).to_bytes(2, 'little')
        raise ValueError(f'{type_name} begins with {head!r}; expected the encapsulation of '
                         'little-endian CDR')
    if not layout.strings:
        yield everything, ()
        return
    offsets, lengths = np.full(len(starts), 12, dtype=np.int64), []
    for _ in range(layout.strings):
        offsets = (offsets + 3) // 4 * 4
        _check_sizes(type_name, sizes, offsets + 4)
        length = _windows(data, 4)[starts + offsets].view('<u4').astype(np.int64)
        offsets = offsets + 4 + length
        _check_sizes(type_name, sizes, offsets)
        lengths.append(length)
    lengths = np.stack(lengths, axis=1)
    if (lengths == lengths[0]).all():
        yield everything, tuple(lengths[0].tolist())
        return
    keys, group = np.unique(lengths, axis=0, return_inverse=True)
    order = np.argsort(group.ravel(), kind='stable')
    cuts = np.flatnonzero(np.diff(group.ravel()[order])) + 1
    for key, rows in zip(keys.tolist(), np.split(order, cuts)):
        yield rows, tuple(key)


def _check_sizes(type_name, sizes, needed):
    if (short := sizes < needed).any():
        size = int(sizes[short][0])
        raise ValueError(f'{type_name} of {size} bytes ends too early; expected '
                         f'{LAYOUTS[type_name].doubles} doubles behind its header')
