"""For any bytes, reading a bag gives valid messages or one error, quickly and in little memory."""

import time
import tracemalloc

from hypothesis import given, settings, strategies
from ins_sim.bags import mcap_format as form
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.messages import columns, topics
from ins_sim.messages.cdr import LAYOUTS, Reader, Writer
import numpy as np
import pytest

KINDS = [('mcap', 'none'), ('mcap', 'lz4'), ('mcap', 'zstd'), ('sqlite3', 'none')]
# Without checksums, which would detect changes inside a chunk.
UNCHECKED = [('mcap', 'indexed'), ('mcap', 'scanned'), ('mcap', 'loose')]
SUFFIX = {'mcap': '.mcap', 'sqlite3': '.db3'}
N = 40
# CPU time that only an endless loop needs, s: a correct reader needs milliseconds.
GUARD_S = 60.0
# A reader of the file below needs some 300 kB, more for Python objects than for data.
BYTES = 20_000_000

flips = strategies.lists(strategies.tuples(strategies.floats(0, 1, exclude_max=True),
                                           strategies.integers(0, 255)), max_size=6)
cuts = strategies.one_of(strategies.none(), strategies.floats(0, 1))


@pytest.fixture(scope='module')
def files(tmp_path_factory):
    """Return {kind: bytes of a small bag}, and a folder for others."""
    folder = tmp_path_factory.mktemp('fuzz')
    found = {}
    for kind in KINDS:
        path = folder / '_'.join(kind)
        with BagWriter(path, *kind) as bag:
            bag.add_topic('/imu', topics.IMU)
            bag.add_topic('/odom', topics.ODOMETRY)
            bag.add_topic('/status', topics.STRING)
            imu, odometry = topics.IMU_RAW.writer(), topics.TRUTH_ODOMETRY.writer()
            for first in (0, N):
                stamps = np.arange(first, first + N) * 10**7
                bag.write_blocks({
                    '/imu': (stamps, imu.block(stamps, np.ones((N, 6)))),
                    '/odom': (stamps, odometry.block(stamps, np.ones((N, 13))))})
                bag.write('/status', int(stamps[-1]), b'\x00\x01\x00\x00\x02\x00\x00\x00a\x00')
                bag.flush()
        found[kind] = next(path.glob('*_0.*')).read_bytes()
    for kind in UNCHECKED:
        found[kind] = unchecked(folder / 'unchecked.mcap', kind[1])
    return folder, found


def unchecked(path, kind):
    """Return the bytes of a file written by the mcap library without checksums."""
    mcap_writer = pytest.importorskip('mcap.writer')
    options = {'indexed': {}, 'scanned': {'index_types': mcap_writer.IndexType.NONE},
               'loose': {'use_chunking': False}}[kind]
    with open(path, 'wb') as stream:
        writer = mcap_writer.Writer(stream, enable_crcs=False, chunk_size=15_000, compression=(
            mcap_writer.CompressionType.NONE), **options)
        writer.start('ros2')
        channels = [writer.register_channel(name, 'cdr', writer.register_schema(t, 'ros2msg', b''))
                    for name, t in (('/imu', topics.IMU), ('/odom', topics.ODOMETRY))]
        for k in range(N):
            for channel, topic in zip(channels, (topics.IMU_RAW, topics.TRUTH_ODOMETRY)):
                data = topic.writer().pack_block([k], np.ones((1, 13)))[0]
                writer.add_message(channel, k, data, k)
        writer.finish()
    return path.read_bytes()


def read_all(path):
    """Read everything in every way; return the number of messages."""
    with open_bag(path) as bag:
        count = sum(span.count for span in bag.spans().values())
        messages = list(bag.messages())
        assert len(messages) == count
        times = [t for _, t, _ in messages]
        assert times == sorted(times)
        for name, channel in bag.topics.items():
            if channel.type_name in LAYOUTS and channel.encoding == 'cdr':
                array = bag.arrays(name)
                assert len(array) == sum(n == name for n, _, _ in messages)
                bag.frames(name)
        return count


def sound_or_refused(path, data):
    """Read a file with these bytes; check time, memory and the type of the error."""
    path.write_bytes(data)
    path.with_name(path.name + '-wal').unlink(missing_ok=True)
    tracemalloc.start()
    start = time.process_time()
    try:
        assert 0 <= read_all(path) <= 4 * N + 2
    except ValueError as error:
        assert '\n' not in str(error) and str(path.name) in str(error), error
    finally:
        seconds = time.process_time() - start
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert seconds < GUARD_S and peak < BYTES, (seconds, peak)


def first_chunk(data):
    position = len(form.MAGIC)
    while data[position] != form.CHUNK:
        position += form.RECORD.size + form.RECORD.unpack_from(data, position)[1]
    return position


def changed(data, flips, cut):
    data = bytearray(data)
    for where, value in flips:
        data[int(where * len(data))] = value
    return bytes(data if cut is None else data[:int(cut * len(data))])


@pytest.mark.parametrize('kind', KINDS + UNCHECKED, ids='-'.join)
def test_bytes_flipped_and_cut(kind, files):
    """Files with flipped bytes and files truncated at random give messages or one error."""
    folder, found = files
    path = folder / f'flipped{SUFFIX[kind[0]]}'

    @settings(max_examples=250, deadline=None, derandomize=True)
    @given(flips, cuts)
    def check(flips, cut):
        sound_or_refused(path, changed(found[kind], flips, cut))

    check()


@pytest.mark.parametrize('kind', KINDS + UNCHECKED, ids='-'.join)
def test_every_byte_outside_of_the_data(kind, files):
    """
    Any byte changed outside the data gives messages or one error.

    The bytes are those of MCAP records, and the headers and first cells of SQLite pages.
    """
    folder, found = files
    data, path = found[kind], folder / f'each{SUFFIX[kind[0]]}'
    if kind[0] == 'mcap':
        chunk = first_chunk(data) if kind[1] != 'loose' else 0
        places = [*range(200), *range(chunk, chunk + 250), *range(len(data) - 700, len(data))]
        if kind[1] in ('indexed', 'scanned'):
            # The headers of the messages in the first chunk.
            heads = [k for k in range(chunk, chunk + 9000) if data[k:k + 1] == b'\x05'
                     and data[k + 3:k + 9] == bytes(6)]
            places += [k + j for k in heads[:8] for j in range(31)]
    else:
        places = [*range(100), *(page + k for page in range(0, len(data), 4096)
                                 for k in range(0, 24, 3))]
    for place in places[::5]:
        for value in (0, 255, data[place] ^ 1):
            sound_or_refused(path, data[:place] + bytes([value]) + data[place + 1:])


@settings(max_examples=300, deadline=None)
@given(strategies.binary(max_size=400), strategies.sampled_from(['.mcap', '.db3']),
       strategies.booleans())
def test_noise(tmp_path_factory, data, suffix, behind_magic):
    """Random bytes, with the right magic number or without, give messages or one error."""
    magic = {'.mcap': b'\x89MCAP0\r\n\x01\x08' + bytes(7) + bytes(8),
             '.db3': b'SQLite format 3\x00\x10\x00\x01\x01\x00\x40\x20\x20'}[suffix]
    path = tmp_path_factory.getbasetemp() / f'noise{suffix}'
    sound_or_refused(path, magic * behind_magic + data)


@settings(max_examples=400, deadline=None)
@given(strategies.sampled_from(sorted(LAYOUTS)), strategies.lists(strategies.tuples(
    strategies.text(max_size=9), flips, cuts), min_size=1, max_size=8))
def test_arrays_are_what_the_reader_of_single_messages_says(type_name, messages):
    """Arrays are read, or refused, exactly as messages.cdr.Reader reads each message."""
    layout, data = LAYOUTS[type_name], []
    for text, changes, cut in messages:
        text = text.replace('\x00', '')
        whole = Writer(type_name, *(text, text + 'x')[:layout.strings],
                       runs=((0, layout.doubles),)).pack(5 * 10**9 + 7, [1.5] * layout.doubles)
        data.append(changed(whole, changes, cut) if len(whole) else whole)
    reader, expected = Reader(type_name), []
    try:
        expected = [reader.read(message) for message in data]
        refused = False
    except ValueError:
        refused = True
    sizes = np.array([len(m) for m in data])
    starts = np.cumsum(sizes) - sizes
    dtype = columns.column_dtype(type_name, [name for name, _ in columns.DOUBLES[type_name]])
    out = np.zeros(len(data), dtype=dtype)
    try:
        odd = columns.read_columns(type_name, np.frombuffer(b''.join(data) + b'\x00' * 64,
                                                            dtype=np.uint8),
                                   starts, sizes, out)
    except ValueError:
        assert refused
        return
    # Stamps with too many nanoseconds are counted; the reader of single messages refuses them.
    assert refused == bool(odd)
    if refused:
        return
    assert out['stamp_ns'].tolist() == [stamp for stamp, _ in expected]
    doubles = np.concatenate([out[n].reshape(len(out), -1) for n in dtype.names[2:]]
                             or [np.zeros((len(out), 0))], axis=1)
    assert np.array_equal(doubles, np.array([d for _, d in expected]).reshape(doubles.shape),
                          equal_nan=True)


def test_a_chunk_that_says_it_is_huge_takes_no_memory(files):
    """A size field of the first chunk set to its greatest value does not allocate that memory."""
    folder, found = files
    for kind in KINDS[:3]:
        data = found[kind]
        chunk = first_chunk(data)
        for offset in (9 + 16, 1):
            for value in (2**63 - 1, 2**40, 2**29):
                place = chunk + offset
                sound_or_refused(folder / 'huge.mcap', data[:place] + value.to_bytes(8, 'little')
                                 + data[place + 8:])
