"""Bags that are cut, corrupt, foreign or in the way: one sentence each, and exit code 2."""

import os
from pathlib import Path
import shutil
import sqlite3
import tempfile

from ins_sim.bags import mcap_format as form
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.cli.main import main
from ins_sim.messages import topics
from ins_sim.messages.cdr import Writer
import numpy as np
import pytest

N = 20_000
STAMPS = np.arange(N) * 10**7


def write(path, storage='mcap', compression='none', **options):
    """Write N readings of an IMU and a few acknowledgements."""
    imu, ack = topics.IMU_RAW.writer(), Writer(topics.HEADER, 'recorder')
    with BagWriter(path, storage, compression, **options) as bag:
        bag.add_topic('imu/data_raw', topics.IMU)
        bag.add_topic('sim/ack', topics.HEADER)
        for first in range(0, N, 5000):
            stamps = STAMPS[first:first + 5000]
            bag.write_blocks({
                'imu/data_raw': (stamps, imu.block(stamps, np.ones((len(stamps), 6)))),
                'sim/ack': (stamps[::10], ack.block(stamps[::10]))})
    return path


def refused(path, sentence, capsys, read=False):
    """Check that a bag is refused by info (or when it is read) with a sentence, exit code 2."""
    if not read:
        assert main(['info', str(path)]) == 2
        said = capsys.readouterr().err
        assert said.count('\n') == 1 and sentence in said, said
        return
    for use in (lambda bag: bag.arrays('imu/data_raw'), lambda bag: list(bag.messages())):
        with pytest.raises(ValueError, match=sentence) as caught:
            with open_bag(path) as bag:
                use(bag)
        assert '\n' not in str(caught.value)


def test_what_is_no_bag(tmp_path, capsys):
    """Nothing, a folder of something else, a text, an empty file, another database."""
    refused(tmp_path / 'absent', 'does not exist', capsys)
    refused(tmp_path, 'is no bag; expected metadata.yaml', capsys)
    (tmp_path / 'text.csv').write_text('a,b\n')
    refused(tmp_path / 'text.csv', 'is no bag; expected a folder', capsys)
    for suffix, sentence in (('mcap', 'is no MCAP file'), ('db3', 'is no SQLite file')):
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
    refused(tmp_path, 'is no bag', capsys)


@pytest.mark.parametrize('text, sentence', [
    ('', 'has no rosbag2_bagfile_information'), ('[1, 2]', 'has no rosbag2_bagfile_information'),
    ('a: [', 'is no YAML'), ('\x00', 'is no YAML'), ('[' * 3000, 'is no YAML'),
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
    """metadata.yaml that is broken, too new, or of a bag that is compressed as a whole."""
    (tmp_path / 'metadata.yaml').write_text(text)
    refused(tmp_path, sentence, capsys)


def test_metadata_that_is_no_text(tmp_path, capsys):
    """Neither UTF-8 nor a file that stands for another outside of the bag."""
    (tmp_path / 'metadata.yaml').write_bytes(b'\xff\xfe\x00')
    refused(tmp_path, 'is no UTF-8', capsys)
    write(tmp_path / 'bag')
    text = (tmp_path / 'bag' / 'metadata.yaml').read_text()
    (tmp_path / 'bag' / 'metadata.yaml').write_text(
        text.replace('- bag_0.mcap', '- ../../../bag_0.mcap'))
    with open_bag(tmp_path / 'bag') as bag:
        assert bag.files == [tmp_path / 'bag' / 'bag_0.mcap']


def test_bags_compressed_by_rosbags_as_a_whole(tmp_path, capsys):
    """Both modes of rosbag2's own compression are refused by name."""
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


@pytest.mark.parametrize('compression', ['none', 'lz4', 'zstd'])
def test_a_cut_file_gives_its_whole_chunks(compression, tmp_path, capsys):
    """Wherever it is cut: whole chunks, in order, and a note that says so."""
    file = write(tmp_path / 'bag', 'mcap', compression) / 'bag_0.mcap'
    data, last = file.read_bytes(), -1
    for size in [*range(0, len(data), max(1, len(data) // 97)), len(data) - 1]:
        path = tmp_path / 'cut.mcap'
        path.write_bytes(data[:size])
        if size < 8:
            refused(path, 'is empty' if not size else 'is no MCAP file', capsys)
            continue
        with open_bag(path) as bag:
            assert 'cut.mcap' in bag.cut
            if 'imu/data_raw' not in {n.lstrip('/') for n in bag.topics}:
                assert last <= 0
                continue
            stamps = bag.arrays('imu/data_raw')['stamp_ns']
            assert np.array_equal(stamps, STAMPS[:len(stamps)]) and len(stamps) >= last
            count = sum(span.count for span in bag.spans().values())
            assert count == sum(1 for _ in bag.messages()) >= len(stamps)
            last = len(stamps)
    assert last == N
    assert main(['info', str(path)]) == 0
    assert 'state     cut: cut.mcap' in capsys.readouterr().out


def test_a_last_chunk_that_is_damaged_is_left_out_of_a_cut_file(tmp_path):
    """As a crash of the machine may leave it: the length is there, the data are not."""
    path = write(tmp_path / 'bag') / 'bag_0.mcap'
    data, position, chunks = path.read_bytes(), len(form.MAGIC), []
    while data[position] != form.DATA_END:
        if data[position] == form.CHUNK:
            chunks.append(position)
        position += form.RECORD.size + form.RECORD.unpack_from(data, position)[1]
    stop = chunks[-1] + form.RECORD.size + form.RECORD.unpack_from(data, chunks[-1])[1]
    path.write_bytes(data[:stop - 5000] + bytes(5000))
    with open_bag(path) as bag:
        stamps = bag.arrays('imu/data_raw')['stamp_ns']
        assert np.array_equal(stamps, STAMPS[:len(stamps)]) and N / 2 < len(stamps) < N
        assert 'its last chunk is left out' in bag.cut and 'another checksum' in bag.cut


def test_a_folder_without_metadata_is_cut(tmp_path, capsys):
    """Its files are found in the order of their numbers, and info says that it was not closed."""
    write(tmp_path / 'bag', split_bytes=500_000)
    (tmp_path / 'bag' / 'metadata.yaml').unlink()
    with open_bag(tmp_path / 'bag') as bag:
        assert [f.name for f in bag.files] == [f'bag_{k}.mcap' for k in range(len(bag.files))]
        assert np.array_equal(bag.arrays('imu/data_raw')['stamp_ns'], STAMPS)
    assert main(['info', str(tmp_path / 'bag')]) == 0
    assert 'cut: it was not closed: there is no metadata.yaml' in capsys.readouterr().out


def test_a_folder_with_both_storages_is_no_bag(tmp_path, capsys):
    """Nobody can tell which is meant."""
    for storage in ('mcap', 'sqlite3'):
        write(tmp_path / storage, storage)
    (tmp_path / 'sqlite3' / 'sqlite3_0.db3').rename(tmp_path / 'mcap' / 'x.db3')
    (tmp_path / 'mcap' / 'metadata.yaml').unlink()
    refused(tmp_path / 'mcap', 'is no bag', capsys)


def test_corrupt_chunks_are_found(tmp_path, capsys):
    """A flipped bit in a chunk, in an index, in the summary, in a length."""
    path = write(tmp_path / 'bag') / 'bag_0.mcap'
    data = path.read_bytes()

    def flipped(position):
        path.write_bytes(data[:position] + bytes([data[position] ^ 0x10]) + data[position + 1:])

    chunk = data.index(b'\x00\x01\x00\x00')
    flipped(chunk + 200)
    refused(path, 'a chunk cannot be read: it has another checksum', capsys, read=True)
    flipped(len(data) - 200)
    refused(path, 'the summary has another checksum', capsys)
    flipped(len(data) - 30)
    refused(path, 'is corrupt', capsys)
    index = _first(data, form.MESSAGE_INDEX)
    flipped(index + 9 + 6 + 3)
    refused(path, 'a message index does not fit its chunk', capsys, read=True)
    flipped(index + 9 + 6 + 13)
    refused(path, 'a message index points behind its chunk', capsys, read=True)
    flipped(_first(data, form.CHUNK) + 5)
    refused(path, 'is longer than the file', capsys)


def _first(data, opcode):
    """Return the position of the first record of an opcode."""
    position = len(form.MAGIC)
    while True:
        found, length = form.RECORD.unpack_from(data, position)
        if found == opcode:
            return position
        position += form.RECORD.size + length


def test_a_corrupt_database_is_found(tmp_path, capsys):
    """A page of noise in the middle, and a cut file."""
    path = write(tmp_path / 'bag', 'sqlite3') / 'bag_0.db3'
    data = path.read_bytes()
    path.write_bytes(data[:len(data) // 2] + b'\xaa' * 65536 + data[len(data) // 2 + 65536:])
    refused(path, 'is corrupt', capsys, read=True)
    path.write_bytes(data[:len(data) // 2])
    refused(path, 'is corrupt', capsys, read=True)


def test_values_of_the_wrong_kind_in_a_database(tmp_path, capsys):
    """Texts for bytes, nothing for times, names that are numbers, messages of no topic."""
    for k, (statement, sentence) in enumerate((
            ("UPDATE messages SET data = 'some text' WHERE id = 5", 'is no time with bytes'),
            ("UPDATE messages SET timestamp = 'late' WHERE id = 5", 'is no time with bytes'),
            ('UPDATE messages SET timestamp = 1.5 WHERE id = 5', 'is no time with bytes'))):
        path = next(write(tmp_path / str(k), 'sqlite3').glob('*.db3'))
        _change(path, statement)
        refused(path, sentence, capsys, read=True)
    for statement, sentence in (
            ("UPDATE topics SET name = x'ff'", 'is no number with texts'),
            ('DELETE FROM topics WHERE id = 1', 'does not declare')):
        path = next(write(tmp_path / statement[:6], 'sqlite3').glob('*.db3'))
        _change(path, statement)
        refused(path, sentence, capsys)


def _change(path, statement):
    database = sqlite3.connect(path)
    database.execute(statement)
    database.commit()
    database.close()


def test_a_database_that_never_ends(tmp_path, capsys):
    """A view that counts for ever in the place of the messages is given up."""
    path = next(write(tmp_path / 'bag', 'sqlite3').glob('*.db3'))
    database = sqlite3.connect(path)
    database.execute('DROP TABLE messages')
    database.execute('CREATE VIEW messages AS WITH RECURSIVE c(id) AS (SELECT 1 UNION ALL SELECT '
                     "id FROM c) SELECT id, 1 AS topic_id, 1 AS timestamp, x'00' AS data FROM c")
    database.commit()
    database.close()
    refused(path, 'its tables go round in circles', capsys)


def test_topics_that_are_not_as_expected(tmp_path):
    """Missing, of another type, of a type without a layout, not CDR, a field that is not there."""
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
    """Unknown storage, compression, type, topic; a bag that is there; times before zero."""
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
        with pytest.raises(ValueError, match='is no list of quality of service'):
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
    """What was there stays until then, and only a bag is replaced at all."""
    path = write(tmp_path / 'bag')
    before = (path / 'bag_0.mcap').read_bytes()
    bag = BagWriter(path, 'sqlite3', replace=True)
    bag.add_topic('x', topics.IMU)
    bag.flush()
    bag.abort()
    assert (path / 'bag_0.mcap').read_bytes() == before
    with BagWriter(path, 'sqlite3', replace=True):
        assert (path / 'bag_0.mcap').read_bytes() == before
    assert sorted(f.name for f in path.iterdir()) == ['bag_0.db3', 'metadata.yaml']
    assert [f.name for f in tmp_path.iterdir()] == ['bag']
    (tmp_path / 'other').mkdir()
    (tmp_path / 'other' / 'precious').write_text('x')
    with pytest.raises(ValueError, match='is no bag; only a bag is replaced'):
        BagWriter(tmp_path / 'other', replace=True)


@pytest.fixture
def nobody():
    """Run the test as a user that owns nothing, if as root; give a folder that it may enter."""
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o755)
    yield folder, lambda: os.getuid() or os.seteuid(65534)
    os.getuid() or os.seteuid(0)
    folder.chmod(0o755)
    shutil.rmtree(folder)


def test_no_permission(nobody, capsys):
    """To read a file, and to write into a folder; by both verbs."""
    folder, become = nobody
    write(folder / 'bag')
    (folder / 'bag' / 'bag_0.mcap').chmod(0)
    write(folder / 'db', 'sqlite3')
    (folder / 'db' / 'db_0.db3').chmod(0)
    # what is imported when it is needed must be there: nobody may not read it
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
