"""
Pack and read messages of type tf2_msgs/msg/TFMessage, without ROS.

A pose is that of the child frame in the parent frame: three coordinates, m, and the quaternion
(x, y, z, w) from child to parent.
"""

import math
import struct

from ins_sim.core.attitude import quaternion
from .cdr import aligned_offset, ENCAPSULATION, SECOND

_LENGTH_OF = struct.Struct('<I')
_LENGTH = _LENGTH_OF.unpack_from
_STAMP = struct.Struct('<iI')
_DOUBLES = struct.Struct('<7d')
# Serialization may pad the last four bytes of a message.
_MOST_PADDING = 3
AT_PARENT = (0.0, 0.0, 0.0, *quaternion.IDENTITY)


class TransformWriter:
    """
    Packs TFMessages with fixed frames.

    pairs are (parent, child) of each transform of a message.
    """

    def __init__(self, *pairs):
        body = bytearray(_LENGTH_OF.pack(len(pairs)))
        self._places = []
        for pair in pairs:
            _align(body, 4)
            stamp = len(body)
            body += bytes(_STAMP.size)
            for text in pair:
                _align(body, 4)
                name = text.encode() + b'\x00'
                body += _LENGTH_OF.pack(len(name)) + name
            _align(body, 8)
            self._places.append((len(ENCAPSULATION) + stamp, len(ENCAPSULATION) + len(body)))
            body += bytes(_DOUBLES.size)
        self._buffer = bytearray(ENCAPSULATION + body)

    def pack(self, stamp_ns, *poses):
        """Return the bytes of a message; raise ValueError if a pose is not finite."""
        for (stamp, first), pose in zip(self._places, poses, strict=True):
            if not math.isfinite(sum(pose)):
                raise ValueError(f'a transform of {stamp_ns / SECOND:.9f} s would hold {pose}; '
                                 'expected finite numbers; the message is not sent')
            _STAMP.pack_into(self._buffer, stamp, *divmod(stamp_ns, SECOND))
            _DOUBLES.pack_into(self._buffer, first, *pose)
        return bytes(self._buffer)


def _align(body, size):
    """Pad a body to a multiple of a size."""
    body += bytes(aligned_offset(len(body), size) - len(body))


def pose_between(pose, other):
    """Return A B^-1, the pose of a frame whose child has the pose A, and B (other) in it."""
    turn = quaternion.multiply(pose[3:], quaternion.conjugate(other[3:]))
    moved = quaternion.rotate(turn, other[:3])
    return (pose[0] - moved[0], pose[1] - moved[1], pose[2] - moved[2], *turn)


def first_stamp(data):
    """Return the stamp of the first transform of a TFMessage, ns; None without a valid one."""
    try:
        (_, _, stamp_ns, _), *_ = read_transforms(data)
    except ValueError:
        # Not a TFMessage, or one without transforms.
        return None
    return stamp_ns


def read_rotations(data):
    """
    Return the frames and rotations of a TFMessage.

    Parameters
    ----------
    data : bytes of the message, little-endian CDR

    Returns
    -------
    list of (parent frame, child frame, quaternion (x, y, z, w) from child to parent)

    Raises
    ------
    ValueError : the bytes are not a TFMessage
    """
    return [(parent, child, pose[3:]) for parent, child, _, pose in read_transforms(data)]


def read_transforms(data):
    """
    Return the transforms of a TFMessage.

    Parameters
    ----------
    data : bytes of the message, little-endian CDR

    Returns
    -------
    list of (parent frame, child frame, stamp in ns, pose)

    Raises
    ------
    ValueError : the bytes are not a TFMessage
    """
    if data[:2] != ENCAPSULATION[:2]:
        raise ValueError(f'it begins with {bytes(data[:2])!r}; expected the encapsulation of '
                         'little-endian CDR')
    # CDR aligns relative to the end of the encapsulation header.
    body = memoryview(data)[len(ENCAPSULATION):]
    try:
        count, = _LENGTH(body, 0)
        found, offset = [], 4
        for _ in range(count):
            offset = aligned_offset(offset, 4)
            sec, nanosec = _STAMP.unpack_from(body, offset)
            parent, offset = _string(body, offset + _STAMP.size)
            child, offset = _string(body, aligned_offset(offset, 4))
            offset = aligned_offset(offset, 8)
            pose = _DOUBLES.unpack_from(body, offset)
            offset += _DOUBLES.size
            found.append((parent, child, sec * SECOND + nanosec, pose))
    except struct.error:
        raise ValueError(f'it ends too early, after {len(data)} bytes') from None
    if len(body) - offset > _MOST_PADDING:
        raise ValueError(f'it has {len(body) - offset} bytes after its last transform')
    return found


def _string(body, offset):
    """Return the string at an offset, and the offset of its end."""
    length, = _LENGTH(body, offset)
    stop = offset + 4 + length
    if stop > len(body):
        raise ValueError(f'a frame has {length} bytes, which is more than the message has')
    # The length includes a terminating zero.
    return bytes(body[offset + 4:stop - 1]).decode(), stop
