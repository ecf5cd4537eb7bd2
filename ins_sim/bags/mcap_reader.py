"""Read MCAP files: the messages of their chunks as columns."""

from zlib import crc32

import numpy as np

from . import mcap_format as form
from .compression import compression_library, decompress, MODULES
from .mcap_index import BEHIND_LENGTH, Chunk, LATEST_NS, McapIndex
from .piece import BagPiece, join_pieces, split_by_channel
from .records import HEAD


class McapReader(McapIndex):
    """
    The messages of one MCAP file; compression lists the compressions of its chunks.

    Raises ValueError as McapIndex, and for messages of undeclared channels.
    """

    def __init__(self, path):
        super().__init__(path)
        self._scanned = {}
        # Import the decompression library here; later its absence would be reported as a corrupt
        # chunk.
        for name in {chunk.compression for chunk in self.chunks} & MODULES.keys():
            try:
                compression_library(name)
            except ValueError as error:
                raise ValueError(f'{self.path} cannot be read: {error}') from None
        self._look_into_chunks()
        self.compression = sorted({c.compression or 'none' for c in self.chunks} or {'none'})

    def _look_into_chunks(self):
        """Open the chunks without index or with unknown channels; count all messages."""
        if self.cut and self.chunks:
            # After a crash of the machine the last chunk can have its full length but no data.
            try:
                self._scan(self.chunks[-1], self._open(self.chunks[-1]))
            except ValueError as error:
                del self.chunks[-1]
                self.cut += f'; its last chunk is left out ({error})'
        for chunk in self.chunks:
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
        if self.expected is not None:
            found = sum(n for n, _, _ in self._counted(times=False))
            if found != self.expected:
                raise ValueError(f'{self.path} is corrupt: its summary counts {self.expected} '
                                 f'messages, its chunks contain {found}')

    def _counted(self, times=True):
        """Yield (count, channel, (first, last) log time or None) for every chunk and channel."""
        for spans in self._scanned.values():
            for number, (count, first, last) in spans.items():
                yield count, number, (first, last)
        for chunk in self.chunks:
            for number, (offset, count) in (chunk.index or {}).items():
                span = None
                if times:
                    log_ns = np.frombuffer(self.mapped, form.INDEX_ENTRY, count, offset)['log_ns']
                    span = int(log_ns.min()), int(log_ns.max())
                yield count, number, span

    def count(self, wanted):
        """Return the number of messages of channels, if it is known without reading."""
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
        Yield (time, position in the file, Piece) by time; later pieces have no earlier messages.

        wanted holds the ids of channels.  Raises ValueError on a corrupt chunk.
        """
        for chunk, own in self._by_chunk(wanted, lambda c: (c.start_ns, c.position)):
            pieces = [piece for _, piece in own]
            if pieces:
                piece = join_pieces(pieces)
                if piece.log_ns.min() < chunk.start_ns:
                    raise self.corrupt(chunk.position, f'a chunk that begins at {chunk.start_ns} '
                                       f'ns has a message of {piece.log_ns.min()} ns')
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
            pieces = (x for x in split_by_channel(loose) if x[0] in wanted)
            yield Chunk(0, 0, 0, 0, '', 0, 0), pieces
        for chunk in sorted(self.chunks, key=key):
            if chunk.index is None:
                piece = self._scan(chunk, self._open(chunk))
                yield chunk, (x for x in split_by_channel(piece) if x[0] in wanted)
                continue
            own = [number for number in wanted if number in chunk.index]
            if own:
                raw = self._open(chunk)
                yield chunk, ((n, self._indexed(chunk, raw, n)) for n in own)
                if self.mapped is not None:
                    # The message indices follow the chunk.
                    self.give_back(chunk.first, max(
                        offset + count * form.INDEX_ENTRY.itemsize
                        for offset, count in chunk.index.values()))

    def _open(self, chunk):
        """Return the bytes of a chunk."""
        try:
            raw = decompress(memoryview(self.mapped)[chunk.first:chunk.stop], chunk.compression,
                             chunk.size)
            if chunk.crc and crc32(raw) != chunk.crc:
                raise ValueError('its checksum is wrong')
            if not chunk.compression:
                chunk.crc = 0  # The mapped bytes have now been verified; skip this next time.
        except ValueError as error:
            raise self.corrupt(chunk.position, f'a chunk cannot be read: {error}') from None
        return np.frombuffer(raw, dtype=np.uint8)

    def _indexed(self, chunk, raw, number):
        """Return the Piece of a channel, found by the message index."""
        offset, count = chunk.index[number]
        entries = np.frombuffer(self.mapped, form.INDEX_ENTRY, count, offset)
        if entries['start'].max() + HEAD.itemsize > len(raw):
            raise self.corrupt(chunk.position, 'a message index points beyond its chunk')
        piece, heads = self._piece(chunk.position, raw, entries['start'].astype(np.int64))
        if (heads['opcode'] != form.MESSAGE).any() or (piece.channel != number).any() or \
                (heads['log_ns'] != entries['log_ns']).any():
            raise self.corrupt(chunk.position, 'a message index does not fit its chunk')
        return piece

    def _piece(self, position, data, starts):
        windows = np.ndarray((max(0, len(data) - HEAD.itemsize + 1),), f'V{HEAD.itemsize}',
                             data, strides=(1,))
        heads = windows[starts].view(HEAD)
        length = heads['length']
        room = (len(data) - starts - form.RECORD.size).astype(np.uint64)
        if (length < BEHIND_LENGTH).any() or (length > room).any():
            raise self.corrupt(position, 'a message is longer than its chunk')
        if (heads['log_ns'] > LATEST_NS).any():
            raise self.corrupt(position, 'a message has a log time of 2^63 ns or more')
        return BagPiece(data, heads['channel'].astype(np.int64), heads['log_ns'].astype(np.int64),
                        starts + HEAD.itemsize, length.astype(np.int64) - BEHIND_LENGTH), heads

    def _scan(self, chunk, raw):
        """Return the Piece of all messages of a chunk, found by reading its records."""
        position, starts, data, size = 0, [], memoryview(raw), len(raw)
        unpack, head = form.RECORD.unpack_from, form.RECORD.size
        while position < size:
            if position + head > size:
                raise self.corrupt(chunk.position, 'the last record of a chunk is incomplete')
            opcode, length = unpack(data, position)
            stop = position + head + length
            if stop > size or (opcode == form.MESSAGE and length < BEHIND_LENGTH):
                raise self.corrupt(chunk.position, 'a record is longer than its chunk')
            if opcode == form.MESSAGE:
                starts.append(position)
            else:
                try:
                    if opcode == form.SCHEMA:
                        self.take_schema(data[position + head:stop])
                    elif opcode == form.CHANNEL:
                        self.take_channel(data[position + head:stop])
                except ValueError as error:
                    raise self.corrupt(chunk.position, error) from None
            position = stop
        return self._piece(chunk.position, raw, np.array(starts, dtype=np.int64))[0]

    def _loose_piece(self):
        """Return the messages outside of chunks, or None."""
        if not self.loose:
            return None
        return self._piece(self.loose[0], np.frombuffer(self.mapped, dtype=np.uint8),
                           np.array(self.loose, dtype=np.int64))[0]

    def close(self):
        """Close the file; arrays and messages that were read stay valid."""
        self.mapped = None


def _spans(piece):
    """Return {channel: (count, first, last log time)} of a Piece."""
    return {number: (len(own), int(own.log_ns.min()), int(own.log_ns.max()))
            for number, own in split_by_channel(piece)}
