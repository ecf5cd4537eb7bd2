"""The end of a recording: splits, signals at any time, SIGKILL."""

import signal
import time

from ins_sim.bags.bag_reader import open_bag
from ins_sim.cli.main import main
import pytest
from support.nodes.recorder import end, send

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live
KINDS = [('mcap', 'none'), ('mcap', 'zstd'), ('sqlite3', 'none')]


@pytest.mark.parametrize('storage, options', [
    ('mcap', ('--max-duration', '1.0')), ('sqlite3', ('--max-duration', '1.0')),
    ('mcap', ('--max-size', '0.05')), ('sqlite3', ('--max-size', '0.05'))])
def test_splits(storage, options, talker, chain, tmp_path):
    """Split by time or by size the files are complete together, and each can be read alone."""
    imu = talker.imu()
    recorder = chain.start_verb('record', 'imu', '-o', tmp_path / 'bag', '--storage', storage,
                                *options)
    talker.wait_matched(imu)
    send(imu, [talker.imu_bytes(k * 10**7) for k in range(550)])
    assert end(chain, recorder)['/imu'][1:] == (550, '0 lost')
    with open_bag(tmp_path / 'bag') as bag:
        assert [t for _, t, _ in bag.messages()] == [k * 10**7 for k in range(550)]
        files = bag.files
    counts = []
    for file in files:
        with open_bag(file) as part:
            counts.append(len(list(part.messages())))
    print(f'\n{storage} {options}: {counts}')
    assert sum(counts) == 550 and len(files) >= 3
    if options[0] == '--max-duration':
        assert counts == [100, 100, 100, 100, 100, 50]


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize('storage, compression', KINDS)
def test_signals_leave_a_whole_bag(number, storage, compression, talker, chain, tmp_path):
    """A signal while messages arrive gives exit code 0, and the bag has all reported messages."""
    imu = talker.imu()
    recorder = chain.start_verb('record', 'imu', '-o', tmp_path / 'bag', '--storage', storage,
                                '--compression', compression)
    talker.wait_matched(imu)
    send(imu, [talker.imu_bytes(k * 10**6) for k in range(1000)], wait_s=0.0)
    _, count, rest = end(chain, recorder, number)['/imu']
    with open_bag(tmp_path / 'bag') as bag:
        assert not bag.cut and len(list(bag.messages())) == count
    assert rest == '0 lost' and count > 500


@pytest.mark.parametrize('numbers', [(signal.SIGINT,), (signal.SIGTERM,),
                                     (signal.SIGINT, signal.SIGINT)])
def test_signals_whenever_they_come(numbers, chain, tmp_path):
    """A signal at any time gives exit code 0, and no bag or a complete one."""
    for k in range(6):
        path = tmp_path / f'bag_{k}'
        recorder = chain.start_verb('record', '--all', '-o', path)
        # Before this the signal handlers are those of a verb, with its exit code.
        wait_started(chain, recorder, k)
        for number in numbers:
            recorder.send_signal(number)
            time.sleep(0.02)
        assert recorder.wait(30.0) == 0, chain.text(recorder)
        assert 'Traceback' not in chain.text(recorder)
        if path.exists():
            with open_bag(path) as bag:
                assert not bag.cut


def wait_started(chain, recorder, k):
    """Wait for the signal handlers of a node, longer for larger k."""
    end = time.monotonic() + 30.0
    while time.monotonic() < end:
        with open(f'/proc/{recorder.pid}/maps') as maps:
            if 'rclpy' in maps.read():
                break
        time.sleep(0.005)
    if k > 3:
        chain.wait_text(recorder, 'recording into')
    time.sleep(0.1 * k)


@pytest.mark.parametrize('storage, compression', KINDS)
def test_killed_in_the_middle(storage, compression, talker, chain, tmp_path, capsys):
    """After SIGKILL all but the last second is in the bag, which info reports as truncated."""
    imu = talker.imu()
    recorder = chain.start_verb('record', 'imu', '-o', tmp_path / 'bag', '--storage', storage,
                                '--compression', compression)
    talker.wait_matched(imu)
    send(imu, [talker.imu_bytes(k * 10**7) for k in range(1000)], wait_s=0.0)
    recorder.send_signal(signal.SIGKILL)
    recorder.wait(10.0)
    with open_bag(tmp_path / 'bag') as bag:
        stamps = [t for _, t, _ in bag.messages()]
    assert stamps == [k * 10**7 for k in range(len(stamps))] and len(stamps) >= 800
    assert main(['info', str(tmp_path / 'bag')]) == 0
    assert 'state     cut: it was not closed' in capsys.readouterr().out
