"""
Index an MCAP file by reading record after record, without decompressing chunks.

This is fast (a chunk holds a thousand messages) and works for complete files, truncated ones and
files without a summary.
"""

from dataclasses import dataclass, field
import mmap
from pathlib import Path
from zlib import crc32

from ins_sim.regular_file import check_regular
from . import mcap_format as form
from .mcap_format import Fields
from .piece import Channel

# Least length of a message record: channel, sequence, log time and publish time.
BEHIND_LENGTH = form.MESSAGE_HEAD.size - form.RECORD.size
LATEST_NS = 2**63 - 1
# Number of bytes that are read before their memory pages are released.
HELD_BYTES = 1 << 25


@dataclass
class Chunk:
    """Position of a chunk, and its message index {channel: (offset, entries)} or None."""

    position: int
    start_ns: int
    size: int
    crc: int
    compression: str
    first: int
    stop: int
    index: dict | None = field(default_factory=dict)


class McapIndex:
    """
    One MCAP file.

    Attributes: channels {id: Channel}; chunks; loose, the positions of messages outside of
    chunks; expected, the number of messages according to the summary, or None; cut, a sentence on
    where an unclosed file ends, else ''.  Raises ValueError if the file is empty, not MCAP, or
    corrupt.
    """

    def __init__(self, path):
        self.path = Path(path)
        check_regular(self.path, 'an MCAP file')
        with open(self.path, 'rb') as stream:
            self._size = stream.seek(0, 2)
            if not self._size:
                raise ValueError(f'{self.path} is empty; expected an MCAP file')
            self.mapped = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
        if self.mapped[:8] != form.MAGIC:
            raise ValueError(f'{self.path} begins with {self.mapped[:8]!r}; expected an MCAP file')
        self._schemas, self.channels, self.chunks = {}, {}, []
        self.loose, self.expected = [], None
        self.cut = ''
        closed = self._size >= 16 and self.mapped[-8:] == form.MAGIC
        end = self._walk(closed)
        if closed:
            self._read_summary()
        elif not self.cut:
            self.cut = f'{self.path.name} has no summary'
        if not end and self.chunks:
            # The message index of the last chunk may lack channels.
            self.chunks[-1].index = None

    def corrupt(self, position, why):
        """Return the error of a corrupt file."""
        return ValueError(f'{self.path} is corrupt at byte {position}: {why}')

    def give_back(self, start, stop):
        """Release the memory of a part of the file; it is read again when needed."""
        start -= start % mmap.PAGESIZE
        if hasattr(mmap, 'MADV_DONTNEED'):
            self.mapped.madvise(mmap.MADV_DONTNEED, start, stop - start)

    def _walk(self, closed):
        """Find chunks, schemas, channels and loose messages; return whether the file is closed."""
        position, size = len(form.MAGIC), self._size
        held = 0
        unpack, head = form.RECORD.unpack_from, form.RECORD.size
        while True:
            if position + head > size:
                break
            opcode, length = unpack(self.mapped, position)
            body = position + head
            stop = body + length
            if stop > size:
                break
            if opcode == form.MESSAGE:
                if length < BEHIND_LENGTH:
                    raise self.corrupt(position, 'a message record ends too early')
                self.loose.append(position)
            else:
                try:
                    self._take(opcode, position, body, stop)
                except ValueError as error:
                    raise self.corrupt(position, error) from None
            if opcode in (form.DATA_END, form.FOOTER):
                return True
            position = stop
            if position - held > HELD_BYTES:
                self.give_back(held, position)
                held = position
        if closed:
            raise self.corrupt(position, f'a record of {length} bytes is longer than the file')
        self.cut = (f'{self.path.name} is incomplete: its last {size - position} of {size} bytes '
                    'are not a complete record' if position < size else
                    f'{self.path.name} ends without a summary')
        return False

    def _take(self, opcode, position, body, stop):
        view = memoryview(self.mapped)[body:stop]
        if opcode == form.CHUNK:
            fields = Fields(view)
            start_ns, _, size, crc = fields.numbers('QQQI')
            compression, data = fields.text(), fields.data('Q')
            if start_ns > LATEST_NS:
                raise ValueError(f'a chunk begins at {start_ns} ns; expected less than 2^63 ns')
            first = stop - fields.left - len(data)
            self.chunks.append(Chunk(position, start_ns, size, crc, compression, first,
                                     first + len(data)))
        elif opcode == form.MESSAGE_INDEX:
            fields = Fields(view)
            number, = fields.numbers('H')
            entries = fields.data()
            count, rest = divmod(len(entries), form.INDEX_ENTRY.itemsize)
            if rest or not self.chunks:
                raise ValueError('a message index has an incomplete entry, or no chunk before it')
            if count:
                self.chunks[-1].index[number] = (stop - fields.left - len(entries), count)
        elif opcode == form.SCHEMA:
            self.take_schema(view)
        elif opcode == form.CHANNEL:
            self.take_channel(view)
        elif opcode == 0 or (position == len(form.MAGIC) and opcode != form.HEADER):
            raise ValueError(f'a record has the opcode {opcode}')

    def take_schema(self, view):
        """Store a schema record."""
        fields = Fields(view)
        number, = fields.numbers('H')
        name, encoding = fields.text(), fields.text()
        self._schemas[number] = name, encoding, str(fields.data(), 'utf-8', 'replace')

    def take_channel(self, view):
        """Store a channel record; raise ValueError if another one has the same number."""
        fields = Fields(view)
        number, schema = fields.numbers('HH')
        name, encoding, metadata = fields.text(), fields.text(), fields.text_map()
        type_name, definition_encoding, definition = self._schemas.get(schema, ('', '', ''))
        channel = Channel.as_read(number, name, type_name, encoding, definition,
                                  definition_encoding, metadata.get('topic_type_hash', ''),
                                  metadata.get('offered_qos_profiles', ''))
        if self.channels.setdefault(number, channel) != channel:
            raise ValueError(f'channel {number} is declared twice, as {channel.name} and as '
                             f'{self.channels[number].name}')

    def _read_summary(self):
        """Read schemas, channels and the message count of the summary."""
        foot = self._size - form.FOOTER_SIZE
        if self._size < form.FOOTER_SIZE + len(form.MAGIC) or \
                form.RECORD.unpack_from(self.mapped, foot) != (form.FOOTER, form.FOOTER_BODY.size):
            raise self.corrupt(max(0, foot), 'expected a footer')
        start, _, crc = form.FOOTER_BODY.unpack_from(self.mapped, foot + form.RECORD.size)
        if not start:
            return
        if not len(form.MAGIC) <= start <= foot:
            raise self.corrupt(foot, f'the summary begins at byte {start}; expected a position '
                               'before the footer')
        if crc and crc32(memoryview(self.mapped)[start:foot + form.RECORD.size + 16]) != crc:
            raise self.corrupt(start, 'the checksum of the summary is wrong')
        position = start
        while position < foot:
            opcode, length = form.RECORD.unpack_from(self.mapped, position)
            body, stop = position + form.RECORD.size, position + form.RECORD.size + length
            if stop > foot:
                raise self.corrupt(position, 'a record of the summary is too long')
            try:
                if opcode in (form.SCHEMA, form.CHANNEL):
                    self._take(opcode, position, body, stop)
                elif opcode == form.STATISTICS:
                    self.expected, = Fields(memoryview(self.mapped)[body:stop]).numbers('Q')
            except ValueError as error:
                raise self.corrupt(position, error) from None
            position = stop
