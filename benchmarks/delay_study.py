"""
Wall time of the command delay-study with all its figures, and its ratio to the target.

Run: python benchmarks/delay_study.py [seconds of each run, by default 3600]
"""

from pathlib import Path
import subprocess
import sys
from tempfile import TemporaryDirectory
from time import monotonic

MAY_TAKE_S = 60.0


def verb_s(length_s):
    """Return the wall time of the command, s."""
    with TemporaryDirectory() as folder:
        start = monotonic()
        subprocess.run([sys.executable, '-m', 'ins_sim', 'delay-study', '-p',
                        f'duration_s:={length_s}', '-o', Path(folder) / 'study'], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return monotonic() - start


def main(length_s=3600.0):
    """Print the wall time and the ratio."""
    # The first run on a machine compiles.
    verb_s(60.0)
    spent = verb_s(length_s)
    print(f'delay-study, runs of {length_s:g} s: {spent:.1f} s, {spent / MAY_TAKE_S:.2f} of the '
          f'{MAY_TAKE_S:g} s it may take')


if __name__ == '__main__':
    main(*map(float, sys.argv[1:]))
