"""The whole chain at 1 kHz in real time is recorded without loss."""

import re
import signal

from ins_sim.bags.bag_reader import open_bag
from ins_sim.messages import topics
from support.live import Chain, GUARD_S
import numpy as np
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

RATE_HZ, LENGTH_S = 1000, 5
DT_NS = 1_000_000
TOPICS = [topic.name for topic in (*topics.DATA, topics.CLOCK_TOPIC)]
# A publisher resends lost samples at its next heartbeat, every 3 s by default in DDS: its queue
# must last longer.
DEPTH = 10_000


def test_nothing_is_lost_at_1_khz(ros_domain, tmp_path):
    """
    Twelve topics at 1 kHz have no gap in the numbers of the publishers or in the stamps.

    Samples before discovery are not counted; from the first recorded one of a topic on, all are
    there, to the last. Ten minutes of the same, and the CPU time, are printed by
    benchmarks/live_recorder.py.
    """
    chain, path = Chain(ros_domain, tmp_path), tmp_path / 'bag'
    parameters = {'rate_hz': float(RATE_HZ), 'duration_s': float(LENGTH_S),
                  'topics.depth': DEPTH}
    try:
        recorder = chain.start('recorder', {'record.topics': f'[{", ".join(TOPICS)}]',
                                            'storage.path': path})
        for node in ('strapdown', 'imu_sensor'):
            chain.start(node, parameters)
        chain.wait_text(recorder, 'waiting for ')
        generator = chain.start('motion_generator', {**parameters, 'publish_clock': 'true'})
        assert generator.wait(LENGTH_S + GUARD_S) == 0, chain.text(generator)
        recorder.send_signal(signal.SIGINT)
        assert recorder.wait(GUARD_S) == 0, chain.text(recorder)
    finally:
        chain.end()
    said = re.findall(r'/(\S+) \(\S+\): (\d+) recorded, (\d+) lost', chain.text(recorder))
    assert {name for name, _, _ in said} == {name.lstrip('/') for name in TOPICS}
    with open_bag(path) as bag:
        assert not bag.cut
        tables = bag.tables({name: () for name, _, _ in said})
        for name, count, lost in said:
            table = tables[name]
            stamps = table['stamp_ns']
            period = DT_NS * (10 if name == 'clock' else 1)
            gaps = stamps[:-1][np.diff(stamps) != period] / 1e9
            print(f'{name}: {count} recorded, {lost} lost, from {stamps[0] / 1e9:.3f} s, gaps '
                  f'behind {gaps[:9]}')
            assert len(stamps) == int(count) and np.array_equal(table['log_ns'], stamps)
            assert lost == '0' and not len(gaps) and stamps[-1] == LENGTH_S * 10**9
