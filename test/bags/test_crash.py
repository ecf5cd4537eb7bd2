"""
If a writer is killed, or its disk is full, the data written so far can be read.

Such a bag is marked as truncated.
"""

import os
import signal
import subprocess
import sys

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.bags import mcap_writer
from ins_sim.cli.main import main
from ins_sim.messages import topics
import numpy as np
import pytest

KINDS = [('mcap', 'none'), ('mcap', 'zstd'), ('sqlite3', 'none')]
# A recorder at 100 Hz at full speed; after each flush it prints the number of messages written.
RECORDER = """
import sys
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.messages import topics
path, storage, compression, flush = sys.argv[1:]
bag = BagWriter(path, storage, compression)
bag.add_topic('imu/data_raw', topics.IMU)
pack = topics.IMU_RAW.writer().pack
k = 0
while True:
    bag.write('imu/data_raw', 10**7 * k, pack(10**7 * k, (k, 0.0, 0.0), (0.0, 0.0, 9.8)))
    k += 1
    if k % 250 == 0 and flush == 'flush':
        bag.flush()
    if k % 250 == 0:
        print(k, flush=True)
"""
# A recorder that never flushes may lose the last second of log time, ns.
UNFLUSHED = 101


@pytest.mark.parametrize('flush', ['flush', 'none'])
@pytest.mark.parametrize('storage, compression', KINDS)
def test_killed_in_the_middle(storage, compression, flush, tmp_path, capsys):
    """After SIGKILL all flushed data can be read; info reports a truncated bag, exit code 0."""
    path = tmp_path / 'bag'
    process = subprocess.Popen([sys.executable, '-c', RECORDER, path, storage, compression, flush],
                               stdout=subprocess.PIPE, text=True)
    handed = 0
    for line in process.stdout:
        handed = int(line)
        if handed >= 20_000:
            break
    process.send_signal(signal.SIGKILL)
    rest = process.communicate()[0].split()
    assert process.returncode == -signal.SIGKILL
    handed = max([handed, *(int(word) for word in rest[:-1])])
    with open_bag(path) as bag:
        assert 'it was not closed: there is no metadata.yaml' in bag.cut
        array = bag.arrays('imu/data_raw', ('angular_velocity',))
    assert np.array_equal(array['stamp_ns'], 10**7 * np.arange(len(array)))
    assert np.array_equal(array['angular_velocity'][:, 0], np.arange(len(array)))
    lost = handed - len(array)
    print(f'\n{storage}, {compression}, {flush}: {handed} messages handed over, {len(array)} kept')
    assert lost <= (0 if flush == 'flush' else UNFLUSHED)
    assert main(['info', str(path)]) == 0
    shown = capsys.readouterr().out
    assert 'state     cut: it was not closed' in shown and str(len(array)) in shown
    # Even a truncated bag is replaced only on request.
    assert main(['simulate', '-p', 'duration_s:=1.0', '-o', str(tmp_path / 'run'), '--bag',
                 str(path)]) == 2
    assert 'exists; expected a new path' in capsys.readouterr().err


FULL = """
import resource, signal, sys
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.messages import topics
path, storage, compression = sys.argv[1:]
# a file cannot grow beyond this, as if there were no room for more
resource.setrlimit(resource.RLIMIT_FSIZE, (5_000_000, 5_000_000))
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
pack = topics.IMU_RAW.writer().pack
try:
    with BagWriter(path, storage, compression) as bag:
        bag.add_topic('imu/data_raw', topics.IMU)
        for k in range(400_000):
            bag.write('imu/data_raw', 10**7 * k, pack(10**7 * k, (k ** 0.5,) * 3, (k * 1.1,) * 3))
except OSError as error:
    print(error)
    sys.exit(2)
"""


@pytest.mark.parametrize('storage, compression', KINDS)
def test_no_room_is_left(storage, compression, tmp_path):
    """On a full disk the error states how many messages are kept; exactly these can be read."""
    path = tmp_path / 'bag'
    result = subprocess.run([sys.executable, '-c', FULL, path, storage, compression],
                            capture_output=True, text=True)
    assert result.returncode == 2, result.stderr
    said = result.stdout.strip()
    assert said.count('\n') == 0 and 'messages written before are kept' in said
    kept = int(said.partition('; the ')[2].split()[0])
    with open_bag(path) as bag:
        assert 'not closed' in bag.cut
        stamps = bag.arrays('imu/data_raw')['stamp_ns']
    assert np.array_equal(stamps, 10**7 * np.arange(kept)) and kept > 1000


def test_a_full_disk_in_simulate(tmp_path, capsys, monkeypatch):
    """A full disk ends simulate with exit code 2 and one message; the unclosed bag can be read."""
    writev, left = os.writev, [5_000_000]

    def full(descriptor, parts):
        left[0] -= sum(part.nbytes for part in parts)
        if left[0] < 0:
            # Like the kernel: write what fits, then nothing more.
            os.write(descriptor, bytes(parts[0])[:20])
            raise OSError(28, 'No space left on device')
        return writev(descriptor, parts)

    monkeypatch.setattr(mcap_writer.os, 'writev', full)
    assert main(['simulate', '-p', 'duration_s:=120.0', '--no-twin', '-o', str(tmp_path / 'run'),
                 '--bag', str(tmp_path / 'bag')]) == 2
    said = capsys.readouterr().err
    assert 'No space left on device; the ' in said and 'are kept' in said and said.count('\n') == 1
    kept = int(said.partition('; the ')[2].split()[0])
    with open_bag(tmp_path / 'bag') as bag:
        assert sum(span.count for span in bag.spans().values()) == kept > 1000
        assert bag.cut == ('it was not closed: there is no metadata.yaml; bag_0.mcap ends '
                           'without a summary')


def test_closing_on_a_full_disk_keeps_the_messages(tmp_path, monkeypatch):
    """Without room for the summary the file is truncated, and its messages can be read."""
    bag = BagWriter(tmp_path / 'bag')
    bag.add_topic('imu', topics.IMU)
    bag.write('imu', 5, topics.IMU_RAW.writer().pack(5, (0.0,) * 3, (0.0,) * 3))
    bag.flush()

    def full(descriptor, parts):
        os.write(descriptor, b'half')
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(mcap_writer.os, 'writev', full)
    with pytest.raises(OSError, match='the 1 messages written before are kept'):
        bag.close()
    with open_bag(tmp_path / 'bag') as read:
        assert len(list(read.messages())) == 1 and read.cut


def test_a_bag_in_writing_can_be_read(tmp_path):
    """Flushed data can be read in both storages while the writer continues."""
    for storage in ('mcap', 'sqlite3'):
        with BagWriter(tmp_path / storage, storage) as bag:
            bag.add_topic('imu', topics.IMU)
            for k in range(3):
                bag.write('imu', k, topics.IMU_RAW.writer().pack(k, (0.0,) * 3, (0.0,) * 3))
                bag.flush()
                with open_bag(tmp_path / storage) as read:
                    assert read.cut and len(read.arrays('imu')) == k + 1
        with open_bag(tmp_path / storage) as read:
            assert not read.cut and len(read.arrays('imu')) == 3


def test_an_error_in_the_middle_leaves_a_cut_bag(tmp_path):
    """An unfinished bag of a recorder is kept as a truncated one; a discarded bag is deleted."""
    with pytest.raises(RuntimeError), BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('imu', topics.IMU)
        bag.write('imu', 1, topics.IMU_RAW.writer().pack(1, (0.0,) * 3, (0.0,) * 3))
        bag.flush()
        raise RuntimeError
    with open_bag(tmp_path / 'bag') as read:
        assert read.cut and len(read.arrays('imu')) == 1
    bag = BagWriter(tmp_path / 'gone')
    bag.discard()
    assert not (tmp_path / 'gone').exists()
