"""
Pack and read messages as bytes in CDR (Common Data Representation), without ROS.

Every layout used here consists of a stamp, strings, and one sequence of doubles; a NavSatFix also
has a few small integers.  CDR aligns relative to the end of its encapsulation header of four
bytes.  The padding is zero, so that equal messages are equal bytes.  Source: OMG Data Distribution
Service Interoperability Wire Protocol 2.2, section 10; the ROS 2 Jazzy message definitions.
"""

from dataclasses import dataclass
import math
import struct

import numpy as np

ENCAPSULATION = b'\x00\x01\x00\x00'
SECOND = 1_000_000_000
STAMP_END_NS = 2**31 * SECOND


@dataclass(frozen=True)
class Layout:
    """
    Content of a message type, in the order of the bytes.

    Attributes
    ----------
    strings : number of strings after the stamp
    doubles : number of doubles after the strings
    runs : slices of the doubles that a writer sets with each message; the others are constant
    fix : whether it is a NavSatFix, with status and service (8 and 16 bits) before the doubles and
        position_covariance_type (8 bits) after them
    """

    strings: int
    doubles: int
    runs: tuple = ()
    fix: bool = False


LAYOUTS = {
    'std_msgs/msg/Header': Layout(1, 0),
    'rosgraph_msgs/msg/Clock': Layout(0, 0),
    'sensor_msgs/msg/Imu': Layout(1, 37, ((0, 4), (13, 16), (25, 28))),
    'nav_msgs/msg/Odometry': Layout(2, 85, ((0, 7), (43, 49))),
    'sensor_msgs/msg/NavSatFix': Layout(1, 12, ((0, 3),), True),
    'sensor_msgs/msg/MagneticField': Layout(1, 12, ((0, 3),)),
    'sensor_msgs/msg/FluidPressure': Layout(1, 2, ((0, 1),)),
    'geometry_msgs/msg/Vector3Stamped': Layout(1, 3, ((0, 3),)),
    'geometry_msgs/msg/QuaternionStamped': Layout(1, 4, ((0, 4),)),
    'geometry_msgs/msg/TwistStamped': Layout(1, 6, ((0, 6),)),
    'geometry_msgs/msg/TwistWithCovarianceStamped': Layout(1, 42, ((0, 6),)),
}


def aligned_offset(offset, size):
    """Return the first multiple of size that is not less than an offset."""
    return (offset + size - 1) // size * size


class Writer:
    """
    Packs messages of one type with fixed strings and constants.

    ``dtype`` is the NumPy dtype of a whole message, with the fields 'sec', 'nanosec', 'values0',
    'values1', ... and, for a NavSatFix, 'status' and 'position_covariance_type'.

    Parameters
    ----------
    type_name : message type
    strings : frame ids
    runs : slices (start, stop) of the doubles given with each message; default: of the layout
    constants : {index: value} of other doubles; the rest is zero
    numbers : status, service and position_covariance_type of a NavSatFix; default: fix, unknown,
        unknown
    """

    def __init__(self, type_name, *strings, runs=None, constants=None, numbers=(0, 0, 0)):
        layout = LAYOUTS[type_name]
        if len(strings) != layout.strings:
            raise ValueError(f'{type_name} has {layout.strings} strings, not {len(strings)}')
        self._name = type_name
        self.runs = layout.runs if runs is None else tuple(runs)
        body = bytearray(8)
        for text in strings:
            body += bytes(aligned_offset(len(body), 4) - len(body))
            data = text.encode() + b'\x00'
            body += struct.pack('<I', len(data)) + data
        status_at = len(ENCAPSULATION) + len(body)
        if layout.fix:
            body += struct.pack('<b', numbers[0])
            body += bytes(aligned_offset(len(body), 2) - len(body)) + struct.pack('<H', numbers[1])
        if layout.doubles:
            body += bytes(aligned_offset(len(body), 8) - len(body))
        first = len(ENCAPSULATION) + len(body)
        doubles = [0.0] * layout.doubles
        for index, value in (constants or {}).items():
            doubles[index] = value
        body += struct.pack(f'<{layout.doubles}d', *doubles)
        if layout.fix:
            body += struct.pack('<B', numbers[2])
        self._template = bytearray(ENCAPSULATION + body)
        self._stamp = struct.Struct('<iI').pack_into
        self._slots = [(struct.Struct(f'<{b - a}d').pack_into, first + 8 * a)
                       for a, b in self.runs]
        self._ends = np.cumsum([0] + [b - a for a, b in self.runs]).tolist()
        columns = [('sec', '<i4', 4), ('nanosec', '<u4', 8),
                   *((f'values{k}', ('<f8', (b - a,)), first + 8 * a)
                     for k, (a, b) in enumerate(self.runs))]
        if layout.fix:
            columns += [('status', '<i1', status_at),
                        ('position_covariance_type', '<u1', len(self._template) - 1)]
        names, formats, offsets = zip(*columns)
        self.dtype = np.dtype({'names': names, 'formats': formats, 'offsets': offsets,
                               'itemsize': len(self._template)})

    def pack(self, stamp_ns, *values):
        """
        Return the bytes of one message; values are one sequence of floats for each run.

        Raises ValueError if a value is not finite.
        """
        buffer, total = self._template, 0.0
        self._stamp(buffer, 4, *divmod(stamp_ns, SECOND))
        for (pack_into, offset), run in zip(self._slots, values):
            pack_into(buffer, offset, *run)
            total += sum(run)
        # The difference of an infinity, or of a NaN, to itself is NaN.
        if total - total != 0.0 and not all(math.isfinite(x) for run in values for x in run):
            raise ValueError(f'{self._name} of {stamp_ns / SECOND:.9f} s would hold {values}; '
                             'expected finite numbers; the message is not sent')
        return bytes(buffer)

    def block(self, stamps_ns, values=None):
        """
        Return the messages of stamps (n,) and values (n, k) as an array of ``dtype``.

        Raises ValueError if a stamp does not fit into a ROS message.
        """
        stamps_ns = np.asarray(stamps_ns, dtype=np.int64)
        if len(stamps_ns) and not -STAMP_END_NS <= stamps_ns.min() <= stamps_ns.max() < \
                STAMP_END_NS:
            raise ValueError(f'a stamp is {stamps_ns[np.abs(stamps_ns).argmax()] / SECOND:.9g} s; '
                             f'expected less than {STAMP_END_NS // SECOND} s, which a ROS stamp '
                             'can hold')
        row = np.frombuffer(bytes(self._template), dtype=np.uint8)
        rows = np.empty((len(stamps_ns), len(row)), dtype=np.uint8)
        rows[:] = row
        messages = rows.view(self.dtype)[:, 0]
        messages['sec'], messages['nanosec'] = np.divmod(stamps_ns, SECOND)
        for k, (a, b) in enumerate(zip(self._ends, self._ends[1:])):
            messages[f'values{k}'] = values[:, a:b]
        return messages

    def pack_block(self, stamps_ns, values=None):
        """Return the messages of stamps (n,) and values (n, k) as a list of bytes."""
        data = self.block(stamps_ns, values).tobytes()
        size = self.dtype.itemsize
        return [data[k:k + size] for k in range(0, len(data), size)]


def stamp_of(data):
    """Return the stamp of a message, ns; None if it is too short or big-endian."""
    if len(data) < 12 or data[1] != 1:
        return None
    sec, nanosec = _STAMP(data, 4)
    return sec * SECOND + nanosec


def _middle(offset, layout):
    """Return the offset after status and service of a fix."""
    return aligned_offset(offset + 1, 2) + 2 if layout.fix else offset


class Reader:
    """
    Reads messages of one type with strings of any length.

    runs: slices (start, stop) of the doubles; each slice is returned as a tuple. By default one
    tuple contains all doubles.
    """

    def __init__(self, type_name, runs=None):
        self._name = type_name
        self._layout = LAYOUTS[type_name]
        self._runs = ((0, self._layout.doubles),) if runs is None else tuple(runs)
        self._known = {}

    def read(self, buffer):
        """Return stamp_ns and a tuple for each run; raise ValueError on an invalid message."""
        try:
            if buffer[:2] != b'\x00\x01':
                raise ValueError(f'{self._name} begins with {bytes(buffer[:2])!r}; expected the '
                                 'encapsulation of little-endian CDR')
            sec, nanosec = _STAMP(buffer, 4)
            if nanosec >= SECOND:
                raise ValueError(f'{self._name} has {nanosec} nanoseconds in its stamp; expected '
                                 'less than 1e9')
            key = self._lengths(buffer)
            slots = self._known.get(key) or self._find(key)
            stamp_ns = sec * SECOND + nanosec
            return (stamp_ns, *[unpack(buffer, offset) for unpack, offset in slots])
        except struct.error:
            raise ValueError(f'{self._name} of {len(buffer)} bytes ends too early; expected '
                             f'{self._layout.doubles} doubles after its header') from None

    def strings(self, buffer):
        """Return the strings (frame ids) of a message as a tuple."""
        texts, offset = [], 12
        self.read(buffer)
        for _ in range(self._layout.strings):
            offset = aligned_offset(offset, 4)
            length, = _LENGTH(buffer, offset)
            texts.append(bytes(buffer[offset + 4:offset + 3 + length]).decode(errors='replace'))
            offset += 4 + length
        return tuple(texts)

    def numbers(self, buffer):
        """Return status, service and position_covariance_type of a NavSatFix."""
        self.read(buffer)
        offset = 16 + _LENGTH(buffer, 12)[0]
        status, = struct.unpack_from('<b', buffer, offset)
        offset = aligned_offset(offset + 1, 2)
        service, = struct.unpack_from('<H', buffer, offset)
        offset = 4 + aligned_offset(offset - 2, 8) + 8 * self._layout.doubles
        return status, service, buffer[offset]

    def _lengths(self, buffer):
        if not self._layout.strings:
            return 0
        first, = _LENGTH(buffer, 12)
        if self._layout.strings == 1:
            return first
        return first, _LENGTH(buffer, aligned_offset(16 + first, 4))[0]

    def _find(self, key):
        """Find and store the unpacking of the doubles for these string lengths."""
        offset = 8
        if self._layout.strings:
            for length in key if isinstance(key, tuple) else (key,):
                offset = aligned_offset(offset, 4) + 4 + length
        offset = _middle(offset, self._layout)
        first = 4 + (aligned_offset(offset, 8) if self._layout.doubles else offset)
        slots = []
        for start, stop in self._runs:
            # The unused rest is unpacked too, so that any truncated message is detected.
            skip = 8 * (self._layout.doubles - stop) + self._layout.fix
            unpack = struct.Struct(f'<{stop - start}d{skip}x').unpack_from
            slots.append((unpack, first + 8 * start))
        if len(self._known) > 100:
            self._known.clear()
        self._known[key] = slots
        return slots


_STAMP = struct.Struct('<iI').unpack_from
_LENGTH = struct.Struct('<I').unpack_from
