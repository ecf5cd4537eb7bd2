"""Write MCAP files: whole chunks and their indices from arrays."""

from contextlib import suppress
import os
import struct
from zlib import crc32

import numpy as np

from . import mcap_format as form
from .compression import compress

SUFFIX = '.mcap'
LIBRARY = 'ins_sim'


class McapWriter:
    """
    One MCAP file, in which appended messages can be read immediately.

    path must not exist; compression is 'lz4', 'zstd' or ''.  Schemas and channels precede the
    chunks, which hold only messages.  The content depends on no clock and no random number.
    """

    def __init__(self, path, compression):
        self._compression = compression
        self._file = open(path, 'xb', buffering=0)
        self.size = 0
        self._schemas, self._channels, self._counts = {}, {}, {}
        self._indices = []
        self._first_ns, self._last_ns = None, None
        self._put(form.MAGIC, form.record(form.HEADER, form.text('ros2') + form.text(LIBRARY)))

    def _put(self, *parts):
        """Write all parts, or restore the file and raise OSError."""
        parts = [memoryview(part) for part in parts]
        start, left = self.size, sum(part.nbytes for part in parts)
        try:
            while left:
                written = os.writev(self._file.fileno(), parts)
                left -= written
                self.size += written
                while parts and written >= parts[0].nbytes:
                    written -= parts.pop(0).nbytes
                if written:
                    parts[0] = parts[0][written:]
        except OSError:
            self.size = start
            with suppress(OSError):
                self._file.truncate(start)
            raise

    def add_topic(self, channel):
        """Declare a Channel and the schema of its type."""
        schema = self._schemas.get(channel.type_name)
        if schema is None:
            number = len(self._schemas) + 1
            schema = form.record(form.SCHEMA, struct.pack('<H', number) + form.text(
                channel.type_name) + form.text(channel.definition_encoding)
                + form.text(channel.definition))
            self._put(schema)
            self._schemas[channel.type_name] = schema
        number = list(self._schemas).index(channel.type_name) + 1
        record = form.record(form.CHANNEL, struct.pack('<HH', channel.id, number) + form.text(
            channel.name) + form.text(channel.encoding) + form.text_map([
                ('offered_qos_profiles', channel.qos), ('topic_type_hash', channel.type_hash)]))
        self._put(record)
        self._channels[channel.id], self._counts[channel.id] = record, 0

    def append(self, records):
        """Write Records as one chunk with its message indices."""
        data = records.data
        first, last = int(records.log_ns.min()), int(records.log_ns.max())
        packed = compress(data, self._compression)
        tail = form.text(self._compression) + struct.pack('<Q', len(packed))
        head = form.CHUNK_HEAD.pack(first, last, len(data), crc32(data)) + tail
        length = len(head) + len(packed)
        position = self.size + form.RECORD.size + length
        indices, offsets = [], []
        order = np.argsort(records.channel, kind='stable')
        channel = records.channel[order]
        entries = np.empty(len(order), dtype=form.INDEX_ENTRY)
        entries['log_ns'], entries['start'] = records.log_ns[order], records.starts[order]
        cuts = [0, *(np.flatnonzero(np.diff(channel)) + 1).tolist(), len(order)]
        for a, b in zip(cuts, cuts[1:]):
            number, content = int(channel[a]), entries[a:b].tobytes()
            offsets.append((number, position))
            indices.append(form.record(form.MESSAGE_INDEX,
                                       struct.pack('<HI', number, len(content)) + content))
            position += len(indices[-1])
        start = self.size
        self._put(form.RECORD.pack(form.CHUNK, length) + head, packed, *indices)
        for (number, _), a, b in zip(offsets, cuts, cuts[1:]):
            self._counts[number] += b - a
        self._first_ns = first if self._first_ns is None else min(first, self._first_ns)
        self._last_ns = last if self._last_ns is None else max(last, self._last_ns)
        self._indices.append(form.record(form.CHUNK_INDEX, struct.pack(
            '<QQQQ', first, last, start, form.RECORD.size + length) + form.number_map(offsets)
            + struct.pack('<Q', sum(map(len, indices))) + form.text(self._compression)
            + struct.pack('<QQ', len(packed), len(data))))

    def close(self, metadata):
        """Write the metadata of rosbag2 (YAML) and the summary, and close the file."""
        position = self.size
        kept = form.record(form.METADATA, form.text('rosbag2') + form.text_map([
            ('serialized_metadata', metadata)]))
        end = form.record(form.DATA_END, struct.pack('<I', 0))
        groups = [
            (form.SCHEMA, b''.join(self._schemas.values())),
            (form.CHANNEL, b''.join(self._channels.values())),
            (form.CHUNK_INDEX, b''.join(self._indices)),
            (form.METADATA_INDEX, form.record(form.METADATA_INDEX, struct.pack(
                '<QQ', position, len(kept)) + form.text('rosbag2'))),
            (form.STATISTICS, self._statistics()),
        ]
        start = at = position + len(kept) + len(end)
        summary, offsets = b'', b''
        for opcode, content in groups:
            if content:
                offsets += form.record(form.SUMMARY_OFFSET, struct.pack('<BQQ', opcode, at,
                                                                        len(content)))
                summary += content
                at += len(content)
        foot = form.RECORD.pack(form.FOOTER, form.FOOTER_BODY.size) + struct.pack('<QQ', start, at)
        crc = crc32(summary + offsets + foot)
        self._put(kept, end, summary, offsets, foot, struct.pack('<I', crc), form.MAGIC)
        self._file.close()

    def _statistics(self):
        return form.record(form.STATISTICS, struct.pack(
            '<QHIIIIQQ', sum(self._counts.values()), len(self._schemas), len(self._channels), 0, 1,
            len(self._indices), self._first_ns or 0, self._last_ns or 0)
            + form.number_map(self._counts.items()))

    def abort(self):
        """Close the file as it is."""
        self._file.close()
