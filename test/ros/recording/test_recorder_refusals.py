"""Refusals of the recorder, and the bag after a full disk."""

from pathlib import Path
import subprocess

from ins_sim import parameter_files, resources
from ins_sim.bags.bag_reader import open_bag
from support.live import Chain
import pytest
from support.nodes.talker import Talker
from support.nodes.recorder import summary

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live


@pytest.fixture
def small_disk(tmp_path):
    """Return a folder on a file system of 3 MB; skip the test if there is none."""
    folder = tmp_path / 'small'
    folder.mkdir()
    mounted = subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=3m', 'tmpfs', folder],
                             capture_output=True, text=True)
    if mounted.returncode:
        pytest.skip(f'no file system can be mounted: {mounted.stderr.strip()}')
    yield folder
    subprocess.run(['umount', folder], check=True)


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_full_disk(storage, small_disk, ros_domain, tmp_path):
    """A full disk gives exit code 3, one message, and a bag with the reported messages."""
    talker, chain = Talker(ros_domain), Chain(ros_domain, tmp_path)
    path = small_disk / 'bag'
    try:
        imu = talker.imu()
        recorder = chain.start_verb('record', 'imu', '-o', path, '--storage', storage)
        talker.wait_matched(imu)
        k = 0
        while recorder.poll() is None:
            imu.publish(talker.imu_bytes(k * 10**6))
            k += 1
            assert k < 10**6
        text = chain.text(recorder)
        assert recorder.returncode == 3, text
    finally:
        chain.end()
        talker.close()
    said = text[text.index('FATAL'):].splitlines()[0]
    assert ('No space left' in said or 'disk is full' in said) and 'are kept' in said
    count = summary(text)['/imu'][1]
    with open_bag(path) as bag:
        assert bag.cut and len(list(bag.messages())) == count > 1000
    assert f' {count} messages written before are kept' in said


def refused(chain, *words):
    """Return the last line of a verb record that ends with code 2."""
    recorder = chain.start_verb('record', *words)
    assert recorder.wait(30.0) == 2, chain.text(recorder)
    text = chain.text(recorder)
    assert 'Traceback' not in text
    return text.strip().splitlines()[-1]


def test_what_is_refused(ros_domain, tmp_path):
    """Invalid arguments of record give one message and exit code 2; files are unchanged."""
    chain = Chain(ros_domain, tmp_path)
    old = tmp_path / 'old'
    old.mkdir()
    (old / 'notes.txt').write_text('mine')
    for words, sentence in (
            (['imu', '-o', old], 'old exists; expected a new path for the bag'),
            (['imu', '-o', old, '--force'], 'old: it has no marker .ins_sim of ins_sim; '
             '--force replaces only what the same command wrote'),
            (['imu', '-o', '/sys/bag'], "Operation not permitted: '/sys/bag'"),
            (['imu raw', '-o', tmp_path / 'new'], 'record.topics: Invalid topic name: topic name '
                                                  'must not contain characters other than'),
            ([], 'record.topics is empty and record.all_topics false; expected topics'),
            (['imu', '--storage', 'sqlite3', '--compression', 'zstd', '-o', tmp_path / 'new'],
             'sqlite3 cannot be compressed'),
            (['imu', '--max-size', '-1'], 'storage.split_mb is -1 MB; expected 0 to 1e+09 MB'),
            (['imu', '--ros-args', '-p', 'record.dept:=5'],
             "unknown parameter 'record.dept'; the nearest known one is 'record.depth'")):
        assert sentence in refused(chain, *words)
    assert [p.name for p in old.iterdir()] == ['notes.txt']
    assert (old / 'notes.txt').read_text() == 'mine' and not (tmp_path / 'new').exists()


def test_force_replaces_a_bag(ros_domain, tmp_path):
    """With --force the old bag is kept until the new one is complete."""
    chain, talker = Chain(ros_domain, tmp_path), Talker(ros_domain)
    path = tmp_path / 'bag'
    try:
        imu = talker.imu()
        for first, more in ((0, ()), (100, ('--force',))):
            recorder = chain.start_verb('record', 'imu', '-o', path, *more)
            chain.wait_text(recorder, 'recording /imu')
            talker.wait_matched(imu)
            for k in range(first, first + 10):
                imu.publish(talker.imu_bytes(k))
            if more:
                with open_bag(path) as bag:
                    assert [t for _, t, _ in bag.messages()] == list(range(10))
            assert chain.processes and recorder.poll() is None
            recorder.send_signal(2)
            assert recorder.wait(30.0) == 0, chain.text(recorder)
            while imu.get_subscription_count():
                pass
    finally:
        chain.end()
        talker.close()
    with open_bag(path) as bag:
        assert [t for _, t, _ in bag.messages()] == list(range(100, 110))
    assert sorted(p.name for p in tmp_path.iterdir() if p.is_dir()) == ['bag']


def test_a_parameter_file_serves_every_node(ros_domain, tmp_path):
    """The section of the recorder is read by ROS, ignored by offline commands, and checked."""
    chain = Chain(ros_domain, tmp_path)
    path = tmp_path / 'p.yaml'
    path.write_text('/**:\n  ros__parameters: {rate_hz: 50.0}\n/**/recorder:\n  ros__parameters: '
                    f'{{record: {{topics: [imu]}}, storage: {{path: {tmp_path / "bag"}}}}}\n')
    recorder = chain.start('recorder', {}, ['--params-file', str(resources.config('default')),
                                            '--params-file', str(path)])
    chain.wait_text(recorder, f'recording into {tmp_path / "bag"}')
    assert set(chain.end().values()) == {0}
    assert (tmp_path / 'bag' / 'metadata.yaml').exists()
    assert parameter_files.read([path]).strapdown.rate_hz == 50.0
    Path(path).write_text('/**/recorder:\n  ros__parameters: {storage: {pth: here}}')
    with pytest.raises(ValueError, match="unknown parameter 'storage.pth'; the nearest known one "
                                         "is 'storage.path'"):
        parameter_files.read([path])
