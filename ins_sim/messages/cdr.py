"""
Messages as bytes: the CDR layouts of the messages used here, packed and read without ROS.

Every layout is a stamp, strings, and doubles in one run, in a NavSatFix between a few small
integers.  CDR aligns from behind its encapsulation header of four bytes.  The padding is zero, so
that equal messages are equal bytes.  Source: OMG Data Distribution Service Interoperability Wire
Protocol 2.2, section 10; the ROS 2 Jazzy message definitions.
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
    What a message type holds, in the order of the bytes.

    strings: how many follow the stamp; doubles: how many follow; runs: slices of the doubles
    that a writer takes, the others stay constant; fix: whether it is a NavSatFix, with a byte and
    a 16-bit number (NavSatStatus: status, service) before the doubles and a byte
    (position_covariance_type) behind them.
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
    """Return the first multiple of size at or behind an offset."""
    return (offset + size - 1) // size * size


class Writer:
    """
    Packs messages of one type whose strings and constants are fixed once.

    strings: frame ids; runs: slices (start, stop) of the doubles given with each message, by
    default those of the layout; constants: {index: value} of the other doubles, else zero;
    numbers: status, service and position_covariance_type of a NavSatFix, by default a fix, unknown
    and unknown.  ``dtype`` is the NumPy dtype of a whole message: 'sec', 'nanosec' and 'values0',
    'values1'..., and of a NavSatFix 'status' and 'position_covariance_type'.
    """

    def __init__(self, type_name, *strings, runs=None, constants=None, numbers=(0, 0, 0)):
        layout = LAYOUTS[type_name]
        if len(strings) != layout.strings:
            raise ValueError(f'{type_name} takes {layout.strings} strings, not {len(strings)}')
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
        Return the bytes of one message; values: one sequence of floats for each run.

        Raises ValueError where one of them is not finite.
        """
        buffer, total = self._template, 0.0
        self._stamp(buffer, 4, *divmod(stamp_ns, SECOND))
        for (pack_into, offset), run in zip(self._slots, values):
            pack_into(buffer, offset, *run)
            total += sum(run)
        # of an infinity the difference is no number, and of no number it is none either
        if total - total != 0.0 and not all(math.isfinite(x) for run in values for x in run):
            raise ValueError(f'{self._name} of {stamp_ns / SECOND:.9f} s would hold {values}; '
                             'expected finite numbers; it is not sent')
        return bytes(buffer)

    def block(self, stamps_ns, values=None):
        """
        Return the messages of stamps (n,) and values (n, k) as an array of ``dtype``.

        Raises ValueError for a stamp that a ROS message cannot hold.
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
    """Return the stamp at the head of a message, ns; None if it is too short or big-endian."""
    if len(data) < 12 or data[1] != 1:
        return None
    sec, nanosec = _STAMP(data, 4)
    return sec * SECOND + nanosec


def _middle(offset, layout):
    """Return the offset behind the status of a fix, a byte and a 16-bit number."""
    return aligned_offset(offset + 1, 2) + 2 if layout.fix else offset


class Reader:
    """
    Reads messages of one type, whatever the length of their strings.

    runs: slices (start, stop) of the doubles to return, each as a tuple; by default one tuple
    of all of them.
    """

    def __init__(self, type_name, runs=None):
        self._name = type_name
        self._layout = LAYOUTS[type_name]
        self._runs = ((0, self._layout.doubles),) if runs is None else tuple(runs)
        self._known = {}

    def read(self, buffer):
        """Return stamp_ns and the doubles of each run as tuples; ValueError on a bad buffer."""
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
                             f'{self._layout.doubles} doubles behind its header') from None

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
        """Return the slots of the doubles for these string lengths and remember them."""
        offset = 8
        if self._layout.strings:
            for length in key if isinstance(key, tuple) else (key,):
                offset = aligned_offset(offset, 4) + 4 + length
        offset = _middle(offset, self._layout)
        first = 4 + (aligned_offset(offset, 8) if self._layout.doubles else offset)
        slots = []
        for start, stop in self._runs:
            # the skipped rest is unpacked too, so that a message cut anywhere is found short
            skip = 8 * (self._layout.doubles - stop) + self._layout.fix
            unpack = struct.Struct(f'<{stop - start}d{skip}x').unpack_from
            slots.append((unpack, first + 8 * start))
        if len(self._known) > 100:
            self._known.clear()
        self._known[key] = slots
        return slots


_STAMP = struct.Struct('<iI').unpack_from
_LENGTH = struct.Struct('<I').unpack_from
