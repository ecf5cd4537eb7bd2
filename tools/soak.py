"""
Run the live nodes and the recorder for a long time; report losses, latency and memory.

Usage: python tools/soak.py [seconds, by default 3600 [rate in Hz, by default 1000 [folder]]]

The bag is written to the folder, by default a temporary one, and takes 1.4 kB per sample.  The
exit code is 1 if a message was lost, by the counts of the publishers or by the stamps in the bag,
without an explanation: a loss counts as explained if during some second other processes (and the
hypervisor) used more than BUSY of a core.
"""

import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

from ins_sim import graph
from ins_sim.bags.bag_reader import open_bag
from ins_sim.messages import topics

TOPICS = (topics.TRUTH_IMU, topics.IMU_RAW, topics.INS_ODOMETRY)
BUSY = 0.5
TICK_S = 1.0 / os.sysconf('SC_CLK_TCK')
END_S = 60.0
SETTLING = 0.2


class Watched:
    """A process, with its memory, handles and CPU time once a second."""

    def __init__(self, process, log):
        self.process, self.log, self.rows = process, log, []

    def look(self, now_s):
        """Store its present memory, handles and CPU time; nothing after its end."""
        folder = Path('/proc') / str(self.process.pid)
        try:
            words = (folder / 'stat').read_text().rpartition(')')[2].split()
            handles = len(os.listdir(folder / 'fd'))
        except OSError:
            return
        if words[0] == 'Z':
            return
        cpu_s = (int(words[11]) + int(words[12])) * TICK_S
        self.rows.append((now_s, int(words[21]) * os.sysconf('SC_PAGESIZE'), handles, cpu_s))

    @property
    def cpu_s(self):
        """Return the CPU time at the last look, s."""
        return self.rows[-1][3] if self.rows else 0.0


def machine_cpu_s():
    """Return the CPU time of the whole machine, s, including that of the hypervisor."""
    values = [int(v) for v in Path('/proc/stat').read_text().split('\n')[0].split()[1:9]]
    # All states except idle and waiting for disks.
    return (sum(values) - values[3] - values[4]) * TICK_S


def start(name, parameters, folder, environment):
    """Start a node that ends with this process; return it, Watched."""
    process = next(p for p in (*graph.PROCESSES, graph.RECORDER) if p.name == name)
    log = folder / f'{name}.log'
    with open(log, 'wb') as stream:
        return Watched(subprocess.Popen(
            graph.process_command(process, (), parameters.items(), parent=os.getpid()),
            stdout=stream, stderr=stream, stdin=subprocess.DEVNULL, env=environment), log)


def run_chain(length_s, rate_hz, folder):
    """Run the nodes; return them by name, and the CPU use by other processes in each second."""
    environment = {'ROS_DOMAIN_ID': str(50 + os.getpid() % 50),
                   'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST', **os.environ}
    common = {'rate_hz': float(rate_hz)}
    running = {'recorder': start('recorder', {
        'record.topics': f'[{", ".join(t.name for t in TOPICS)}]', 'record.log_time': 'received',
        'storage.path': folder / 'bag'}, folder, environment)}
    others, before = [], None
    try:
        for name in ('strapdown', 'imu_sensor'):
            running[name] = start(name, common, folder, environment)
        while not all('waiting for' in running[name].log.read_text() for name in running):
            if any(w.process.poll() is not None for w in running.values()):
                raise RuntimeError(last_words(running))
            time.sleep(0.1)
        running['motion_generator'] = start(
            'motion_generator', {**common, 'duration_s': float(length_s)}, folder, environment)
        begin, master = time.monotonic(), running['motion_generator'].process
        while master.poll() is None:
            time.sleep(1.0)
            now = time.monotonic()
            for watched in running.values():
                watched.look(now - begin)
                if watched.process.poll():
                    raise RuntimeError(last_words(running))
            spent = machine_cpu_s(), sum(w.cpu_s for w in running.values()), now
            if before is not None and master.poll() is None:
                total, ours, passed = (b - a for a, b in zip(before, spent))
                others.append(max(0.0, total - ours) / passed)
            before = spent
    finally:
        for watched in running.values():
            if watched.process.poll() is None:
                watched.process.send_signal(signal.SIGINT)
        for watched in running.values():
            try:
                watched.process.wait(END_S)
            except subprocess.TimeoutExpired:
                watched.process.kill()
    return running, others


def last_words(running):
    """Return the last messages of the nodes that have ended."""
    return '; '.join(f'{name}: {(w.log.read_text().splitlines() or ["nothing"])[-1]}'
                     for name, w in running.items() if w.process.poll() is not None)


def show_processes(running, length_s):
    """Print memory, its slope per day, handles and CPU time of each process."""
    for name, watched in running.items():
        rows = np.array(watched.rows or [(0.0,) * 4])
        steady = rows[rows[:, 0] >= SETTLING * rows[-1, 0]]
        slope = np.polyfit(steady[:, 0], steady[:, 1], 1)[0] if len(steady) > 2 else 0.0
        print(f'{name}: {rows[-1, 1] / 1e6:.1f} MB, {slope * 86400 / 1e6:+.1f} MB a day, '
              f'{rows[0, 2]:.0f} to {rows[-1, 2]:.0f} handles, '
              f'{100.0 * rows[-1, 3] / length_s:.1f} % of a core')


def show_losses(folder, said, rate_hz):
    """Print losses and gaps of each topic and the latency of the chain; return the total lost."""
    with open_bag(folder / 'bag') as bag:
        tables = bag.tables({topic.name: () for topic in TOPICS})
    counted = {name: int(lost) for name, lost in re.findall(
        r': /(\S+) \(\S+\): \d+ recorded, (\d+) lost', said)}
    total = 0
    for topic in TOPICS:
        stamps = np.sort(tables[topic.name]['stamp_ns'])
        holes = int(np.sum(np.round(np.diff(stamps) * 1e-9 * rate_hz) - 1))
        lost = counted.get(topic.name, len(stamps))
        print(f'{topic.name}: {len(stamps)} recorded, {lost} lost, {holes} holes in the bag')
        total += lost + holes
    truth, solved = tables[topics.TRUTH_IMU.name], tables[topics.INS_ODOMETRY.name]
    _, a, b = np.intersect1d(truth['stamp_ns'], solved['stamp_ns'], return_indices=True)
    late_ms = (solved['log_ns'][b] - truth['log_ns'][a]) * 1e-6
    if len(late_ms):
        figures = np.percentile(late_ms, (50, 90, 99, 99.9, 100))
        print('latency of the solution behind the truth, ms: ' + ', '.join(
            f'{n} {v:.2f}' for n, v in zip(('50 %', '90 %', '99 %', '99.9 %', 'most'), figures)))
    return total


def soak(length_s, rate_hz, folder):
    """Run and show; return the exit code."""
    running, others = run_chain(length_s, rate_hz, folder)
    print(f'{length_s:g} s at {rate_hz:g} Hz, bag of '
          f'{sum(p.stat().st_size for p in (folder / "bag").iterdir()) / 1e6:.0f} MB')
    show_processes(running, length_s)
    total = show_losses(folder, running['recorder'].log.read_text(), rate_hz)
    most = max(others, default=0.0)
    print(f'other processes: {np.mean(others) if others else 0.0:.2f} of a core, at most '
          f'{most:.2f} within a second')
    codes = {name: w.process.returncode for name, w in running.items() if w.process.returncode}
    if codes:
        print(f'nodes that ended with a code: {codes}')
    warned = sum(w.log.read_text(errors='replace').count('[WARN]') for w in running.values())
    print(f'{warned} warnings, {total} lost'
          + (', which the load of others explains' if total and most > BUSY else ''))
    return 1 if codes or total and most <= BUSY else 0


def main(words):
    """Read the arguments and soak; return the exit code."""
    try:
        length_s, rate_hz = (float(w) for w in (*words[:2], *('3600', '1000')[len(words[:2]):]))
    except ValueError:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    try:
        if len(words) > 2:
            Path(words[2]).mkdir(parents=True)
            return soak(length_s, rate_hz, Path(words[2]))
        with tempfile.TemporaryDirectory() as folder:
            return soak(length_s, rate_hz, Path(folder))
    except (RuntimeError, OSError, ValueError) as error:
        print(f'soak: {error}', file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print('soak: interrupted', file=sys.stderr)
        return 130


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
