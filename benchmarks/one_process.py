"""
The executable simulation compared with three processes: steps per s, CPU, loss, latency.

Run it in an environment with rclpy: python benchmarks/one_process.py [--quick]

The two alternate in lock-step, so that other load on the machine affects both; a listener reads
ins/odometry. Then each runs in real time at high rates.
"""

import argparse
from statistics import median

from live_chain import NODES, run
import numpy as np

ONE = ('simulation',)
# Rate in Hz and seconds of motion of the runs in real time.
RATES = ((1000, 60), (4000, 60), (8000, 60))
QUICK = ((1000, 10), (4000, 10), (8000, 10))


def cpu_us(result):
    """Return CPU microseconds per step of all processes together."""
    return 1e6 * sum(result.cpu_s.values()) / result.received


def lock_step(rounds, duration_s):
    """Print the medians of both, and their ratios."""
    steps, cpu = {ONE: [], NODES: []}, {ONE: [], NODES: []}
    for k in range(rounds):
        for nodes in (ONE, NODES) if k % 2 else (NODES, ONE):
            result = run(100, duration_s, 0, nodes=nodes)
            steps[nodes].append(result.steps_per_s)
            cpu[nodes].append(cpu_us(result))
    one, three = median(steps[ONE]), median(steps[NODES])
    print(f'lock-step, steps/s: one process {one:.0f}, three {three:.0f}, ratio {one / three:.2f} '
          '(18 000 to 10 900 asked for: 1.65)')
    one, three = median(cpu[ONE]), median(cpu[NODES])
    print(f'CPU us a step, start included: one process {one:.0f}, three {three:.0f}, ratio '
          f'{one / three:.2f}', flush=True)


def real_time(runs):
    """Print loss and latency at each rate."""
    print(f'{"real time":14} {"Hz":>6} {"steps":>8} {"lost":>6} {"p50":>7} {"p99":>7} '
          f'{"p99.9":>7} {"max ms":>7} {"CPU s":>6}')
    for rate_hz, duration_s in runs:
        for name, nodes in (('one process', ONE), ('three', NODES)):
            result = run(rate_hz, duration_s, 1, nodes=nodes)
            late = ' '.join(f'{1e3 * v:7.2f}' for v in np.percentile(
                result.latency_s, (50, 99, 99.9, 100))) if len(result.latency_s) else ''
            print(f'{name:14} {rate_hz:6} {result.received:8} {result.lost:6} {late} '
                  f'{sum(result.cpu_s.values()):6.1f}', flush=True)


def main():
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('--quick', action='store_true', help='short runs')
    quick = parser.parse_args().quick
    lock_step(3 if quick else 7, 200.0 if quick else 600.0)
    real_time(QUICK if quick else RATES)


if __name__ == '__main__':
    main()
