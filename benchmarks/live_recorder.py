"""
The chain in real time at 1 kHz, recorded: losses, and CPU time of the recorder.

Run it in an environment with rclpy: python benchmarks/live_recorder.py [seconds, by default 60]
"""

import os
from pathlib import Path
import re
import signal
import sys
import tempfile
import time

from live_chain import start, stop
import numpy as np

from ins_sim.bags.bag_reader import open_bag
from ins_sim.messages import topics

DOMAIN, RATE_HZ = 92, 1000
TOPICS = [topic.name for topic in (*topics.DATA, topics.CLOCK_TOPIC)]


def main(seconds=60.0):
    """Print recorded, lost and gaps of each topic, and CPU seconds."""
    seconds = float(seconds)
    with tempfile.TemporaryDirectory() as folder:
        log, path = Path(folder) / 'log', Path(folder) / 'bag'
        # Samples sent before a late reader has been repaired must stay in the queue of the
        # generator.
        parameters = {'rate_hz': float(RATE_HZ), 'duration_s': seconds, 'topics.depth': 10_000}
        with open(log, 'w') as stream:
            recorder = start('recorder', {'record.topics': f'[{", ".join(TOPICS)}]',
                                          'storage.path': path}, DOMAIN, stdout=stream,
                             stderr=stream)
            others = [start(node, parameters, DOMAIN) for node in ('strapdown', 'imu_sensor')]
            time.sleep(3.0)
            generator = start('motion_generator', {**parameters, 'publish_clock': 'true'}, DOMAIN)
            os.waitid(os.P_PID, generator.pid, os.WEXITED | os.WNOWAIT)
            time.sleep(1.0)
            _, cpu_s = stop(recorder)
            for process in (generator, *others):
                try:
                    stop(process, signal.SIGINT)
                except ProcessLookupError:
                    pass
        said = re.findall(r'/(\S+) \(\S+\): (\d+) recorded, (\d+) lost', log.read_text())
        with open_bag(path) as bag:
            tables = bag.tables({name: () for name, _, _ in said})
        for name, count, lost in said:
            stamps = tables[name]['stamp_ns']
            gaps = np.count_nonzero(np.diff(stamps) != np.median(np.diff(stamps)))
            print(f'{name}: {count} recorded, {lost} lost, {gaps} gaps')
    total, lost = (sum(int(row[k]) for row in said) for k in (1, 2))
    print(f'{seconds:g} s at {RATE_HZ} Hz, {len(said)} topics: {lost} of {total} lost; recorder '
          f'{cpu_s:.1f} s of CPU, {cpu_s / seconds:.0%} of a core')


if __name__ == '__main__':
    main(*sys.argv[1:])
