"""
Read the fields of many messages into one NumPy structured array.

The field names are those of the ROS messages.  The counterpart for writing is
``cdr.Writer.block``.
"""

from functools import lru_cache

import numpy as np

from .cdr import aligned_offset, LAYOUTS, SECOND

_POSE = (('position', 3), ('orientation', 4), ('pose_covariance', 36))
_TWIST = (('linear', 3), ('angular', 3), ('twist_covariance', 36))

# Fields of the doubles of each layout in order, with the number of doubles of each field.
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
    'sensor_msgs/msg/MagneticField': (
        ('magnetic_field', 3), ('magnetic_field_covariance', 9)),
    'sensor_msgs/msg/FluidPressure': (('fluid_pressure', 1), ('variance', 1)),
    'geometry_msgs/msg/Vector3Stamped': (('vector', 3),),
    'geometry_msgs/msg/QuaternionStamped': (('quaternion', 4),),
    'geometry_msgs/msg/TwistStamped': _TWIST[:2],
    'geometry_msgs/msg/TwistWithCovarianceStamped': _TWIST,
}
TIMES = [('log_ns', '<i8'), ('stamp_ns', '<i8')]


_HEAD = np.dtype([('encapsulation', '<u2'), ('options', '<u2'), ('sec', '<i4'),
                  ('nanosec', '<u4')])
_LITTLE_ENDIAN = 0x0100


@lru_cache(maxsize=1000)
def message_dtype(type_name, lengths=None):
    """
    Return the dtype of a message whose strings have these lengths, terminating zero included.

    Its fields are the doubles by name and, for NavSatFix, 'status', 'service' and
    'position_covariance_type'.
    """
    layout = LAYOUTS[type_name]
    offset = _HEAD.itemsize
    for length in (1,) * layout.strings if lengths is None else lengths:
        offset = aligned_offset(offset, 4) + 4 + length
    columns, small = [], []
    if layout.fix:
        small = [('status', '<i1', offset), ('service', '<u2', aligned_offset(offset + 1, 2))]
        offset = aligned_offset(offset + 1, 2) + 2
    if layout.doubles:
        # CDR offsets count from the end of the encapsulation header of four bytes.
        offset = 4 + aligned_offset(offset - 4, 8)
    for name, width in DOUBLES[type_name]:
        columns.append((name, '<f8' if width == 1 else ('<f8', (width,)), offset))
        offset += 8 * width
    if layout.fix:
        small.append(('position_covariance_type', '<u1', offset))
    columns += small
    return np.dtype({'names': [name for name, _, _ in columns],
                     'formats': [form for _, form, _ in columns],
                     'offsets': [at for _, _, at in columns],
                     'itemsize': offset + layout.fix})


def column_dtype(type_name, fields=None):
    """
    Return the dtype of ``read_columns``: 'log_ns', 'stamp_ns' and the fields, by default all.

    Raises ValueError if the type has no layout or a field is unknown.
    """
    if type_name not in LAYOUTS:
        raise ValueError(f'messages of type {type_name} cannot be read into arrays; expected '
                         f'one of {", ".join(sorted(LAYOUTS))}')
    whole = message_dtype(type_name)
    for name in fields or ():
        if name not in whole.names:
            raise ValueError(f'{type_name} has no field {name!r}; expected one of '
                             f'{", ".join(whole.names)}')
    return np.dtype(TIMES + [(name, whole[name].base, whole[name].shape)
                             for name in (whole.names if fields is None else fields)])


def read_columns(type_name, data, starts, sizes, out):
    """
    Read messages into an array of ``column_dtype``, except its 'log_ns'.

    Parameters
    ----------
    type_name : message type
    data : uint8 array with the bytes of the messages
    starts, sizes : (n,) int64, position and size of each message in data
    out : (n,) array of ``column_dtype`` to fill

    Returns
    -------
    number of stamps whose nanosec is a second or more

    Raises
    ------
    ValueError
        If a message is too short or not little-endian CDR.
    """
    odd = 0
    if not len(starts):
        return odd
    for rows, lengths in _by_lengths(type_name, data, starts, sizes):
        whole = message_dtype(type_name, lengths)
        _check_sizes(type_name, sizes[rows], whole.itemsize)
        messages = _Messages(data, starts[rows])
        part = out[rows]
        head = messages.take(0, _HEAD.itemsize).view(_HEAD)
        part['stamp_ns'] = head['sec'].astype(np.int64) * SECOND + head['nanosec']
        odd += int(np.count_nonzero(head['nanosec'] >= SECOND))
        for at, target, size in _runs(whole, out.dtype):
            part.view(target)['run'] = messages.look(at, size)
        if not isinstance(rows, slice):
            out[rows] = part
    return odd


def count_strings(type_name, data, starts, sizes):
    """Return {strings (frame ids): number of messages that have them}, in order of appearance."""
    found = {}
    if not len(starts):
        return {}
    if not LAYOUTS[type_name].strings:
        return {(): len(starts)}
    for rows, lengths in _by_lengths(type_name, data, starts, sizes):
        offset, parts = _HEAD.itemsize, []
        for length in lengths:
            offset = aligned_offset(offset, 4) + 4
            parts.append((offset, max(0, length - 1)))
            offset += length
        texts = _Messages(data, starts[rows]).take(_HEAD.itemsize, offset - _HEAD.itemsize)
        numbers = np.arange(len(starts))[rows]
        _, first, counts = np.unique(texts, return_index=True, return_counts=True)
        for k, count in zip(first.tolist(), counts.tolist()):
            number = int(numbers[k])
            found[number] = tuple(
                data[starts[number] + a:starts[number] + a + n].tobytes().decode(errors='replace')
                for a, n in parts), count
    result = {}
    for k in sorted(found):
        strings, count = found[k]
        result[strings] = result.get(strings, 0) + count
    return result


class _Messages:
    """Read the same byte range of many messages, as (n,) arrays of the raw-bytes dtype V."""

    def __init__(self, data, starts):
        self._data, self._starts = data, starts
        self._step = int(starts[1] - starts[0]) if len(starts) > 1 else 0
        self._regular = bool((np.diff(starts) == self._step).all())

    def look(self, offset, size):
        """Return size bytes of each message; a view if the messages lie at regular steps."""
        if self._regular:
            return np.ndarray(len(self._starts), f'V{size}', self._data,
                              int(self._starts[0]) + offset, (self._step,))
        windows = np.ndarray(len(self._data) - size + 1, f'V{size}', self._data, strides=(1,))
        return windows[self._starts + offset]

    def take(self, offset, size):
        """Return a copy that can be viewed as another dtype of this size."""
        return np.ascontiguousarray(self.look(offset, size))


@lru_cache(maxsize=1000)
def _runs(whole, target):
    """Return (offset in the message, dtype in target, size) of each contiguous group of fields."""
    runs = []
    for name in target.names[2:]:
        dtype, at = whole.fields[name]
        to = target.fields[name][1]
        if runs and (at, to) == (runs[-1][0] + runs[-1][2], runs[-1][1] + runs[-1][2]):
            runs[-1][2] += dtype.itemsize
        else:
            runs.append([at, to, dtype.itemsize])
    return [(at, np.dtype({'names': ['run'], 'formats': [f'V{size}'], 'offsets': [to],
                           'itemsize': target.itemsize}), size) for at, to, size in runs]


def _by_lengths(type_name, data, starts, sizes):
    """Yield (rows, string lengths) for each group of messages with equal string lengths."""
    layout = LAYOUTS[type_name]
    everything = slice(None)
    _check_sizes(type_name, sizes, _HEAD.itemsize)
    messages = _Messages(data, starts)
    heads = messages.take(0, _HEAD.itemsize).view(_HEAD)['encapsulation']
    if (bad := heads != _LITTLE_ENDIAN).any():
        head = int(heads[bad][0]).to_bytes(2, 'little')
        raise ValueError(f'{type_name} begins with {head!r}; expected the encapsulation of '
                         'little-endian CDR')
    offset, lengths = _HEAD.itemsize, []
    for _ in range(layout.strings):
        offset = aligned_offset(offset, 4)
        _check_sizes(type_name, sizes, offset + 4)
        if isinstance(offset, int):
            length = messages.take(offset, 4).view('<u4').astype(np.int64)
        else:
            length = _Messages(data, starts + offset).take(0, 4).view('<u4').astype(np.int64)
        same = isinstance(offset, int) and bool((length == length[0]).all())
        offset = offset + 4 + (int(length[0]) if same else length)
        _check_sizes(type_name, sizes, offset)
        lengths.append(length)
    if isinstance(offset, int):
        yield everything, tuple(int(length[0]) for length in lengths)
        return
    keys, group = np.unique(np.stack(lengths, axis=1), axis=0, return_inverse=True)
    group = group.ravel()
    order = np.argsort(group, kind='stable')
    cuts = np.flatnonzero(np.diff(group[order])) + 1
    for key, rows in zip(keys.tolist(), np.split(order, cuts)):
        yield rows, tuple(key)


def _check_sizes(type_name, sizes, needed):
    if (short := sizes < needed).any():
        size = int(sizes[short][0])
        raise ValueError(f'{type_name} of {size} bytes ends too early; expected '
                         f'{LAYOUTS[type_name].doubles} doubles after its header')
