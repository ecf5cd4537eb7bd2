"""
Compare this checkout with another one: a step, the start of each node, an hour offline.

Run: python benchmarks/paired.py OTHER [--rounds 7] [--seconds 3600]

The two alternate, so that other load on the machine affects both. Printed are the medians of the
CPU time and their ratio (below 1: this checkout is faster).
"""

import argparse
import os
from pathlib import Path
import resource
from statistics import median
import subprocess
import sys
import tempfile

HERE = Path(__file__).resolve().parent
NODES = ('motion_generator', 'imu_sensor', 'strapdown', 'gnss', 'velocity_meter',
         'aided_navigator')


def environment(checkout):
    """Return the environment that imports a checkout, with bytecode cached as if installed."""
    kept = {k: v for k, v in os.environ.items() if k != 'PYTHONDONTWRITEBYTECODE'}
    return {**kept, 'PYTHONPATH': str(checkout), 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}


def probed(checkout, *words):
    """Return what probe.py prints for a checkout, microseconds."""
    found = subprocess.run([sys.executable, HERE / 'probe.py', *words], check=True, text=True,
                           env=environment(checkout), cwd=checkout, capture_output=True)
    return float(found.stdout)


def offline_us(checkout, seconds):
    """Return CPU microseconds of ``ins_sim simulate`` of motion 2, including files."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [sys.executable, '-m', 'ins_sim.cli.main', 'simulate', '--params-file', 'motion_2',
             '-p', f'duration_s:={seconds:.1f}', '-o', str(Path(folder) / 'run')], check=True,
            env=environment(checkout), cwd=checkout, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1e6 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def compare(name, measure, checkouts, rounds):
    """Measure both alternately; print the medians, and return their ratio."""
    times = [[], []]
    for k in range(rounds):
        # The order changes each round, so that none of them always has the warm cache.
        for one in ((0, 1) if k % 2 else (1, 0)):
            times[one].append(measure(checkouts[one]))
    ours, other = map(median, times)
    print(f'{name:36} {ours:14.1f} {other:14.1f} {ours / other:8.3f}', flush=True)
    return ours / other


def main(words=None):
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('against', type=Path, help='another checkout of ins_sim')
    parser.add_argument('--rounds', type=int, default=7)
    parser.add_argument('--seconds', type=float, default=3600.0, help='length of the offline run')
    arguments = parser.parse_args(words)
    pair = HERE.parent, arguments.against.resolve()
    print(f'{"CPU time, us":36} {"this":>14} {"other":>14} {"ratio":>8}')
    compare('one step of IMU and strapdown', lambda c: probed(c, 'step'), pair, arguments.rounds)
    for node in NODES:
        compare(f'start of {node}, less a bare node', lambda c: probed(c, 'start', node), pair,
                2 * arguments.rounds)
    compare(f'{arguments.seconds:g} s of motion 2 offline',
            lambda c: offline_us(c, arguments.seconds), pair, max(3, arguments.rounds // 2))


if __name__ == '__main__':
    main()
