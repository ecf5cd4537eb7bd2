"""Format of bags: order, splits, metadata, type hashes, tables, empty bags."""

import hashlib
import json
import os
from pathlib import Path
import sqlite3
import sys

from ins_sim.bags import digest
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter, CHUNK_BYTES
from ins_sim.bags.definitions import message_definition
from ins_sim.messages import topics
from ins_sim.messages.cdr import Writer
import numpy as np
import pytest
import yaml
from support.bags.messages import (by_topic, KINDS, STORE, strings, TYPES, write_everything)

rosbag2 = pytest.importorskip('rosbags.rosbag2')


@pytest.mark.parametrize('storage, compression', KINDS)
def test_the_same_messages_are_the_same_bytes(storage, compression, tmp_path):
    """Writing twice gives equal files; other storages and chunk sizes give the same payload."""
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
    """Each file of a split bag has what metadata.yaml states; together they have all messages."""
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
    """
    metadata.yaml has the keys of rosbag2 Jazzy in its order, version 9, hashes, and profiles.

    Profiles are a list of maps.
    """
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
    # Published in the definition of the type description (REP-2016).
    assert topic['topic_metadata']['type_description_hash'] == (
        'RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b')
    profile, = topic['topic_metadata']['offered_qos_profiles']
    assert profile['reliability'] == 'reliable' and profile['durability'] == 'volatile'
    assert profile['deadline'] == {'sec': 9223372036, 'nsec': 854775807}


@pytest.mark.parametrize('type_name', [*TYPES, *(t for t, _ in strings().values())])
def test_the_hash_of_a_type_is_that_of_ros(type_name):
    """The hash of each type equals that in the type descriptions installed by ROS."""
    package, kind, name = type_name.split('/')
    prefixes = [*filter(None, os.environ.get('AMENT_PREFIX_PATH', '').split(':')), sys.prefix]
    paths = [Path(p) / 'share' / package / kind / f'{name}.json' for p in prefixes]
    path = next((p for p in paths if p.exists()), None)
    if path is None:
        pytest.skip('no ROS here that describes its types')
    hashes = {h['type_name']: h['hash_string'] for h in json.loads(path.read_text())[
        'type_hashes']}
    assert hashes[type_name] == message_definition(type_name)[1]


def test_sqlite_has_the_tables_of_rosbag2(tmp_path):
    """An SQLite bag has schema version 4 and one file, without a log file."""
    with BagWriter(tmp_path / 'bag', 'sqlite3') as bag:
        bag.add_topic('/t', topics.STRING)
        bag.write('/t', 1, bytes(STORE.serialize_cdr(STORE.types[topics.STRING]('x'),
                                                     topics.STRING)))
    assert sorted(f.name for f in (tmp_path / 'bag').iterdir()) == [
        '.ins_sim', 'bag_0.db3', 'metadata.yaml']
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
    """
    Messages written out of order are read in order of log time; equal times keep their order.

    Log times may decrease within and across chunks and files.
    """
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
    """Blocks with equal times keep their order, and unsorted blocks are sorted."""
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
    """Messages of one topic may differ in length and hold values that are not finite."""
    frames = ['', 'm', 'map', 'a_longer_frame', 'm', '']
    values = np.array([np.nan, np.inf, -np.inf, -0.0, 5e-324, 1.0])
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('/odom', topics.ODOMETRY)
        for frame, value in zip(frames, values.tolist()):
            writer = Writer(topics.ODOMETRY, frame, frame + 'x', runs=((0, 85),))
            bag.write('/odom', 7, writer.pack_block([7], np.full((1, 85), value))[0])
    with open_bag(tmp_path / 'bag') as bag:
        array = bag.arrays('/odom')
        assert np.array_equal(array['twist_covariance'][:, 35], values, equal_nan=True)
        assert np.array_equal(array['position'][:, 0], values, equal_nan=True)
        assert bag.frames('odom') == [(f, f + 'x') for f in frames[:4]]
        assert array['stamp_ns'].tolist() == array['log_ns'].tolist() == [7] * 6


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_empty_bags_and_topics(storage, tmp_path):
    """A bag without messages or topics is valid, for rosbags too."""
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


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
@pytest.mark.parametrize('names', [('a', 'b'), ('a', 'a')])
def test_stamps_of_two_clocks(storage, names, tmp_path):
    """
    Alternating stamps of two clocks do not give a chunk for each message.

    Files are split by the time of each clock.
    """
    with BagWriter(tmp_path / 'bag', storage, split_ns=2 * 10**9) as bag:
        for name in dict.fromkeys(names):
            bag.add_topic(name, topics.IMU)
        pack = topics.IMU_RAW.writer().pack
        for k in range(2000):
            for name, zero_ns in zip(names, (0, 1_700_000_000 * 10**9)):
                t_ns = zero_ns + k * 5 * 10**6
                bag.write(name, t_ns, pack(t_ns, (0.0,) * 3, (0.0,) * 3))
    with open_bag(tmp_path / 'bag') as bag:
        assert sum(span.count for span in bag.spans().values()) == 4000
        files = bag.files
    # Ten seconds by each clock.
    assert len(files) == 5
    if storage == 'mcap':
        assert sum(path.stat().st_size for path in files) < 1.1 * 4000 * (324 + 31) + 5 * 6000
