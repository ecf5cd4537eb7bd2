"""Messages of type tf2_msgs/msg/TFMessage: any number of transforms, each with two frames."""

import struct

from .cdr import aligned_offset, ENCAPSULATION

_LENGTH = struct.Struct('<I').unpack_from
_STAMP_SIZE = 8
_DOUBLES = struct.Struct('<7d')
# Serialization may fill up the last four bytes of a message.
_MOST_PADDING = 3


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
    if data[:2] != ENCAPSULATION[:2]:
        raise ValueError(f'it begins with {bytes(data[:2])!r}; expected the encapsulation of '
                         'little-endian CDR')
    # CDR aligns relative to the byte behind the encapsulation.
    body = memoryview(data)[len(ENCAPSULATION):]
    try:
        count, = _LENGTH(body, 0)
        found, offset = [], 4
        for _ in range(count):
            parent, offset = _string(body, aligned_offset(offset, 4) + _STAMP_SIZE)
            child, offset = _string(body, aligned_offset(offset, 4))
            offset = aligned_offset(offset, 8)
            quaternion = _DOUBLES.unpack_from(body, offset)[3:]
            offset += _DOUBLES.size
            found.append((parent, child, quaternion))
    except struct.error:
        raise ValueError(f'it ends too early, after {len(data)} bytes') from None
    if len(body) - offset > _MOST_PADDING:
        raise ValueError(f'it has {len(body) - offset} bytes behind its last transform')
    return found


def _string(body, offset):
    """Return the string at an offset, and the offset behind it."""
    length, = _LENGTH(body, offset)
    stop = offset + 4 + length
    if stop > len(body):
        raise ValueError(f'a frame has {length} bytes, which is more than there are')
    # The length includes a terminating zero.
    return bytes(body[offset + 4:stop - 1]).decode(), stop
