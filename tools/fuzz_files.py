"""
Read mutated files of every input format in child processes with limited memory.

Usage: python tools/fuzz_files.py [COUNT, default 50000] [--first SEED] [--jobs N]

Each file must give a finite result or an error of one sentence, without a traceback or warning,
within 10 s of CPU time and 1 GB beyond what a child needs to start. Failures are printed with
their seed; ``--first SEED`` with COUNT 1 repeats one. The exit code is 1 if there are any.
"""

import argparse
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
import os
from pathlib import Path
import resource
import shutil
import signal
import sys
import tempfile
import warnings

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'test'))
from support.hostile.files import Hostile, KINDS  # noqa: E402

MEMORY_BYTES = 10 ** 9
LIMIT_S = 10
# Wall-clock limit for a file whose reader waits; a loaded machine needs some of it.
LIMIT_WAITING_S = 120
BLOCK = 250


class TooLong(Exception):
    """A file took more than LIMIT_S."""


def _too_long(number, frame):
    raise TooLong(f'more than {LIMIT_S} s')


def try_block(seeds):
    """Return outcomes {(kind, outcome): count} and failure messages for some seeds."""
    used = int(Path('/proc/self/statm').read_text().split()[0]) * os.sysconf('SC_PAGE_SIZE')
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY_BYTES,) * 2)
    signal.signal(signal.SIGALRM, _too_long)
    signal.signal(signal.SIGPROF, _too_long)
    warnings.simplefilter('error', RuntimeWarning)
    folder = tempfile.mkdtemp(prefix='fuzz_files.')
    outcomes, failures = Counter(), []
    try:
        hostile = Hostile(folder)
        for seed in seeds:
            signal.alarm(LIMIT_WAITING_S)
            signal.setitimer(signal.ITIMER_PROF, LIMIT_S)
            try:
                outcomes[hostile.attempt(seed)] += 1
            except Exception as error:
                failures.append(f'seed {seed} ({KINDS[seed % len(KINDS)]}): {error!r}'[:300])
            finally:
                signal.setitimer(signal.ITIMER_PROF, 0)
                signal.alarm(0)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return outcomes, failures


def main():
    """Try COUNT files and print the numbers; return the exit code."""
    parser = argparse.ArgumentParser(description='Try mutated files.')
    parser.add_argument('count', nargs='?', type=int, default=50000)
    parser.add_argument('--first', type=int, default=0, metavar='SEED')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), metavar='N')
    chosen = parser.parse_args()
    last = chosen.first + chosen.count
    blocks = [range(k, min(k + BLOCK, last)) for k in range(chosen.first, last, BLOCK)]
    outcomes, failures = Counter(), []
    # A child for each block: the memory limit counts from its start.
    with ProcessPoolExecutor(chosen.jobs, max_tasks_per_child=1) as pool:
        for found, wrong in pool.map(try_block, blocks):
            outcomes += found
            failures += wrong
            for sentence in wrong:
                print(sentence, flush=True)
    for kind in KINDS:
        results, sentences = (outcomes[kind, what] for what in ('result', 'sentence'))
        print(f'{kind:16} {results:7} results {sentences:7} sentences')
    print(f'{chosen.count} files tried, {len(failures)} failures')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
