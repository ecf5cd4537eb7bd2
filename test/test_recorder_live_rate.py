"""The whole chain at 1 kHz in real time, recorded: nothing is lost."""

import os
from pathlib import Path
import re
import shutil
import signal

from ins_sim.bags.bag_reader import open_bag
from ins_sim.messages import topics
from live import Chain
import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

RATE_HZ = 1000
DT_NS = 1_000_000
TOPICS = [topic.name for topic in (*topics.DATA, topics.CLOCK_TOPIC)]
# A publisher repairs what its transport drops at its next heartbeat, which DDS sends every 3 s:
# what it keeps must last longer.
DEPTH = 10_000


def cpu_s(process):
    """Return the CPU seconds a running process has used."""
    fields = Path(f'/proc/{process.pid}/stat').read_text().rsplit(')', 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


@pytest.mark.parametrize('duration_s', [
    5, pytest.param(60, marks=pytest.mark.slow), pytest.param(600, marks=pytest.mark.slow)])
def test_nothing_is_lost_at_1_khz(duration_s, ros_domain, tmp_path):
    """
    Twelve topics, the generator free-running: no gap in the publishers' numbers or the stamps.

    Samples before the nodes have found each other are no loss of the recorder; from the first
    one recorded of a topic on, every one is there, to the last.  The better of two: another load
    on the machine is no fault of ours.
    """
    whole = 0
    for attempt in range(2):
        folder = tmp_path / str(attempt)
        folder.mkdir()
        whole = record(duration_s, ros_domain, folder)
        shutil.rmtree(folder / 'bag')
        if whole == len(TOPICS):
            break
    assert whole == len(TOPICS)


def record(duration_s, domain, folder):
    """Record the chain; print what came of each topic and return of how many nothing is lost."""
    chain, path = Chain(domain, folder), folder / 'bag'
    parameters = {'rate_hz': float(RATE_HZ), 'duration_s': float(duration_s),
                  'topics.depth': DEPTH}
    try:
        recorder = chain.start('recorder', {'record.topics': f'[{", ".join(TOPICS)}]',
                                            'storage.path': path})
        for node in ('strapdown', 'imu_sensor'):
            chain.start(node, parameters)
        chain.wait_text(recorder, 'waiting for ')
        generator = chain.start('motion_generator', {**parameters, 'publish_clock': 'true'})
        assert generator.wait(duration_s + 60.0) == 0, chain.text(generator)
        used_s = cpu_s(recorder)
        recorder.send_signal(signal.SIGINT)
        assert recorder.wait(60.0) == 0, chain.text(recorder)
    finally:
        chain.end()
    said = re.findall(r'/(\S+) \(\S+\): (\d+) recorded, (\d+) lost', chain.text(recorder))
    print(f'\n{duration_s} s, {used_s:.1f} s CPU = {used_s / duration_s:.0%} of a core')
    with open_bag(path) as bag:
        assert not bag.cut
        whole, tables = 0, bag.tables({name: () for name, _, _ in said})
        for name, count, lost in said:
            table = tables[name]
            stamps = table['stamp_ns']
            period = DT_NS * (10 if name == 'clock' else 1)
            gaps = stamps[:-1][np.diff(stamps) != period] / 1e9
            print(f'{name}: {count} recorded, {lost} lost, from {stamps[0] / 1e9:.3f} s, gaps '
                  f'behind {gaps[:9]}')
            assert len(stamps) == int(count) and np.array_equal(table['log_ns'], stamps)
            whole += lost == '0' and not len(gaps) and stamps[-1] == duration_s * 10**9
    assert {name for name, _, _ in said} == {name.lstrip('/') for name in TOPICS}
    return whole
