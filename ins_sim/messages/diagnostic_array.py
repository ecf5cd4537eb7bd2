"""Pack and read diagnostic_msgs/DiagnosticArray as bytes, without ROS."""

from dataclasses import dataclass
import struct

from .cdr import aligned_offset, ENCAPSULATION, SECOND, stamp_of

OK, WARN = 0, 1
# Shortest status: a byte and, aligned, the lengths of four strings and of the values.
_SHORTEST = 20


@dataclass(frozen=True)
class Status:
    """A DiagnosticStatus: level (small integer), texts, and values as pairs of key and text."""

    level: int
    name: str
    message: str
    hardware_id: str
    values: tuple = ()


def pack_diagnostics(stamp_ns, frame, statuses):
    """Return the message of a stamp, a frame id and Statuses; the padding is zero."""
    body = bytearray(struct.pack('<iI', *divmod(stamp_ns, SECOND)))

    def put(text):
        data = text.encode() + b'\x00'
        put_number(len(data))
        body.extend(data)

    def put_number(number):
        body.extend(bytes(aligned_offset(len(body), 4) - len(body)) + struct.pack('<I', number))

    put(frame)
    put_number(len(statuses))
    for status in statuses:
        body.append(status.level)
        for text in (status.name, status.message, status.hardware_id):
            put(text)
        put_number(len(status.values))
        for key, value in status.values:
            put(key)
            put(value)
    return ENCAPSULATION + bytes(body)


def read_diagnostics(buffer):
    """Return stamp_ns, frame id and list of Statuses; raise ValueError on an invalid message."""
    try:
        return _read(bytes(buffer))
    except (struct.error, IndexError, UnicodeDecodeError):
        raise ValueError(f'DiagnosticArray of {len(buffer)} bytes ends too early or holds no '
                         'text; expected the statuses that it announces') from None


def _read(buffer):
    stamp_ns = stamp_of(buffer)
    if stamp_ns is None or buffer[:2] != ENCAPSULATION[:2]:
        raise ValueError(f'DiagnosticArray of {len(buffer)} bytes begins with {buffer[:2]!r}; '
                         'expected the encapsulation of little-endian CDR and a stamp')
    offset = 8 + len(ENCAPSULATION)
    nanosec, = struct.unpack_from('<I', buffer, 8)
    if nanosec >= SECOND:
        raise ValueError(f'DiagnosticArray has {nanosec} nanoseconds in its stamp; expected less '
                         'than 1e9')

    def number():
        nonlocal offset
        value, = struct.unpack_from('<I', buffer, aligned_offset(offset, 4))
        offset = aligned_offset(offset, 4) + 4
        return value

    def text():
        nonlocal offset
        length = number()
        offset += length
        if offset > len(buffer):
            raise IndexError
        return buffer[offset - length:offset - 1].decode()

    frame, statuses = text(), []
    for _ in range(_count(number(), _SHORTEST, buffer)):
        level = buffer[offset]
        offset += 1
        texts = text(), text(), text()
        values = [(text(), text()) for _ in range(_count(number(), 8, buffer))]
        statuses.append(Status(level, *texts, tuple(values)))
    return stamp_ns, frame, statuses


def _count(count, size, buffer):
    """Return count if the message can hold so many elements of this size; else raise."""
    if count * size > len(buffer):
        raise IndexError
    return count
