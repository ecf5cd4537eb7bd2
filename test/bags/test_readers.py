"""Our bags are read by our reader, rosbags, mcap and rclpy, and we read the bags of others."""

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.bags.definitions import message_definition
from ins_sim.messages import columns, topics
from ins_sim.messages.cdr import LAYOUTS
import numpy as np
import pytest
import yaml
from support.bags.messages import (by_topic, KINDS, N, STAMPS, STORE, strings, topic_of, TYPES,
                                   values_of, write_everything, writer_of)

rosbag2 = pytest.importorskip('rosbags.rosbag2')


@pytest.mark.parametrize('storage, compression', KINDS)
def test_everything_comes_back_by_every_reader(storage, compression, tmp_path):
    """Every message of every type is read back to the byte, in log order and decoded."""
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
    """AnyReader of rosbags learns the types from the definitions in the file."""
    from rosbags.highlevel import AnyReader
    write_everything(tmp_path / 'bag', 'mcap', 'zstd')
    with AnyReader([tmp_path / 'bag']) as reader:
        for connection, _, data in reader.messages():
            reader.deserialize(data, connection.msgtype)
        assert reader.message_count == N * len(TYPES) + 7


@pytest.mark.parametrize('compression', ['none', 'lz4', 'zstd'])
def test_the_mcap_library_agrees(compression, tmp_path):
    """The mcap library finds our messages, schemas, statistics, metadata and indices."""
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
            assert schema.encoding == 'ros2msg'
            assert schema.data.decode() == message_definition(schema.name)[0]
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
    # A file without its index is read, and checked, from front to end.
    from mcap.stream_reader import StreamReader
    with open(tmp_path / 'bag' / 'bag_0.mcap', 'rb') as stream:
        assert sum(1 for _ in StreamReader(stream, validate_crcs=True).records) > N


@pytest.mark.parametrize('storage, compression', KINDS)
def test_rclpy_reads_what_is_written(storage, compression, tmp_path):
    """rclpy can deserialise every message of a bag."""
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
    """Bags written by rosbags, and their single files, are read."""
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
            assert read.topics[topic_of(TYPES[0])].definition == message_definition(TYPES[0])[0]


@pytest.mark.parametrize('type_name', TYPES)
def test_bytes_are_those_of_rosbags(type_name):
    """Equal messages are equal bytes, because rosbags pads with zeros as we do."""
    for frames in (('', ''), ('m', 'ab'), ('map', 'base_link')):
        data = writer_of(type_name, frames).pack(int(STAMPS[7]), values_of(type_name)[0])
        message = STORE.deserialize_cdr(data, type_name)
        assert bytes(STORE.serialize_cdr(message, type_name)) == data


def test_a_status_of_a_fix_is_read(tmp_path):
    """The small integers of NavSatFix are read back."""
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


def test_files_without_chunks_or_index_are_read(tmp_path):
    """Files of the rosbag2 preset fastwrite, and of writers without an index, can be read."""
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
    """A copied bag keeps definition, hash and profile of unknown types."""
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
