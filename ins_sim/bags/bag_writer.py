"""Write bags, from single messages of a recorder or from blocks of simulated messages."""

from contextlib import contextmanager
from pathlib import Path

import numpy as np

from ins_sim.own_folders.own_folder import check_free, OwnFolder
from . import mcap_format as form
from . import mcap_writer, metadata, qos, sqlite_writer
from .compression import compression_library, NAMES
from .definitions import message_definition
from .log_clocks import LogClocks
from .piece import Channel
from .records import arrange_records, fill_records, Records

WRITERS = {'mcap': (mcap_writer.McapWriter, mcap_writer.SUFFIX),
           'sqlite3': (sqlite_writer.SqliteWriter, sqlite_writer.SUFFIX)}
# Suffixes of the files that SQLite keeps next to a database.
COMPANIONS = {mcap_writer.SUFFIX: (), sqlite_writer.SUFFIX: ('-wal', '-shm', '-journal')}
CHUNK_BYTES = 1 << 21
# Span of log time after which a chunk is written, so that little is lost if the process is killed.
CHUNK_NS = 1_000_000_000
# Such a chunk has at least this many messages, even if log times of two clocks alternate.
CHUNK_LEAST = 64
LATEST_NS = 2**63 - 1


class BagWriter:
    """
    A bag that is being written.  Use it as a context manager, or close it.

    The bag is written in place, with metadata.yaml last; without it the bag is incomplete but
    readable.  With replace, an existing bag stays until the new one in ``folder`` is complete.

    Parameters
    ----------
    path : folder of the bag
    storage : 'mcap' or 'sqlite3'
    compression : compression of MCAP chunks: 'none', 'lz4' or 'zstd'
    split_bytes, split_ns : size, or span of log time (``log_clocks``), at which a new file begins
    replace : replace an existing bag instead of raising ValueError

    Raises ValueError if the bag exists, and OSError if it cannot be written.
    """

    def __init__(self, path, storage='mcap', compression='none', replace=False, split_bytes=None,
                 split_ns=None):
        check_target(path, storage, compression, replace)
        self._own = OwnFolder(path, replace, in_place=True)
        self.path, self.storage = Path(path), storage
        self._compression = '' if compression == 'none' else compression
        self._split_bytes = split_bytes
        self._clocks = None if split_ns is None else LogClocks(split_ns)
        self._own.note(metadata.NAME)
        self.topics, self._files, self._file = {}, [], None
        self._written = 0
        # All chunks use one buffer, because allocating memory costs more than filling it.
        self._buffer = bytearray(CHUNK_BYTES)
        self._empty()

    @property
    def folder(self):
        """Return the folder into which the bag is being written."""
        return self._own.work

    def _empty(self):
        self._used, self._columns, self._single = 0, [], ([], [], [])

    def _take(self, size):
        """Reserve size bytes in the buffer and return their start."""
        start, self._used = self._used, self._used + size
        if self._used > len(self._buffer):
            self._buffer += bytes(self._used - len(self._buffer))
        return start

    def __enter__(self):
        return self

    def __exit__(self, kind, *error):
        if kind is None:
            self.close()
        else:
            self.abort()

    def add_topic(self, name, type_name, profile=qos.RELIABLE, definition=None, type_hash='',
                  definition_encoding='ros2msg', encoding='cdr'):
        """
        Declare a topic; a missing leading slash is added to its name.

        profile is the offered quality of service (``bags.qos``); definition and type_hash are by
        default those of ROS 2 Jazzy.  Raises ValueError if the topic is already declared or its
        type is unknown.
        """
        name = '/' + name.lstrip('/')
        if name in self.topics:
            raise ValueError(f'{name} is declared twice in {self.path}')
        qos.read_profiles(profile)
        if definition is None:
            definition, type_hash = message_definition(type_name)
        channel = Channel(len(self.topics) + 1, name, type_name, encoding, definition,
                          definition_encoding, type_hash, profile)
        self.topics[name] = channel
        if self._file is not None:
            with self._disk():
                self._file.add_topic(channel)

    def _channel(self, name):
        channel = self.topics.get(name) or self.topics.get('/' + name)
        if channel is None:
            raise ValueError(f'{name} is not declared in {self.path}; expected one of '
                             f'{", ".join(self.topics) or "add_topic first"}')
        return channel

    def write(self, name, log_ns, data):
        """
        Write one message (bytes).

        It is written to disk with its chunk: after CHUNK_BYTES, after CHUNK_NS of log time and
        CHUNK_LEAST messages, or by ``flush``.
        """
        if not 0 <= log_ns <= LATEST_NS:
            raise ValueError(f'{name}: the log time is {log_ns} ns; expected 0 or later')
        number = self._channel(name).id
        if len(self._single[1]) >= CHUNK_LEAST and abs(
                log_ns - self._single[1][0]) >= CHUNK_NS:
            self.flush()
        channels, times, starts = self._single
        head, size = form.MESSAGE_HEAD, len(data)
        start = self._take(head.size + size)
        head.pack_into(self._buffer, start, form.MESSAGE,
                       head.size - form.RECORD.size + size, number, 0, log_ns, log_ns)
        self._buffer[start + head.size:self._used] = data
        starts.append(start)
        channels.append(number)
        times.append(log_ns)
        if self._used >= CHUNK_BYTES:
            self.flush()

    def write_blocks(self, blocks):
        """
        Write blocks of messages in the order of log times; ties keep the order of the blocks.

        blocks is {name: (log_ns (n,), messages (n,))}. messages is the array of
        ``messages.cdr.Writer.block``, or an object array with the bytes of each message.
        """
        ready = []
        for name, (log_ns, messages) in blocks.items():
            log_ns = np.asarray(log_ns, dtype=np.int64)
            if len(log_ns) != len(messages):
                raise ValueError(f'{name} has {len(log_ns)} log times for {len(messages)} '
                                 'messages')
            if len(log_ns) and log_ns.min() < 0:
                raise ValueError(f'{name}: the log time is {log_ns.min()} ns; expected 0 or '
                                 'later')
            if messages.dtype != object:
                # Opaque elements are copied as a whole and not field by field.
                messages = np.ascontiguousarray(messages.view(f'V{messages.dtype.itemsize}'))
            ready.append((self._channel(name).id, log_ns, messages))
        ready = [block for block in ready if len(block[1])]
        if not ready:
            return
        self._seal()
        order = arrange_records(ready)
        ends = np.cumsum(order.sizes)
        first = 0
        while first < len(ends):
            before = int(ends[first - 1]) if first else 0
            room = max(1, CHUNK_BYTES - self._used)
            stop = min(len(ends), int(np.searchsorted(ends, before + room)) + 1)
            start = self._take(int(ends[stop - 1]) - before)
            starts = ends[first:stop] - order.sizes[first:stop] - before + start
            fill_records(order, first, stop, np.frombuffer(self._buffer, dtype=np.uint8), starts)
            self._columns.append((order.channel[first:stop], order.log_ns[first:stop], starts))
            if self._used >= CHUNK_BYTES:
                self.flush()
            first = stop

    def _seal(self):
        """Convert the lists of single messages to columns."""
        if self._single[0]:
            self._columns.append(tuple(np.array(x, dtype=np.int64) for x in self._single))
            self._single = ([], [], [])

    def flush(self):
        """Write the messages in the buffer as one chunk (MCAP) or transaction (SQLite)."""
        self._seal()
        if not self._columns:
            return
        records = Records(memoryview(self._buffer)[:self._used],
                          *(np.concatenate(x) for x in zip(*self._columns)))
        self._empty()
        for begins_file, part in self._split(records):
            self._append(part, begins_file)

    def _split(self, records):
        """Yield (whether the time span makes these Records begin a new file, the Records)."""
        if self._clocks is None:
            yield False, records
            return
        begins = [k for k, log_ns in enumerate(records.log_ns.tolist())
                  if self._clocks.begins_file(log_ns)]
        count, starts_file = len(records.log_ns), set(begins)
        edges = [*([] if begins[:1] == [0] else [0]), *begins, count]
        for a, b in zip(edges, edges[1:]):
            start = int(records.starts[a])
            stop = int(records.starts[b]) if b < count else len(records.data)
            yield a in starts_file, Records(
                records.data[start:stop], records.channel[a:b], records.log_ns[a:b],
                records.starts[a:b] - start)

    def _append(self, records, begins_file):
        first, last = int(records.log_ns.min()), int(records.log_ns.max())
        with self._disk():
            if self._file is not None and self._first_ns is not None and (
                    begins_file or self._split_bytes is not None
                    and self._file.size >= self._split_bytes):
                self._close_file()
            if self._file is None:
                self._open_file()
            self._file.append(records)
        self._written += len(records.log_ns)
        counts = np.bincount(records.channel, minlength=len(self.topics) + 1).tolist()
        for topic in self.topics.values():
            self._counts[topic.name] = self._counts.get(topic.name, 0) + counts[topic.id]
        self._first_ns = first if self._first_ns is None else min(first, self._first_ns)
        self._last_ns = last if self._last_ns is None else max(last, self._last_ns)

    _first_ns = _last_ns = None

    def _open_file(self):
        make, suffix = WRITERS[self.storage]
        self._name = f'{self._own.path.name}_{len(self._files)}{suffix}'
        self._own.note(self._name, *(self._name + more for more in COMPANIONS[suffix]))
        self._file = make(self.folder / self._name, self._compression)
        self._counts, self._first_ns, self._last_ns = {}, None, None
        for channel in self.topics.values():
            self._file.add_topic(channel)

    def _close_file(self):
        self._files.append(metadata.FileCounts(self._name, self._counts, self._first_ns,
                                               self._last_ns))
        self._file.close(metadata.inner_text(self.storage, self.topics.values(), self._files))
        self._file = None

    def close(self):
        """Complete the bag."""
        self.flush()
        with self._disk():
            if self._file is None:
                self._open_file()
            self._close_file()
            target = self.folder / metadata.NAME
            part = target.with_name(target.name + '.part')
            part.write_text(metadata.metadata_text(self.storage, self.topics.values(),
                                                   self._files),
                            encoding='utf-8')
            part.rename(target)
            self._own.commit()

    @contextmanager
    def _disk(self):
        """On a disk error close the file as it is, and raise OSError stating what is kept."""
        try:
            yield
        except OSError as error:
            self.abort()
            raise OSError(f'{self.folder}: {error.strerror or error}; the {self._written} '
                          'messages written before are kept, in a bag that is not closed'
                          ) from None

    def abort(self):
        """Leave the bag on disk as it is, without completing it."""
        if self._file is not None:
            self._file.abort()
            self._file = None
        self._empty()
        self._own.close()

    def discard(self):
        """Close and delete what was written."""
        self.abort()
        self._own.discard()


def check_target(path, storage, compression, replace):
    """Raise ValueError unless a bag can be written with these arguments."""
    if storage not in WRITERS:
        raise ValueError(f'the storage is {storage!r}; expected one of {", ".join(WRITERS)}')
    if compression not in NAMES:
        raise ValueError(f'the compression is {compression!r}; expected one of '
                         f'{", ".join(NAMES)}')
    if storage == 'sqlite3' and compression != 'none':
        raise ValueError(f'sqlite3 cannot be compressed by {compression}; expected the storage '
                         'mcap, or the compression none')
    if compression != 'none':
        compression_library(compression)
    if not replace and Path(path).exists():
        raise ValueError(f'{path} exists; expected a new path for the bag')
    check_free(path, replace, metadata.NAME)
