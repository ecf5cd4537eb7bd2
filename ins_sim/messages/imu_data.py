"""Build imu/data from a message of imu/data_raw and an orientation."""

import struct

from .cdr import aligned_offset, SECOND

_DOUBLES = struct.Struct('<13d').pack_into
_STAMP = struct.Struct('<iI').pack_into
_LENGTH = struct.Struct('<I').unpack_from


def with_orientation(raw, stamp_ns, orientation, covariance):
    """
    Return an Imu message, bytes, with another stamp, orientation and its covariance.

    raw is a message that was read before; orientation is x, y, z, w; covariance has nine numbers,
    rad^2.
    """
    message = bytearray(raw)
    _STAMP(message, 4, *divmod(stamp_ns, SECOND))
    _DOUBLES(message, 4 + aligned_offset(12 + _LENGTH(raw, 12)[0], 8), *orientation, *covariance)
    return bytes(message)
