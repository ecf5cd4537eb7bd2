"""
Pack and read the MCAP records that occur in ROS 2 bags.

Source: MCAP format specification, version 0 (mcap.dev/spec).  Integers are little-endian; a
record consists of an opcode, the 64-bit length of its content, and the content.
"""

import struct

import numpy as np

MAGIC = b'\x89MCAP0\r\n'
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END = range(11, 16)

RECORD = struct.Struct('<BQ')
# Opcode and length of a message record, channel, sequence, log time, publish time.
MESSAGE_HEAD = struct.Struct('<BQHIQQ')
CHUNK_HEAD = struct.Struct('<QQQI')
FOOTER_BODY = struct.Struct('<QQI')
FOOTER_SIZE = RECORD.size + FOOTER_BODY.size + len(MAGIC)
INDEX_ENTRY = np.dtype([('log_ns', '<u8'), ('start', '<u8')])


def record(opcode, body):
    """Return the bytes of a record: opcode, length and content (body)."""
    return RECORD.pack(opcode, len(body)) + body


def text(value):
    """Return the bytes of a string (str or bytes), which begin with its length."""
    data = value.encode() if isinstance(value, str) else value
    return struct.pack('<I', len(data)) + data


def text_map(pairs):
    """Return the bytes of a map of strings, from pairs (key, value)."""
    return text(b''.join(text(key) + text(value) for key, value in pairs))


def number_map(pairs):
    """Return the bytes of a map of 16-bit to 64-bit numbers, from pairs (key, value)."""
    return text(b''.join(struct.pack('<HQ', key, value) for key, value in pairs))


class Fields:
    """
    Reads the fields of a record one after another.

    Raises ValueError if the record ends too early or a string is not UTF-8.
    """

    def __init__(self, data):
        self._data = memoryview(data)
        self._at = 0

    def numbers(self, form):
        """Return the next numbers; form is their format as in ``struct``, without byte order."""
        reader = struct.Struct('<' + form)
        if self._at + reader.size > len(self._data):
            raise ValueError('it ends too early')
        values = reader.unpack_from(self._data, self._at)
        self._at += reader.size
        return values

    def data(self, form='I'):
        """Return the next bytes as a view; form is the format of the length before them."""
        size, = self.numbers(form)
        start, self._at = self._at, self._at + size
        if self._at > len(self._data):
            raise ValueError('it ends too early')
        return self._data[start:self._at]

    def text(self):
        """Return the next field, a string."""
        try:
            return str(self.data(), 'utf-8')
        except UnicodeDecodeError:
            raise ValueError('it contains a string that is not UTF-8') from None

    def text_map(self):
        """Return the next field, a map of strings, as a dict."""
        inner, pairs = Fields(self.data()), {}
        while inner.left:
            key = inner.text()
            pairs[key] = inner.text()
        return pairs

    @property
    def left(self):
        """Return the number of bytes that are not read yet."""
        return len(self._data) - self._at
