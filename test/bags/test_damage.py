"""Of truncated or corrupt bags the complete parts are read; the rest gives one message."""

import sqlite3

from ins_sim.bags import mcap_format as form
from ins_sim.bags.bag_reader import open_bag
from ins_sim.cli.main import main
import numpy as np
import pytest
from support.hostile.damaged import refused, write

N = 20_000
STAMPS = np.arange(N) * 10**7


@pytest.mark.parametrize('compression', ['none', 'lz4', 'zstd'])
def test_a_cut_file_gives_its_whole_chunks(compression, tmp_path, capsys):
    """Wherever a file is cut, its complete chunks are read in order, with a note."""
    file = write(tmp_path / 'bag', 'mcap', compression) / 'bag_0.mcap'
    data, last = file.read_bytes(), -1
    for size in [*range(0, len(data), max(1, len(data) // 97)), len(data) - 1]:
        path = tmp_path / 'cut.mcap'
        path.write_bytes(data[:size])
        if size < 8:
            refused(path, 'is empty' if not size else '; expected an MCAP file', capsys)
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
    """
    A damaged last chunk of a truncated file is left out, as after a crash of the machine.

    After a crash the length of a file may be right but not its data.
    """
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
        assert 'its last chunk is left out' in bag.cut and 'its checksum is wrong' in bag.cut


def test_a_folder_without_metadata_is_cut(tmp_path, capsys):
    """
    Files of a bag without metadata.yaml are read in the order of their numbers.

    The command info reports that the bag was not closed.
    """
    write(tmp_path / 'bag', split_bytes=500_000)
    (tmp_path / 'bag' / 'metadata.yaml').unlink()
    with open_bag(tmp_path / 'bag') as bag:
        assert [f.name for f in bag.files] == [f'bag_{k}.mcap' for k in range(len(bag.files))]
        assert np.array_equal(bag.arrays('imu/data_raw')['stamp_ns'], STAMPS)
    assert main(['info', str(tmp_path / 'bag')]) == 0
    assert 'cut: it was not closed: there is no metadata.yaml' in capsys.readouterr().out


def test_a_folder_with_both_storages_is_no_bag(tmp_path, capsys):
    """A folder with files of both storages is refused, because it is ambiguous."""
    for storage in ('mcap', 'sqlite3'):
        write(tmp_path / storage, storage)
    (tmp_path / 'sqlite3' / 'sqlite3_0.db3').rename(tmp_path / 'mcap' / 'x.db3')
    (tmp_path / 'mcap' / 'metadata.yaml').unlink()
    refused(tmp_path / 'mcap', 'is not a bag', capsys)


def test_corrupt_chunks_are_found(tmp_path, capsys):
    """A flipped bit in a chunk, an index, the summary or a length is reported."""
    path = write(tmp_path / 'bag') / 'bag_0.mcap'
    data = path.read_bytes()

    def flipped(position):
        path.write_bytes(data[:position] + bytes([data[position] ^ 0x10]) + data[position + 1:])

    chunk = data.index(b'\x00\x01\x00\x00')
    flipped(chunk + 200)
    refused(path, 'a chunk cannot be read: its checksum is wrong', capsys, read=True)
    flipped(len(data) - 200)
    refused(path, 'the checksum of the summary is wrong', capsys)
    flipped(len(data) - 30)
    refused(path, 'is corrupt', capsys)
    index = _first(data, form.MESSAGE_INDEX)
    flipped(index + 9 + 6 + 3)
    refused(path, 'a message index does not fit its chunk', capsys, read=True)
    flipped(index + 9 + 6 + 13)
    refused(path, 'a message index points beyond its chunk', capsys, read=True)
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
    """A page of noise in the middle of an SQLite file, and a truncated file, are reported."""
    path = write(tmp_path / 'bag', 'sqlite3') / 'bag_0.db3'
    data = path.read_bytes()
    path.write_bytes(data[:len(data) // 2] + b'\xaa' * 65536 + data[len(data) // 2 + 65536:])
    refused(path, 'is corrupt', capsys, read=True)
    path.write_bytes(data[:len(data) // 2])
    refused(path, 'is corrupt', capsys, read=True)


def test_values_of_the_wrong_kind_in_a_database(tmp_path, capsys):
    """
    Values of the wrong kind in an SQLite file are reported.

    Strings in place of bytes, NULL in place of times, numbers as names, messages without a topic.
    """
    for k, (statement, sentence) in enumerate((
            ("UPDATE messages SET data = 'some text' WHERE id = 5", 'data of the wrong type'),
            ("UPDATE messages SET timestamp = 'late' WHERE id = 5", 'data of the wrong type'),
            ('UPDATE messages SET timestamp = 1.5 WHERE id = 5', 'data of the wrong type'))):
        path = next(write(tmp_path / str(k), 'sqlite3').glob('*.db3'))
        _change(path, statement)
        refused(path, sentence, capsys, read=True)
    for statement, sentence in (
            ("UPDATE topics SET name = x'ff'", 'has a value of the wrong type'),
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
    """A database with an endless view in place of the messages is refused."""
    path = next(write(tmp_path / 'bag', 'sqlite3').glob('*.db3'))
    database = sqlite3.connect(path)
    database.execute('DROP TABLE messages')
    database.execute('CREATE VIEW messages AS WITH RECURSIVE c(id) AS (SELECT 1 UNION ALL SELECT '
                     "id FROM c) SELECT id, 1 AS topic_id, 1 AS timestamp, x'00' AS data FROM c")
    database.commit()
    database.close()
    refused(path, 'reading its tables takes too many steps', capsys)
