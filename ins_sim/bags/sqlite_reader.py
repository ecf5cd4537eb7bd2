"""Read SQLite files of rosbag2 (.db3), schema versions 1 to 4."""

from pathlib import Path
import sqlite3

import numpy as np

from ins_sim.regular_file import check_regular
from .piece import BagPiece, Channel, split_by_channel

ROWS = 1000
# Limit of operations: a valid file needs about thirty for a message of twenty bytes.
_OPERATIONS_PER_BYTE = 4
_TICK = 100_000


class SqliteReader:
    """
    The messages of one .db3 file, with the attributes of ``McapReader``.

    A file that was not closed is read with its write-ahead log.  Raises ValueError if the file is
    empty, corrupt or not an SQLite bag.
    """

    compression = ['none']

    def __init__(self, path):
        self.path = Path(path)
        check_regular(self.path, 'an SQLite file')
        size = self.path.stat().st_size
        log = self.path.with_name(self.path.name + '-wal')
        logged = log.stat().st_size if log.exists() else 0
        if not size:
            raise ValueError(f'{self.path} is empty; expected an SQLite file')
        with open(self.path, 'rb') as stream:
            if (magic := stream.read(16)) != b'SQLite format 3\x00':
                raise ValueError(f'{self.path} begins with {magic!r}; expected an SQLite file')
        # "immutable" needs neither lock nor further files, so that the folder may be read-only.
        mode = 'mode=ro' if logged else 'immutable=1'
        self._largest = _OPERATIONS_PER_BYTE * (size + logged) + 20 * _TICK
        self._ticks = 0
        try:
            self._database = sqlite3.connect(f'{self.path.absolute().as_uri()}?{mode}', uri=True)
            if hasattr(self._database, 'setlimit'):
                # No value can be longer than the file (needs Python 3.11).
                self._database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, size + logged)
            self._database.set_progress_handler(self._on_tick, _TICK)
        except sqlite3.Error as error:
            raise self._corrupt(error) from None
        self.channels = {c.id: c for c in self._read_channels()}
        self.cut = ''
        if logged:
            self.cut = f'{self.path.name} was not closed: it has a write-ahead log'
        elif self._columns('metadata') and not self._rows('SELECT 1 FROM metadata LIMIT 1'):
            self.cut = f'{self.path.name} was not closed: it has no metadata'

    def _on_tick(self):
        self._ticks += 1
        return self._ticks * _TICK > self._largest

    def _corrupt(self, error):
        why = ' '.join(str(error).split())
        if why == 'interrupted':
            why = 'reading its tables takes too many steps'
        elif why.startswith('Could not decode'):
            # The rest of the row is the text.
            why = 'it contains a text that is not UTF-8'
        return ValueError(f'{self.path} is corrupt: {why}')

    def _rows(self, query, *values):
        return [row for block in self._blocks(query, *values) for row in block]

    def _blocks(self, query, *values):
        """Yield the rows of a query in lists."""
        self._ticks = 0
        try:
            cursor = self._database.execute(query, values)
            while rows := cursor.fetchmany(ROWS):
                yield rows
        except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
            raise self._corrupt(error) from None

    def _columns(self, table):
        return {row[1] for row in self._rows(f'PRAGMA table_info({table})')}

    def _read_channels(self):
        have = self._columns('topics')
        if not {'id', 'name', 'type', 'serialization_format'} <= have or not {
                'topic_id', 'timestamp', 'data'} <= self._columns('messages'):
            raise ValueError(f'{self.path} is not a bag; expected the tables topics and messages '
                             'of rosbag2')
        definitions = {}
        if self._columns('message_definitions'):
            definitions = {row[0]: row[1:] for row in self._rows(
                'SELECT topic_type, encoded_message_definition, encoding FROM '
                'message_definitions ORDER BY id')}
        optional = [name if name in have else "''" for name in
                    ('type_description_hash', 'offered_qos_profiles')]
        for row in self._rows('SELECT id, name, type, serialization_format, '
                              f'{", ".join(optional)} FROM topics ORDER BY id'):
            definition = definitions.get(row[2], ('', 'ros2msg'))
            if [type(x) for x in (*row, *definition)] != [int] + 7 * [str]:
                raise self._corrupt(f'its topic {row[0]!r} has a value of the wrong type')
            number, name, type_name, encoding, type_hash, qos = row
            yield Channel.as_read(number, name, type_name, encoding, *definition, type_hash,
                                  qos)

    def spans(self):
        """Return {channel id: (count, first, last log time)} of the channels with messages."""
        result = {}
        for number, *span in self._rows('SELECT topic_id, COUNT(*), MIN(timestamp), '
                                        'MAX(timestamp) FROM messages GROUP BY topic_id'):
            if [type(x) for x in (number, *span)] != 4 * [int]:
                raise self._corrupt(f'the messages of topic {number!r} have times that are not '
                                    'integers')
            if number not in self.channels:
                raise self._corrupt(f'it has messages of topic {number}, which it does not '
                                    'declare')
            result[number] = tuple(span)
        return result

    def count(self, wanted):
        """Return 0, which means unknown: SQLite counts about as slowly as it reads."""
        return 0

    def pieces(self, wanted):
        """
        Yield (time, position, Piece) by time; later pieces have no earlier messages.

        wanted holds the ids of channels.  Raises ValueError on a corrupt file.
        """
        ids, times = self._times(wanted)
        if (np.diff(times) >= 0).all():
            ordered = self._select(wanted)
        else:
            # The index of the file is not used, because it may contradict its table.
            order = np.argsort(times, kind='stable')
            ordered = self._one_by_one(ids[order].tolist())
        for place, piece in enumerate(ordered):
            yield int(piece.log_ns[0]), place, piece

    def by_channel(self, wanted):
        """Yield (channel id, Piece) of the wanted channels, in the order they were written."""
        for piece in self._select(wanted):
            yield from split_by_channel(piece)

    def _times(self, wanted):
        """Return number and log time of the messages of channels, in the order written."""
        blocks = [np.zeros((0, 2), dtype=np.int64)]
        for rows in self._blocks('SELECT id, timestamp FROM messages NOT INDEXED WHERE topic_id '
                                 f'IN ({_marks(wanted)}) ORDER BY id', *wanted):
            if {type(x) for row in rows for x in row} != {int}:
                raise self._corrupt('a message has a time or data of the wrong type')
            blocks.append(np.array(rows, dtype=np.int64))
        return np.concatenate(blocks).T

    def _select(self, wanted):
        for rows in self._blocks('SELECT topic_id, timestamp, data FROM messages NOT INDEXED '
                                 f'WHERE topic_id IN ({_marks(wanted)}) ORDER BY id', *wanted):
            yield self._piece(rows)

    def _one_by_one(self, ids):
        for first in range(0, len(ids), ROWS):
            rows = [row for number in ids[first:first + ROWS] for row in self._rows(
                'SELECT topic_id, timestamp, data FROM messages WHERE id = ?', number)]
            yield self._piece(rows)

    def _piece(self, rows):
        channel, log_ns, blobs = zip(*rows)
        if set(map(type, log_ns)) != {int} or set(map(type, blobs)) != {bytes}:
            raise self._corrupt('a message has a time or data of the wrong type')
        sizes = np.fromiter(map(len, blobs), np.int64, len(blobs))
        return BagPiece(np.frombuffer(b''.join(blobs), dtype=np.uint8), np.array(channel),
                        np.array(log_ns, dtype=np.int64), np.cumsum(sizes) - sizes, sizes)

    def close(self):
        """Close the file."""
        self._database.close()


def _marks(values):
    return ', '.join('?' * len(values))
