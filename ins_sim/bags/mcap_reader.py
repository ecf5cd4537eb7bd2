"""
Reading MCAP files: the walk from record to record, and the messages of a chunk as columns.

The data section is walked without opening the chunks, which costs little (a chunk holds a
thousand messages) and is the same for whole files, cut ones and such without a summary.
"""

from dataclasses import dataclass, field
import mmap
from pathlib import Path
from zlib import crc32

import numpy as np

from . import mcap_format as form
from .compression import decompress
from .mcap_format import Fields
from .piece import apart, Channel, joined, Piece

_HEAD = np.dtype([('opcode', 'u1'), ('length', '<u8'), ('channel', '<u2'), ('sequence', '<u4'),
                  ('log_ns', '<u8'), ('publish_ns', '<u8')])
_BEHIND_LENGTH = _HEAD.itemsize - form.RECORD.size
LATEST_NS = 2**63 - 1


@dataclass
class _Chunk:
    """Where a chunk is; index {channel: (offset, entries)} of its message index, or None."""

    position: int
    start_ns: int
    size: int
    crc: int
    compression: str
    first: int
    stop: int
    index: dict | None = field(default_factory=dict)


class McapReader:
    """
    The messages of one MCAP file.

    channels {id: Channel}; cut: a sentence saying where a file that was not closed ends, else
    ''; compression: the names of those of its chunks.  Raises ValueError if the file is empty,
    no MCAP, or corrupt.
    """

    STORAGE = 'mcap'

    def __init__(self, path):
        self.path = Path(path)
        with open(self.path, 'rb') as stream:
            self._size = stream.seek(0, 2)
            if not self._size:
                raise ValueError(f'{self.path} is empty; expected an MCAP file')
            self._map = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
        if self._map[:8] != form.MAGIC:
            raise ValueError(f'{self.path} is no MCAP file; it begins with {self._map[:8]!r}')
        self._bytes = np.frombuffer(self._map, dtype=np.uint8)
        self._schemas, self.channels, self._chunks = {}, {}, []
        self._loose, self._scanned, self._expected = [], {}, None
        self.cut = ''
        closed = self._size >= 16 and self._map[-8:] == form.MAGIC
        end = self._walk(closed)
        if closed:
            self._read_summary()
        elif not self.cut:
            self.cut = f'{self.path.name} has no summary'
        if not end and self._chunks:
            # the index behind the last chunk may lack channels
            self._chunks[-1].index = None
        self._look_into_chunks()
        self.compression = sorted({c.compression or 'none' for c in self._chunks} or {'none'})

    def _corrupt(self, position, why):
        return ValueError(f'{self.path} is corrupt at byte {position}: {why}')

    def _walk(self, closed):
        """Find chunks, schemas, channels and loose messages; return whether there is an end."""
        position, size = len(form.MAGIC), self._size
        unpack, head = form.RECORD.unpack_from, form.RECORD.size
        while True:
            if position + head > size:
                break
            opcode, length = unpack(self._map, position)
            body = position + head
            stop = body + length
            if stop > size:
                break
            if opcode == form.MESSAGE:
                if length < _BEHIND_LENGTH:
                    raise self._corrupt(position, 'a message record ends too early')
                self._loose.append(position)
            else:
                try:
                    self._take(opcode, position, body, stop)
                except ValueError as error:
                    raise self._corrupt(position, error) from None
            if opcode in (form.DATA_END, form.FOOTER):
                return True
            position = stop
        if closed:
            raise self._corrupt(position, f'a record of {length} bytes is longer than the file')
        self.cut = (f'{self.path.name} is cut: its last {size - position} of {size} bytes are no '
                    'whole record' if position < size else
                    f'{self.path.name} ends without a summary')
        return False

    def _take(self, opcode, position, body, stop):
        view = memoryview(self._map)[body:stop]
        if opcode == form.CHUNK:
            fields = Fields(view)
            start_ns, _, size, crc = fields.numbers('QQQI')
            compression, data = fields.text(), fields.data('Q')
            if start_ns > LATEST_NS:
                raise ValueError(f'a chunk begins at {start_ns} ns')
            first = stop - fields.left - len(data)
            self._chunks.append(_Chunk(position, start_ns, size, crc, compression, first,
                                       first + len(data)))
        elif opcode == form.MESSAGE_INDEX:
            fields = Fields(view)
            number, = fields.numbers('H')
            entries = fields.data()
            count, rest = divmod(len(entries), form.INDEX_ENTRY.itemsize)
            if rest or not self._chunks:
                raise ValueError('a message index has no whole entries, or no chunk before it')
            if count:
                self._chunks[-1].index[number] = (stop - fields.left - len(entries), count)
        elif opcode == form.SCHEMA:
            self._take_schema(view)
        elif opcode == form.CHANNEL:
            self._take_channel(view)
        elif opcode == 0 or (position == len(form.MAGIC) and opcode != form.HEADER):
            raise ValueError(f'a record has the opcode {opcode}')

    def _take_schema(self, view):
        fields = Fields(view)
        number, = fields.numbers('H')
        name, encoding = fields.text(), fields.text()
        self._schemas[number] = name, encoding, str(fields.data(), 'utf-8', 'replace')

    def _take_channel(self, view):
        fields = Fields(view)
        number, schema = fields.numbers('HH')
        name, encoding, metadata = fields.text(), fields.text(), fields.text_map()
        type_name, definition_encoding, definition = self._schemas.get(schema, ('', '', ''))
        channel = Channel(number, name, type_name, encoding, definition, definition_encoding,
                          metadata.get('topic_type_hash', ''),
                          metadata.get('offered_qos_profiles', ''))
        if self.channels.setdefault(number, channel) != channel:
            raise ValueError(f'channel {number} is declared twice, as {name} and as '
                             f'{self.channels[number].name}')

    def _read_summary(self):
        """Take schemas and channels of the summary; hold its count against what was found."""
        foot = self._size - form.FOOTER_SIZE
        if self._size < form.FOOTER_SIZE + len(form.MAGIC) or \
                form.RECORD.unpack_from(self._map, foot) != (form.FOOTER, form.FOOTER_BODY.size):
            raise self._corrupt(max(0, foot), 'expected a footer')
        start, _, crc = form.FOOTER_BODY.unpack_from(self._map, foot + form.RECORD.size)
        if not start:
            return
        if not len(form.MAGIC) <= start <= foot:
            raise self._corrupt(foot, f'the summary begins at byte {start}')
        if crc and crc32(memoryview(self._map)[start:foot + form.RECORD.size + 16]) != crc:
            raise self._corrupt(start, 'the summary has another checksum')
        position = start
        while position < foot:
            opcode, length = form.RECORD.unpack_from(self._map, position)
            body, stop = position + form.RECORD.size, position + form.RECORD.size + length
            if stop > foot:
                raise self._corrupt(position, 'a record of the summary is too long')
            try:
                if opcode in (form.SCHEMA, form.CHANNEL):
                    self._take(opcode, position, body, stop)
                elif opcode == form.STATISTICS:
                    self._expected, = Fields(memoryview(self._map)[body:stop]).numbers('Q')
            except ValueError as error:
                raise self._corrupt(position, error) from None
            position = stop

    def _look_into_chunks(self):
        """Open the chunks that have no index or unknown channels; count all messages."""
        for chunk in self._chunks:
            if chunk.index is None or not chunk.index or chunk.index.keys() - self.channels:
                piece = self._scan(chunk, self._open(chunk))
                if not chunk.index:
                    chunk.index = None
                    self._scanned[chunk.position] = _spans(piece)
        loose = self._loose_piece()
        if loose is not None:
            self._scanned[-1] = _spans(loose)
        unknown = {number for _, number, _ in self._counted(times=False)} - self.channels.keys()
        if unknown:
            raise ValueError(f'{self.path} is corrupt: it has messages of channel '
                             f'{min(unknown)}, which it does not declare')
        if self._expected is not None:
            found = sum(n for n, _, _ in self._counted(times=False))
            if found != self._expected:
                raise ValueError(f'{self.path} is corrupt: its summary counts {self._expected} '
                                 f'messages, its chunks hold {found}')

    def _counted(self, times=True):
        """Yield (count, channel, (first, last) log time or None) of every chunk and channel."""
        for spans in self._scanned.values():
            for number, (count, first, last) in spans.items():
                yield count, number, (first, last)
        for chunk in self._chunks:
            for number, (offset, count) in (chunk.index or {}).items():
                span = None
                if times:
                    log_ns = np.frombuffer(self._map, form.INDEX_ENTRY, count, offset)['log_ns']
                    span = int(log_ns.min()), int(log_ns.max())
                yield count, number, span

    def count(self, wanted):
        """Return how many messages of channels there are, if that is known at once."""
        return sum(n for n, number, _ in self._counted(times=False) if number in wanted)

    def spans(self):
        """Return {channel id: (count, first, last log time)} of the channels with messages."""
        result = {}
        for count, number, (first, last) in self._counted():
            known = result.get(number, (0, first, last))
            result[number] = known[0] + count, min(known[1], first), max(known[2], last)
        return result

    def pieces(self, wanted):
        """
        Yield (time before which no later piece has messages, place in the file, Piece).

        wanted: ids of channels.  Raises ValueError for a corrupt chunk.
        """
        for chunk, own in self._by_chunk(wanted, lambda c: (c.start_ns, c.position)):
            pieces = [piece for _, piece in own]
            if pieces:
                piece = joined(pieces)
                if piece.log_ns.min() < chunk.start_ns:
                    raise self._corrupt(chunk.position, f'a chunk that begins at '
                                        f'{chunk.start_ns} ns has a message of '
                                        f'{piece.log_ns.min()} ns')
                order = np.argsort(piece.starts, kind='stable')
                yield chunk.start_ns, chunk.position, piece[order]

    def by_channel(self, wanted):
        """Yield (channel id, Piece) of the wanted channels, in the order of the file."""
        for _, own in self._by_chunk(wanted, lambda c: c.position):
            yield from own

    def _by_chunk(self, wanted, key):
        """Yield (chunk, pairs of channel id and Piece) of the chunks, sorted by a key."""
        loose = self._loose_piece()
        if loose is not None:
            yield _Chunk(0, 0, 0, 0, '', 0, 0), (x for x in apart(loose) if x[0] in wanted)
        for chunk in sorted(self._chunks, key=key):
            if chunk.index is None:
                piece = self._scan(chunk, self._open(chunk))
                yield chunk, (x for x in apart(piece) if x[0] in wanted)
                continue
            own = [number for number in wanted if number in chunk.index]
            if own:
                raw = self._open(chunk)
                yield chunk, ((n, self._indexed(chunk, raw, n)) for n in own)

    def _open(self, chunk):
        """Return the bytes of a chunk."""
        try:
            raw = decompress(memoryview(self._map)[chunk.first:chunk.stop], chunk.compression,
                             chunk.size)
            if chunk.crc and crc32(raw) != chunk.crc:
                raise ValueError('it has another checksum')
            if not chunk.compression:
                chunk.crc = 0  # what is mapped need not be checked twice
        except ValueError as error:
            raise self._corrupt(chunk.position, f'a chunk cannot be read: {error}') from None
        return np.frombuffer(raw, dtype=np.uint8)

    def _indexed(self, chunk, raw, number):
        """Return the Piece of a channel by the message index."""
        offset, count = chunk.index[number]
        entries = np.frombuffer(self._map, form.INDEX_ENTRY, count, offset)
        if entries['start'].max() + _HEAD.itemsize > len(raw):
            raise self._corrupt(chunk.position, 'a message index points behind its chunk')
        piece, heads = self._piece(chunk.position, raw, entries['start'].astype(np.int64))
        if (heads['opcode'] != form.MESSAGE).any() or (piece.channel != number).any() or \
                (heads['log_ns'] != entries['log_ns']).any():
            raise self._corrupt(chunk.position, 'a message index does not fit its chunk')
        return piece

    def _piece(self, position, data, starts):
        windows = np.ndarray((max(0, len(data) - _HEAD.itemsize + 1),), f'V{_HEAD.itemsize}',
                             data, strides=(1,))
        heads = windows[starts].view(_HEAD)
        length = heads['length']
        room = (len(data) - starts - form.RECORD.size).astype(np.uint64)
        if (length < _BEHIND_LENGTH).any() or (length > room).any():
            raise self._corrupt(position, 'a message is longer than its chunk')
        if (heads['log_ns'] > LATEST_NS).any():
            raise self._corrupt(position, 'a message has a log time of 2^63 ns or more')
        return Piece(data, heads['channel'].astype(np.int64), heads['log_ns'].astype(np.int64),
                     starts + _HEAD.itemsize, length.astype(np.int64) - _BEHIND_LENGTH), heads

    def _scan(self, chunk, raw):
        """Return the Piece of all messages of a chunk, found by walking through it."""
        position, starts, data, size = 0, [], memoryview(raw), len(raw)
        unpack, head = form.RECORD.unpack_from, form.RECORD.size
        while position < size:
            if position + head > size:
                raise self._corrupt(chunk.position, 'the last record of a chunk is cut')
            opcode, length = unpack(data, position)
            stop = position + head + length
            if stop > size or (opcode == form.MESSAGE and length < _BEHIND_LENGTH):
                raise self._corrupt(chunk.position, 'a record is longer than its chunk')
            if opcode == form.MESSAGE:
                starts.append(position)
            else:
                try:
                    if opcode == form.SCHEMA:
                        self._take_schema(data[position + head:stop])
                    elif opcode == form.CHANNEL:
                        self._take_channel(data[position + head:stop])
                except ValueError as error:
                    raise self._corrupt(chunk.position, error) from None
            position = stop
        return self._piece(chunk.position, raw, np.array(starts, dtype=np.int64))[0]

    def _loose_piece(self):
        """Return the messages outside of chunks, or None."""
        if not self._loose:
            return None
        return self._piece(self._loose[0], self._bytes,
                           np.array(self._loose, dtype=np.int64))[0]

    def close(self):
        """Let go of the file; arrays and messages that were read stay."""
        self._map = self._bytes = None


def _spans(piece):
    """Return {channel: (count, first, last log time)} of a Piece."""
    return {number: (len(own), int(own.log_ns.min()), int(own.log_ns.max()))
            for number, own in apart(piece)}
