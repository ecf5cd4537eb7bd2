"""Read bags: topics as arrays, or messages in the order of their log times."""

from dataclasses import dataclass
import heapq
from pathlib import Path
import re

import numpy as np

from ins_sim.messages import columns
from ins_sim.settings.suggest import nearest_name
from . import metadata
from .mcap_reader import McapReader
from .piece import in_log_order
from .sqlite_reader import SqliteReader
from .storages import ROS_1, SUFFIXES

READERS = {'mcap': McapReader, 'sqlite3': SqliteReader}


def open_bag(path) -> 'BagReader':
    """
    Return the BagReader of a bag: a folder with or without metadata.yaml, or one of its files.

    Raises ValueError if it is not a bag or cannot be read, and OSError if it does not exist or
    access is denied.
    """
    return BagReader(path)


@dataclass(frozen=True)
class Span:
    """Number of messages, and first and last log time, ns (None without messages)."""

    count: int = 0
    first_ns: int | None = None
    last_ns: int | None = None


class BagReader:
    """
    A bag.  Use it as a context manager, or close it.

    Topic names may be given without the leading slash.

    Attributes
    ----------
    topics : {name: Channel}, in the order of declaration
    files : paths of the files
    storage : 'mcap' or 'sqlite3'
    compression : names of the compressions of the chunks
    cut : '' or a sentence that says why the bag is not complete
    odd_stamps : {topic read: number of stamps whose nanosec is a second or more}
    """

    def __init__(self, path):
        self.path = Path(path)
        self.cut, self.odd_stamps = '', {}
        if self.path.is_dir():
            self.storage, self.files = self._find_files()
        else:
            self.storage, self.files = _storage(self.path), [self.path]
        self._parts = []
        try:
            for file in self.files:
                self._parts.append(READERS[self.storage](file))
        except BaseException:
            self.close()
            raise
        self.cut = '; '.join(filter(None, [self.cut, *(part.cut for part in self._parts)]))
        self.compression = sorted({name for part in self._parts for name in part.compression})
        self.topics = {}
        for part in self._parts:
            for channel in part.channels.values():
                known = self.topics.setdefault(channel.name, channel)
                if known.type_name != channel.type_name:
                    raise ValueError(f'{self.path} has {channel.name} with two types, '
                                     f'{known.type_name} and {channel.type_name}; expected one')

    def _find_files(self):
        info = metadata.read_metadata(self.path)
        if info is not None:
            files = [self.path / name for name in info.files]
            for file in files:
                if not file.exists():
                    raise ValueError(f'{self.path} lacks {file.name}, which is listed in its '
                                     f'{metadata.NAME}')
            return info.storage, files
        files = sorted((f for f in self.path.iterdir() if f.suffix in SUFFIXES), key=_number)
        storages = {_storage(f) for f in files}
        if len(storages) != 1:
            raise ValueError(f'{self.path} is not a bag; expected {metadata.NAME}, or files of '
                             f'{" or ".join(SUFFIXES)}')
        self.cut = f'it was not closed: there is no {metadata.NAME}'
        return storages.pop(), files

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.close()

    def close(self):
        """Close the files; arrays that were read stay valid."""
        for part in self._parts:
            part.close()
        self._parts = []

    def topic(self, name):
        """Return the Channel of a topic; raise ValueError, with the nearest name, if missing."""
        if name not in self.topics:
            name = '/' + name.lstrip('/')
        if name not in self.topics:
            raise ValueError(f'{self.path} has no topic {name}; ' + (
                f'the nearest is {nearest_name(name, self.topics)}' if self.topics else
                'it has no topics'))
        return self.topics[name]

    def spans(self):
        """Return {topic: Span} of all topics."""
        result = dict.fromkeys(self.topics, Span())
        for part in self._parts:
            for number, (count, first, last) in part.spans().items():
                name = part.channels[number].name
                known = result[name]
                if known.count:
                    first, last = min(first, known.first_ns), max(last, known.last_ns)
                result[name] = Span(count + known.count, first, last)
        return result

    def arrays(self, name, fields=None, type_name=None):
        """
        Return the messages of a topic as a structured array in the order of the log times.

        Parameters
        ----------
        name : topic name
        fields : fields of the message by their ROS names (``messages.columns``), such as
            'angular_velocity', which is (n, 3); None for all
        type_name : expected message type, or None

        Returns
        -------
        structured array (n,) with 'log_ns' and 'stamp_ns' (int64) and the fields

        Raises
        ------
        ValueError
            If the topic is missing or its type is not the expected one or not supported, or if a
            message cannot be read.
        """
        name = self._readable(name, type_name).name
        return self.tables({name: fields})[name]

    def tables(self, wanted):
        """
        Return {topic: array} of several topics, given as {topic: fields or None}.

        They are read in one pass.  Arrays and errors are those of ``arrays``.
        """
        tables, channels, odd = {}, {}, {}
        for name, fields in wanted.items():
            channel = self._readable(name, None)
            channels[channel.name] = channel
            count = sum(part.count(_ids(part, [channel.name])) for part in self._parts)
            tables[channel.name] = _Table(count, columns.column_dtype(channel.type_name, fields))
        for part in self._parts:
            for number, piece in part.by_channel(_ids(part, channels)):
                name = part.channels[number].name
                out = tables[name].more(piece.log_ns)
                odd[name] = odd.get(name, 0) + self._checked(channels[name],
                                                             columns.read_columns, piece, out)
        self.odd_stamps.update(odd)
        return {name: table.in_order() for name, table in zip(wanted, tables.values())}

    def frames(self, name):
        """Return the distinct strings (frame ids) of a topic's messages, a list of tuples."""
        return list(self.frame_counts(name))

    def frame_counts(self, name):
        """Return {strings (frame ids): number of messages of a topic that have them}."""
        channel = self._readable(name, None)
        columns.column_dtype(channel.type_name)
        found = {}
        for _, piece in self.pieces([channel.name]):
            for texts, count in self._checked(channel, columns.count_strings, piece).items():
                found[texts] = found.get(texts, 0) + count
        return found

    def _readable(self, name, type_name):
        channel = self.topic(name)
        if type_name is not None and channel.type_name != type_name:
            raise ValueError(f'{self.path}: {channel.name} has the type {channel.type_name}; '
                             f'expected {type_name}')
        if channel.encoding != 'cdr':
            raise ValueError(f'{self.path}: {channel.name} is serialized as '
                             f'{channel.encoding!r}; expected cdr')
        return channel

    def _checked(self, channel, function, piece, *more):
        try:
            return function(channel.type_name, piece.data, piece.starts, piece.sizes, *more)
        except ValueError as error:
            raise ValueError(f'{self.path}: {channel.name}: {error}') from None

    def pieces(self, names=None):
        """
        Yield (topic, Piece) of topics, by default all, in the order of the files.

        Raises ValueError if a topic is unknown or a file is corrupt.
        """
        names = self._names(names)
        for part in self._parts:
            for number, piece in part.by_channel(_ids(part, names)):
                yield part.channels[number].name, piece

    def _names(self, names):
        return self.topics if names is None else [self.topic(name).name for name in names]

    def messages(self, names=None):
        """
        Yield (topic, log_ns, data) in the order of the log times, data as bytes.

        names are the topics, by default all.  Raises ValueError if a topic is unknown or a file
        is corrupt.
        """
        names = self._names(names)
        return heapq.merge(*(self._part_messages(part, names) for part in self._parts),
                           key=lambda message: message[1])

    def _part_messages(self, part, names):
        pieces = part.pieces(_ids(part, names))
        of = {number: channel.name for number, channel in part.channels.items()}
        for number, log_ns, data in in_log_order(pieces):
            yield of[number], log_ns, data


class _Table:
    """A growing structured array that records whether its log times ascend."""

    def __init__(self, expected, dtype):
        self._rows, self._filled = np.empty(expected, dtype=dtype), 0
        self._ascends, self._last_ns = True, None

    def more(self, log_ns):
        """Return new rows for messages with these log times, to be filled by the caller."""
        first, self._filled = self._filled, self._filled + len(log_ns)
        if self._filled > len(self._rows):
            rows = np.empty(max(self._filled, 2 * len(self._rows)), dtype=self._rows.dtype)
            rows[:first] = self._rows[:first]
            self._rows = rows
        if len(log_ns):
            self._ascends &= bool((np.diff(log_ns) >= 0).all()) and (
                self._last_ns is None or self._last_ns <= log_ns[0])
            self._last_ns = log_ns[-1]
        out = self._rows[first:self._filled]
        out['log_ns'] = log_ns
        return out

    def in_order(self):
        """Return the rows in the order of the log times."""
        rows = self._rows[:self._filled]
        if not self._ascends:
            rows = rows[np.argsort(rows['log_ns'], kind='stable')]
        return rows


def _ids(part, names):
    return [number for number, channel in part.channels.items() if channel.name in names]


def _storage(path):
    storage = SUFFIXES.get(path.suffix)
    if path.suffix == ROS_1 and path.exists():
        raise ValueError(f'{path} is a bag of ROS 1; expected a rosbag2 bag (convert it with '
                         '"rosbags-convert" of the Python package rosbags)')
    if storage is None:
        if path.suffix == '.zstd':
            raise ValueError(f'{path} is compressed as a file; expected one of '
                             f'{", ".join(SUFFIXES)} (unpack it with "zstd -d")')
        if not path.exists():
            raise FileNotFoundError(f'{path} does not exist; expected a bag')
        raise ValueError(f'{path} is not a bag; expected a folder or one of {", ".join(SUFFIXES)}')
    return storage


def _number(path):
    """Return the sort key of a file, which puts bag_2 before bag_10."""
    return [int(word) if word.isdigit() else word for word in re.split(r'(\d+)', path.name)]
