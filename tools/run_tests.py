"""
Run the tests as CI does, and print how long they took.

Usage: python tools/run_tests.py fast | slow | figures

Tests that start no processes run first, in parallel on all cores. The tests that start nodes
follow, file by file on three workers: they mostly wait, and each has a ROS domain of its own.
``figures`` runs the long studies one after another, each on all cores.
"""

import subprocess
import sys
import time

SIDE_BY_SIDE = ['-n', 'auto', '--dist', 'loadgroup']
LIVE = ['-n', '3', '--dist', 'loadfile']
CALLS = {
    'fast': [(SIDE_BY_SIDE, 'not slow and not figures and not live'),
             (LIVE, 'live and not slow and not figures')],
    'slow': [(SIDE_BY_SIDE, 'slow and not figures and not live'),
             ([], 'slow and not figures and live')],
    'figures': [([], 'figures')]}
# Exit code of pytest without selected tests; without rclpy no test starts nodes.
NONE_CHOSEN = 5


def main(kind):
    """Run all calls of a kind, even if one fails; return 1 if a test failed."""
    start, failed = time.monotonic(), False
    for words, marks in CALLS[kind]:
        code = subprocess.run([sys.executable, '-m', 'pytest', 'test', *words, '-m', marks,
                               '--durations', '20'], check=False).returncode
        failed |= code not in (0, NONE_CHOSEN)
    minutes, seconds = divmod(round(time.monotonic() - start), 60)
    print(f'{kind} tests: {minutes} min {seconds} s in all', flush=True)
    return int(failed)


if __name__ == '__main__':
    if len(sys.argv) != 2 or sys.argv[1] not in CALLS:
        sys.exit(__doc__.strip())
    try:
        sys.exit(main(sys.argv[1]))
    except KeyboardInterrupt:
        sys.exit(130)
