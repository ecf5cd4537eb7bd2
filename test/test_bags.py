"""Bags: what is written is read back by us, rosbags, mcap and rclpy, and the reverse."""

import hashlib
import json
import os
from pathlib import Path
import sqlite3
import sys

from ins_sim.bags import digest, qos
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter, CHUNK_BYTES
from ins_sim.bags.definitions import define
from ins_sim.messages import columns, topics
from ins_sim.messages.cdr import LAYOUTS, Writer
import numpy as np
import pytest
import yaml

rosbag2 = pytest.importorskip('rosbags.rosbag2')
typesys = pytest.importorskip('rosbags.typesys')
STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
KINDS = [('mcap', 'none'), ('mcap', 'lz4'), ('mcap', 'zstd'), ('sqlite3', 'none')]
TYPES = sorted(LAYOUTS)
N = 5000
STAMPS = 1_700_000_000_000_000_000 + np.arange(N) * 10**7


def writer_of(type_name, frames=('map', 'base_link')):
    layout = LAYOUTS[type_name]
    return Writer(type_name, *frames[:layout.strings], runs=((0, layout.doubles),))


def values_of(type_name, n=N):
    return np.random.default_rng(TYPES.index(type_name)).normal(size=(n, LAYOUTS[
        type_name].doubles))


def topic_of(type_name):
    return '/a/' + type_name.rpartition('/')[2].lower()


def strings():
    """Return messages of the types that have no layout, as the nodes publish them."""
    text = STORE.types[topics.STRING]
    time, header = STORE.types['builtin_interfaces/msg/Time'], STORE.types[topics.HEADER]
    pair = STORE.types['diagnostic_msgs/msg/KeyValue']
    status = STORE.types['diagnostic_msgs/msg/DiagnosticStatus']
    array = STORE.types['diagnostic_msgs/msg/DiagnosticArray']
    return {
        '/sim/status': (topics.STRING, [text(data) for data in ('', 'running', 'ä' * 999)]),
        '/diagnostics': ('diagnostic_msgs/msg/DiagnosticArray', [array(
            header(time(k, 5), ''), [status(k, 'n' * k, '', 'id', [pair('k', 'v' * k)])] * k)
            for k in range(4)])}


def write_everything(path, storage, compression, **options):
    """Write N messages of every layout in blocks and a few others; return {topic: bytes}."""
    expected = {}
    with BagWriter(path, storage, compression, **options) as bag:
        for type_name in TYPES:
            bag.add_topic(topic_of(type_name), type_name)
        for first in range(0, N, 777):
            rows, blocks = slice(first, first + 777), {}
            for type_name in TYPES:
                messages = writer_of(type_name).block(STAMPS[rows], values_of(type_name)[rows])
                blocks[topic_of(type_name)] = STAMPS[rows], messages
                expected.setdefault(topic_of(type_name), []).extend(m.tobytes() for m in messages)
            bag.write_blocks(blocks)
        for name, (type_name, messages) in strings().items():
            bag.add_topic(name, type_name, qos.LATCHED)
            for k, message in enumerate(messages):
                data = bytes(STORE.serialize_cdr(message, type_name))
                bag.write(name, int(STAMPS[-1]) + k, data)
                expected.setdefault(name, []).append(data)
    return expected


def by_topic(messages):
    found = {}
    for name, log_ns, data in messages:
        found.setdefault(name, []).append(bytes(data))
    return found


@pytest.mark.parametrize('storage, compression', KINDS)
def test_everything_comes_back_by_every_reader(storage, compression, tmp_path):
    """Every byte of every message of every type, in the order of the log times, and decoded."""
    expected = write_everything(tmp_path / 'bag', storage, compression)
    with open_bag(tmp_path / 'bag') as bag:
        messages = list(bag.messages())
        assert not bag.cut and bag.storage == storage and bag.compression == [compression]
        assert {n: s.count for n, s in bag.spans().items()} == {
            n: len(m) for n, m in expected.items()}
        for type_name in TYPES:
            array = bag.arrays(topic_of(type_name), type_name=type_name)
            assert np.array_equal(array['stamp_ns'], STAMPS)
            assert np.array_equal(array['log_ns'], STAMPS)
            fields = [array[name].reshape(N, -1) for name, _ in columns.DOUBLES[type_name]]
            assert np.array_equal(np.concatenate(fields or [np.zeros((N, 0))], axis=1),
                                  values_of(type_name))
            frames = ('map', 'base_link')[:LAYOUTS[type_name].strings]
            assert bag.frames(topic_of(type_name)) == [frames]
    assert by_topic(messages) == expected
    assert [t for _, t, _ in messages] == sorted(t for _, t, _ in messages)
    with rosbag2.Reader(tmp_path / 'bag') as other:
        assert {c.topic: c.msgtype for c in other.connections} == {
            n: t for n, t in [*((topic_of(t), t) for t in TYPES),
                              *((n, t) for n, (t, _) in strings().items())]}
        theirs = [(c.topic, t, bytes(d)) for c, t, d in other.messages()]
        for connection, _, data in other.messages():
            message = STORE.deserialize_cdr(data, connection.msgtype)
            again = bytes(STORE.serialize_cdr(message, connection.msgtype))
            assert again == bytes(data), connection.msgtype
    assert theirs == messages


def test_any_reader_of_rosbags_needs_nothing_but_the_bag(tmp_path):
    """Its AnyReader learns the types from the definitions in the file."""
    from rosbags.highlevel import AnyReader
    write_everything(tmp_path / 'bag', 'mcap', 'zstd')
    with AnyReader([tmp_path / 'bag']) as reader:
        for connection, _, data in reader.messages():
            reader.deserialize(data, connection.msgtype)
        assert reader.message_count == N * len(TYPES) + 7


@pytest.mark.parametrize('compression', ['none', 'lz4', 'zstd'])
def test_the_mcap_library_agrees(compression, tmp_path):
    """With its checks of the checksums on: messages, schemas, statistics, metadata, indices."""
    mcap_reader = pytest.importorskip('mcap.reader')
    expected = write_everything(tmp_path / 'bag', 'mcap', compression)
    with open(tmp_path / 'bag' / 'bag_0.mcap', 'rb') as stream:
        reader = mcap_reader.make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        found, last = {}, 0
        for schema, channel, message in reader.iter_messages():
            assert message.log_time >= last and message.log_time == message.publish_time
            last = message.log_time
            found.setdefault(channel.topic, []).append(message.data)
            assert schema.encoding == 'ros2msg' and schema.data.decode() == define(schema.name)[0]
        assert found == expected
        statistics = summary.statistics
        assert statistics.message_count == N * len(TYPES) + 7
        assert statistics.message_start_time == STAMPS[0]
        assert statistics.message_end_time == STAMPS[-1] + 3
        assert statistics.chunk_count == len(summary.chunk_indexes) > 2
        assert {summary.channels[k].topic: n for k, n in
                statistics.channel_message_counts.items()} == {
                    name: len(m) for name, m in expected.items()}
        kept, = reader.iter_metadata()
        inner = yaml.safe_load(kept.metadata['serialized_metadata'])
    whole = yaml.safe_load((tmp_path / 'bag' / 'metadata.yaml').read_text())
    assert inner == whole['rosbag2_bagfile_information']
    # without its index the file is read from front to end, and checked as well
    from mcap.stream_reader import StreamReader
    with open(tmp_path / 'bag' / 'bag_0.mcap', 'rb') as stream:
        assert sum(1 for _ in StreamReader(stream, validate_crcs=True).records) > N


@pytest.mark.parametrize('storage, compression', KINDS)
def test_rclpy_reads_what_is_written(storage, compression, tmp_path):
    """Every message of a bag is one for ROS."""
    serialization = pytest.importorskip('rclpy.serialization')
    from importlib import import_module
    write_everything(tmp_path / 'bag', storage, compression)
    with open_bag(tmp_path / 'bag') as bag:
        count = 0
        for name, _, data in bag.messages():
            module, _, cls = bag.topics[name].type_name.split('/')
            serialization.deserialize_message(data, getattr(import_module(f'{module}.msg'), cls))
            count += 1
    assert count == N * len(TYPES) + 7


@pytest.mark.parametrize('storage, compression', [
    ('MCAP', 'NONE'), ('MCAP', 'STORAGE'), ('SQLITE3', 'NONE')])
def test_what_rosbags_writes_is_read(storage, compression, tmp_path):
    """Whole bags, and their files alone."""
    bag = rosbag2.Writer(tmp_path / 'bag', version=9,
                         storage_plugin=rosbag2.StoragePlugin[storage])
    bag.set_compression(rosbag2.CompressionMode[compression], rosbag2.CompressionFormat.ZSTD)
    expected = []
    with bag:
        connections = {t: bag.add_connection(topic_of(t), t, typestore=STORE) for t in TYPES}
        single = {t: writer_of(t).pack_block(STAMPS, values_of(t)) for t in TYPES}
        for k in range(0, N, 5):
            for type_name, connection in connections.items():
                bag.write(connection, int(STAMPS[k]), single[type_name][k])
                expected.append((topic_of(type_name), int(STAMPS[k]), single[type_name][k]))
    suffix = {'MCAP': 'mcap', 'SQLITE3': 'db3'}[storage]
    for path in (tmp_path / 'bag', tmp_path / 'bag' / f'bag.{suffix}'):
        with open_bag(path) as read:
            assert not read.cut
            assert list(read.messages()) == expected
            for type_name in TYPES:
                array = read.arrays(topic_of(type_name))
                assert np.array_equal(array['stamp_ns'], STAMPS[::5])
            assert read.topics[topic_of(TYPES[0])].definition == define(TYPES[0])[0]


@pytest.mark.parametrize('type_name', TYPES)
def test_bytes_are_those_of_rosbags(type_name):
    """rosbags fills with zeros as we do, so equal messages are equal bytes."""
    for frames in (('', ''), ('m', 'ab'), ('map', 'base_link')):
        data = writer_of(type_name, frames).pack(int(STAMPS[7]), values_of(type_name)[0])
        message = STORE.deserialize_cdr(data, type_name)
        assert bytes(STORE.serialize_cdr(message, type_name)) == data


@pytest.mark.parametrize('storage, compression', KINDS)
def test_the_same_messages_are_the_same_bytes(storage, compression, tmp_path):
    """Twice the same gives equal files; another storage or chunking the same payload."""
    for folder in ('one', 'two'):
        write_everything(tmp_path / folder / 'bag', storage, compression)
        (tmp_path / folder / 'bag').touch()
    files = [sorted((tmp_path / folder / 'bag').iterdir()) for folder in ('one', 'two')]
    for one, two in zip(*files):
        assert one.name == two.name and one.read_bytes() == two.read_bytes()
        assert digest.file_digest(one) == hashlib.sha256(two.read_bytes()).hexdigest()
    write_everything(tmp_path / 'other', 'mcap', 'none', split_bytes=CHUNK_BYTES)
    assert digest.payload_digest(tmp_path / 'one' / 'bag') == digest.payload_digest(
        tmp_path / 'other')


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_splits_by_size_and_by_time(storage, tmp_path):
    """Each file holds what its line in metadata.yaml says; together they hold everything."""
    expected = write_everything(tmp_path / 'size', storage, 'none', split_bytes=3 * CHUNK_BYTES)
    write_everything(tmp_path / 'time', storage, 'none', split_ns=20 * 10**9)
    for name in ('size', 'time'):
        info = yaml.safe_load((tmp_path / name / 'metadata.yaml').read_text())[
            'rosbag2_bagfile_information']
        assert 1 < len(info['files']) < 10
        assert info['relative_file_paths'] == [f['path'] for f in info['files']]
        for file in info['files']:
            with open_bag(tmp_path / name / file['path']) as part:
                spans = [s for s in part.spans().values() if s.count]
                assert sum(s.count for s in spans) == file['message_count'] > 0
                first = min(s.first_ns for s in spans)
                assert first == file['starting_time']['nanoseconds_since_epoch']
                length = max(s.last_ns for s in spans) - first
                assert length == file['duration']['nanoseconds']
                if name == 'time':
                    assert length < 20 * 10**9
        with open_bag(tmp_path / name) as bag:
            assert by_topic(bag.messages()) == expected
            assert len(bag.files) == len(info['files'])
        with rosbag2.Reader(tmp_path / name) as other:
            assert sum(1 for _ in other.messages()) == info['message_count'] == sum(
                map(len, expected.values()))


def test_metadata_is_that_of_rosbag2(tmp_path):
    """Keys in the order of rosbag2 Jazzy, version 9, hashes, profiles as a list of maps."""
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('imu/data_raw', topics.IMU)
        bag.write('/imu/data_raw', 5, topics.IMU_RAW.writer().pack(5, (0.0,) * 3, (0.0,) * 3))
    text = (tmp_path / 'bag' / 'metadata.yaml').read_text()
    assert text.startswith('rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: '
                           'mcap\n  duration:\n    nanoseconds: 0\n  starting_time:\n    '
                           'nanoseconds_since_epoch: 5\n  message_count: 1\n  '
                           'topics_with_message_count:\n    - topic_metadata:\n        name: '
                           '/imu/data_raw\n')
    assert text.endswith('  compression_format: ""\n  compression_mode: ""\n  '
                         'relative_file_paths:\n    - bag_0.mcap\n  files:\n    - path: '
                         'bag_0.mcap\n      starting_time:\n        nanoseconds_since_epoch: 5\n'
                         '      duration:\n        nanoseconds: 0\n      message_count: 1\n  '
                         'custom_data: ~\n  ros_distro: jazzy\n')
    topic = yaml.safe_load(text)['rosbag2_bagfile_information']['topics_with_message_count'][0]
    # published in the definition of the type's description (REP-2016)
    assert topic['topic_metadata']['type_description_hash'] == (
        'RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b')
    profile, = topic['topic_metadata']['offered_qos_profiles']
    assert profile['reliability'] == 'reliable' and profile['durability'] == 'volatile'
    assert profile['deadline'] == {'sec': 9223372036, 'nsec': 854775807}


@pytest.mark.parametrize('type_name', [*TYPES, *(t for t, _ in strings().values())])
def test_the_hash_of_a_type_is_that_of_ros(type_name):
    """As the type descriptions that ROS installs say."""
    package, kind, name = type_name.split('/')
    prefixes = [*filter(None, os.environ.get('AMENT_PREFIX_PATH', '').split(':')), sys.prefix]
    paths = [Path(p) / 'share' / package / kind / f'{name}.json' for p in prefixes]
    path = next((p for p in paths if p.exists()), None)
    if path is None:
        pytest.skip('no ROS here that describes its types')
    hashes = {h['type_name']: h['hash_string'] for h in json.loads(path.read_text())[
        'type_hashes']}
    assert hashes[type_name] == define(type_name)[1]


def test_sqlite_has_the_tables_of_rosbag2(tmp_path):
    """Schema version 4, one file, no log left beside it."""
    with BagWriter(tmp_path / 'bag', 'sqlite3') as bag:
        bag.add_topic('/t', topics.STRING)
        bag.write('/t', 1, bytes(STORE.serialize_cdr(STORE.types[topics.STRING]('x'),
                                                     topics.STRING)))
    assert sorted(f.name for f in (tmp_path / 'bag').iterdir()) == ['bag_0.db3', 'metadata.yaml']
    database = sqlite3.connect(tmp_path / 'bag' / 'bag_0.db3')
    assert database.execute('SELECT * FROM schema').fetchall() == [(4, 'jazzy')]
    names = {r[0] for r in database.execute('SELECT name FROM sqlite_master')}
    assert {'schema', 'metadata', 'topics', 'message_definitions', 'messages',
            'timestamp_idx'} <= names
    assert database.execute('SELECT name, type, serialization_format FROM topics').fetchall() == [
        ('/t', topics.STRING, 'cdr')]
    assert database.execute('PRAGMA integrity_check').fetchall() == [('ok',)]
    database.close()


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_messages_out_of_order_come_in_order(storage, tmp_path):
    """Log times go back within and across chunks and files; equal ones keep their order."""
    rng = np.random.default_rng(3)
    log_ns = rng.integers(0, 10**10, 4000) // 10**6 * 10**6
    writer = topics.IMU_RAW.writer()
    with BagWriter(tmp_path / 'bag', storage, split_bytes=300_000) as bag:
        bag.add_topic('/imu', topics.IMU)
        for k, t_ns in enumerate(log_ns.tolist()):
            bag.write('/imu', t_ns, writer.pack(k, (float(k), 0.0, 0.0), (0.0, 0.0, 0.0)))
    order = np.argsort(log_ns, kind='stable')
    with open_bag(tmp_path / 'bag') as bag:
        assert len(bag.files) > 2
        array = bag.arrays('/imu', ('angular_velocity',))
        assert array['log_ns'].tolist() == log_ns[order].tolist()
        assert array['stamp_ns'].tolist() == order.tolist()
        assert array['angular_velocity'][:, 0].tolist() == order.tolist()
        messages = list(bag.messages(['imu']))
    assert [t for _, t, _ in messages] == log_ns[order].tolist()
    reader = topics.IMU_RAW.reader()
    assert sorted(reader.read(d)[0] for _, _, d in messages) == list(range(4000))


def test_blocks_in_any_order_become_one_order(tmp_path):
    """Ties stand as the blocks are given, and unsorted blocks are sorted."""
    writer = topics.ERROR_DRIFT.writer()
    a, b = np.array([30, 10, 20, 20]), np.array([20, 5])
    with BagWriter(tmp_path / 'bag') as bag:
        for name in ('a', 'b'):
            bag.add_topic(name, topics.VECTOR)
        bag.write_blocks({
            'b': (b, writer.block(np.arange(2), np.zeros((2, 3)))),
            'a': (a, writer.block(np.arange(4), np.zeros((4, 3))))})
    with open_bag(tmp_path / 'bag') as bag:
        found = [(n, t, topics.ERROR_DRIFT.reader().read(d)[0]) for n, t, d in bag.messages()]
    assert found == [('/b', 5, 1), ('/a', 10, 1), ('/b', 20, 0), ('/a', 20, 2), ('/a', 20, 3),
                     ('/a', 30, 0)]


def test_frames_of_any_length_nan_and_equal_stamps(tmp_path):
    """Messages of one topic need not be equally long, nor their numbers finite."""
    frames = ['', 'm', 'map', 'a_longer_frame', 'm', '']
    values = np.array([np.nan, np.inf, -np.inf, -0.0, 5e-324, 1.0])
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('/odom', topics.ODOMETRY)
        for frame, value in zip(frames, values.tolist()):
            writer = Writer(topics.ODOMETRY, frame, frame + 'x', runs=((0, 85),))
            bag.write('/odom', 7, writer.pack(7, (value,) * 85))
    with open_bag(tmp_path / 'bag') as bag:
        array = bag.arrays('/odom')
        assert np.array_equal(array['twist_covariance'][:, 35], values, equal_nan=True)
        assert np.array_equal(array['position'][:, 0], values, equal_nan=True)
        assert bag.frames('odom') == [(f, f + 'x') for f in frames[:4]]
        assert array['stamp_ns'].tolist() == array['log_ns'].tolist() == [7] * 6


def test_a_status_of_a_fix_is_read(tmp_path):
    """The small numbers of NavSatFix come back too."""
    fix, status = STORE.types[topics.FIX], STORE.types['sensor_msgs/msg/NavSatStatus']
    time, header = STORE.types['builtin_interfaces/msg/Time'], STORE.types[topics.HEADER]
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('/fix', topics.FIX)
        for k, frame in enumerate(('g', 'gp', 'gps', 'gps0')):
            message = fix(header(time(1, 2), frame), status(k - 1, 5), 1.0, 2.0, 3.0,
                          np.arange(9.0), k)
            bag.write('/fix', k, bytes(STORE.serialize_cdr(message, topics.FIX)))
    with open_bag(tmp_path / 'bag') as bag:
        array = bag.arrays('/fix')
    assert array['status'].tolist() == [-1, 0, 1, 2] and array['service'].tolist() == [5] * 4
    assert array['position_covariance_type'].tolist() == [0, 1, 2, 3]
    assert array['altitude'].tolist() == [3.0] * 4
    assert array['position_covariance'].tolist() == [list(range(9))] * 4


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_empty_bags_and_topics(storage, tmp_path):
    """No message, or no topic, is a bag all the same, for rosbags too."""
    with BagWriter(tmp_path / 'none', storage):
        pass
    with BagWriter(tmp_path / 'bag', storage) as bag:
        bag.add_topic('imu', topics.IMU)
    with open_bag(tmp_path / 'bag') as bag:
        assert len(bag.arrays('imu')) == 0 and list(bag.messages()) == []
        assert bag.spans()['/imu'].count == 0 and not bag.cut and bag.frames('imu') == []
    with open_bag(tmp_path / 'none') as bag:
        assert bag.topics == {} and not bag.cut
    with rosbag2.Reader(tmp_path / 'bag') as other:
        assert other.message_count == 0 and list(other.messages()) == []


def test_files_without_chunks_or_index_are_read(tmp_path):
    """As the preset fastwrite of rosbag2 leaves them, and writers that index nothing."""
    mcap_writer = pytest.importorskip('mcap.writer')
    for k, options in enumerate([{'use_chunking': False},
                                 {'index_types': mcap_writer.IndexType.NONE},
                                 {'use_statistics': False, 'use_summary_offsets': False,
                                  'repeat_channels': False, 'repeat_schemas': False}]):
        path = tmp_path / f'{k}.mcap'
        with open(path, 'wb') as stream:
            writer = mcap_writer.Writer(stream, **options)
            writer.start('ros2')
            schema = writer.register_schema(topics.VECTOR, 'ros2msg', b'')
            channel = writer.register_channel('/v', 'cdr', schema)
            for j in range(100):
                writer.add_message(channel, j, topics.ERROR_DRIFT.writer().pack(j, (1.0, 2.0, j)),
                                   j)
            writer.finish()
        with open_bag(path) as bag:
            array = bag.arrays('v')
            assert array['vector'][:, 2].tolist() == list(range(100)), options
            assert bag.spans()['/v'].count == 100
            assert [t for _, t, _ in bag.messages()] == list(range(100))


def test_a_copy_carries_types_that_are_not_known(tmp_path):
    """Definition, hash and profile go from bag to bag."""
    with BagWriter(tmp_path / 'one') as bag:
        bag.add_topic('/x', 'my_msgs/msg/Thing', definition='int32 a\n', type_hash='RIHS01_0')
        bag.write('/x', 1, b'\x00\x01\x00\x00\x05\x00\x00\x00')
    with open_bag(tmp_path / 'one') as old, BagWriter(tmp_path / 'two', 'sqlite3') as new:
        for c in old.topics.values():
            new.add_topic(c.name, c.type_name, c.qos, c.definition, c.type_hash,
                          c.definition_encoding, c.encoding)
        for message in old.messages():
            new.write(*message)
    with open_bag(tmp_path / 'one') as one, open_bag(tmp_path / 'two') as two:
        assert one.topics == two.topics and list(one.messages()) == list(two.messages())
