"""Truncated, corrupt, foreign or existing bags give one message each, and exit code 2."""

import os
from pathlib import Path
import shutil
import sqlite3
import tempfile

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.cli.main import main
from ins_sim.messages import topics
import numpy as np
import pytest
from support.hostile.damaged import refused, write

N = 20_000
STAMPS = np.arange(N) * 10**7


def test_what_is_no_bag(tmp_path, capsys):
    """A missing path, another folder, a text, an empty file and another database are refused."""
    refused(tmp_path / 'absent', 'does not exist', capsys)
    refused(tmp_path, 'is not a bag; expected metadata.yaml', capsys)
    (tmp_path / 'text.csv').write_text('a,b\n')
    refused(tmp_path / 'text.csv', 'is not a bag; expected a folder', capsys)
    for suffix, sentence in (('mcap', 'expected an MCAP'), ('db3', 'expected an SQLite')):
        path = tmp_path / f'x.{suffix}'
        path.write_bytes(b'')
        refused(path, 'is empty', capsys)
        path.write_bytes(b'something else altogether' * 100)
        refused(path, sentence, capsys)
    database = sqlite3.connect(tmp_path / 'other.db3')
    database.execute('CREATE TABLE topics(id INTEGER)')
    database.commit()
    database.close()
    refused(tmp_path / 'other.db3', 'expected the tables topics and messages', capsys)
    refused(tmp_path, 'is not a bag', capsys)


# A YAML bomb: nine lines that expand to 10^9 strings.
BOMB = 'a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n' + ''.join(
    f'a{k}: &a{k} [{", ".join([f"*a{k - 1}"] * 10)}]\n' for k in range(1, 9))


@pytest.mark.parametrize('text, sentence', [
    ('', 'has no rosbag2_bagfile_information'), ('[1, 2]', 'has no rosbag2_bagfile_information'),
    ('a: [', 'is not YAML: line '), ('\x00', 'is not UTF-8 text that YAML allows'),
    ('[' * 3000, 'exceeded maximum nesting depth'), ('- ' * 3000, 'is nested deeper than 64 at'),
    ('a: &a [*a]', 'has the alias *a for itself at line 1'),
    (BOMB, 'holds more than 1000000 values, with aliases expanded, at line 6'),
    ('rosbag2_bagfile_information: {version: ' + '9' * 400 + '}', "has the version '999"),
    ('rosbag2_bagfile_information: {version: !!timestamp x}', "has the version 'x'"),
    ('rosbag2_bagfile_information: {version: 9, storage_identifier: mcap, relative_file_paths: '
     '[' + 'a.mcap, ' * 9999 + '1]}', 'characters); expected names of files'),
    ('rosbag2_bagfile_information: {version: 10}', 'has the version 10; expected at most 9'),
    ('rosbag2_bagfile_information: {version: 9, storage_identifier: rocks}', "storage 'rocks'"),
    ('rosbag2_bagfile_information: {version: 9, storage_identifier: mcap}',
     'expected names of files'),
    ('rosbag2_bagfile_information: {version: 9, storage_identifier: mcap, relative_file_paths: '
     '[gone_0.mcap]}', 'lacks gone_0.mcap'),
    ('rosbag2_bagfile_information: {version: 5, storage_identifier: sqlite3, compression_format: '
     'zstd, compression_mode: MESSAGE}', 'is compressed by message (zstd)'),
    ('rosbag2_bagfile_information: {version: 5, storage_identifier: sqlite3, compression_format: '
     'zstd, compression_mode: FILE}', 'is compressed by file (zstd)')])
def test_metadata_that_does_not_do(text, sentence, tmp_path, capsys):
    """Invalid metadata.yaml is refused: broken, too new, or of a bag compressed as a whole."""
    (tmp_path / 'metadata.yaml').write_text(text)
    refused(tmp_path, sentence, capsys)


def test_metadata_that_is_no_text(tmp_path, capsys):
    """metadata.yaml that is not UTF-8 is refused; file names cannot leave the bag."""
    (tmp_path / 'metadata.yaml').write_bytes(b'\xff\xfe\x00')
    refused(tmp_path, 'is not UTF-8 text', capsys)
    write(tmp_path / 'bag')
    text = (tmp_path / 'bag' / 'metadata.yaml').read_text()
    (tmp_path / 'bag' / 'metadata.yaml').write_text(
        text.replace('- bag_0.mcap', '- ../../../bag_0.mcap'))
    with open_bag(tmp_path / 'bag') as bag:
        assert bag.files == [tmp_path / 'bag' / 'bag_0.mcap']


def test_bags_compressed_by_rosbags_as_a_whole(tmp_path, capsys):
    """A bag compressed as a whole is refused; the message names the mode of rosbag2."""
    rosbag2 = pytest.importorskip('rosbags.rosbag2')
    from rosbags.typesys import get_typestore, Stores
    for mode in ('FILE', 'MESSAGE'):
        bag = rosbag2.Writer(tmp_path / mode, version=9)
        bag.set_compression(rosbag2.CompressionMode[mode], rosbag2.CompressionFormat.ZSTD)
        with bag:
            connection = bag.add_connection('/imu', topics.IMU, typestore=get_typestore(
                Stores.ROS2_JAZZY))
            bag.write(connection, 5, topics.IMU_RAW.writer().pack(5, (0.0,) * 3, (0.0,) * 3))
        refused(tmp_path / mode, f'is compressed by {mode.lower()}', capsys)
    refused(tmp_path / 'FILE' / 'FILE.db3.zstd', 'is compressed as a file', capsys)


def test_topics_that_are_not_as_expected(tmp_path):
    """
    A topic that cannot be read into arrays gives one message each.

    Causes: missing, of another type, of a type without a layout, not CDR, without a field.
    """
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('imu/data_raw', topics.IMU)
        bag.add_topic('sim/status', topics.STRING)
        bag.add_topic('json', topics.IMU, encoding='json')
        bag.add_topic('short', topics.IMU)
        bag.add_topic('big', topics.IMU)
        bag.write('short', 1, b'\x00\x01\x00\x00' + bytes(50))
        bag.write('big', 1, b'\x00\x00\x00\x00' + bytes(500))
    with open_bag(tmp_path / 'bag') as bag:
        for arguments, sentence in (
                (('imu/dataraw',), 'no topic /imu/dataraw; the nearest is /imu/data_raw'),
                (('imu/data_raw', None, topics.ODOMETRY), 'has the type sensor_msgs/msg/Imu; '
                                                          'expected nav_msgs/msg/Odometry'),
                (('sim/status',), 'std_msgs/msg/String cannot be read into arrays; expected one'),
                (('json',), "is serialized as 'json'; expected cdr"),
                (('short',), '/short: sensor_msgs/msg/Imu of 54 bytes ends too early'),
                (('big',), 'expected the encapsulation of little-endian CDR'),
                (('imu/data_raw', ['rate']), "has no field 'rate'; expected one of orientation")):
            with pytest.raises(ValueError, match=sentence):
                bag.arrays(*arguments)
        with pytest.raises(ValueError, match='no topic /x'):
            list(bag.messages(['x']))


def test_what_cannot_be_written(tmp_path):
    """Unknown options, types and topics, existing bags and negative times are refused."""
    for options, sentence in (
            ({'storage': 'rocks'}, 'expected one of mcap, sqlite3'),
            ({'compression': 'gzip'}, 'expected one of none, lz4, zstd'),
            ({'storage': 'sqlite3', 'compression': 'lz4'}, 'sqlite3 cannot be compressed')):
        with pytest.raises(ValueError, match=sentence):
            BagWriter(tmp_path / 'bag', **options)
    assert not (tmp_path / 'bag').exists()
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('/imu', topics.IMU)
        with pytest.raises(ValueError, match='/imu is declared twice'):
            bag.add_topic('imu', topics.IMU)
        with pytest.raises(ValueError, match="type 'my_msgs/msg/Thing' is not known"):
            bag.add_topic('/x', 'my_msgs/msg/Thing')
        with pytest.raises(ValueError, match='is not a list of quality of service'):
            bag.add_topic('/x', topics.IMU, 'a: 1')
        with pytest.raises(ValueError, match='/y is not declared'):
            bag.write('/y', 0, b'')
        for t_ns in (-1, 2**63):
            with pytest.raises(ValueError, match='expected 0 or later'):
                bag.write('imu', t_ns, b'')
        block = topics.IMU_RAW.writer().block([1, 2], np.zeros((2, 6)))
        with pytest.raises(ValueError, match='1 log times for 2 messages'):
            bag.write_blocks({'imu': ([1], block)})
        with pytest.raises(ValueError, match='expected 0 or later'):
            bag.write_blocks({'imu': ([-1, 1], block)})
        with pytest.raises(ValueError, match='which a ROS stamp can hold'):
            topics.IMU_RAW.writer().block([2**31 * 10**9], np.zeros((1, 6)))
    with pytest.raises(ValueError, match='exists; expected a new path'):
        BagWriter(tmp_path / 'bag')


def test_a_bag_is_replaced_only_when_the_new_one_is_whole(tmp_path):
    """The old bag is kept until the new one is complete, and only a bag is ever replaced."""
    path = write(tmp_path / 'bag')
    before = (path / 'bag_0.mcap').read_bytes()
    bag = BagWriter(path, 'sqlite3', replace=True)
    bag.add_topic('x', topics.IMU)
    bag.flush()
    bag.abort()
    assert (path / 'bag_0.mcap').read_bytes() == before
    with BagWriter(path, 'sqlite3', replace=True):
        assert (path / 'bag_0.mcap').read_bytes() == before
    assert sorted(f.name for f in path.iterdir()) == ['.ins_sim', 'bag_0.db3', 'metadata.yaml']
    assert [f.name for f in tmp_path.iterdir()] == ['bag']
    (tmp_path / 'other').mkdir()
    (tmp_path / 'other' / 'precious').write_text('x')
    with pytest.raises(ValueError, match='other: it has no marker .ins_sim of ins_sim; --force '
                                         'replaces only what the same command wrote'):
        BagWriter(tmp_path / 'other', replace=True)


@pytest.fixture
def nobody():
    """Run the test as a user without rights (if root), in a folder that this user may enter."""
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o755)
    yield folder, lambda: os.getuid() or os.seteuid(65534)
    os.getuid() or os.seteuid(0)
    folder.chmod(0o755)
    shutil.rmtree(folder)


def test_no_permission(nobody, capsys):
    """Without permission to read a file or to write into a folder, both verbs give one message."""
    folder, become = nobody
    write(folder / 'bag')
    (folder / 'bag' / 'bag_0.mcap').chmod(0)
    write(folder / 'db', 'sqlite3')
    (folder / 'db' / 'db_0.db3').chmod(0)
    # Modules must be imported before, because this user may not read them.
    arguments = ['simulate', '-p', 'duration_s:=1.0', '--no-twin', '-o']
    assert main([*arguments, str(folder / 'first'), '--bag', str(folder / 'first_bag')]) == 0
    folder.chmod(0o555)
    become()
    refused(folder / 'bag', 'Permission denied', capsys)
    refused(folder / 'db', 'Permission denied', capsys)
    with pytest.raises(OSError, match='Permission denied'):
        BagWriter(folder / 'new')
    assert main([*arguments, str(folder / 'run'), '--bag', str(folder / 'new')]) == 2
    assert capsys.readouterr().err.count('\n') == 1
