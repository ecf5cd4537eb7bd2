"""
What the study of delays costs: seconds of the verb with all its figures, over those it may take.

Run: python benchmarks/delay_study.py [seconds of each run, by default 3600]
"""

from pathlib import Path
import subprocess
import sys
from tempfile import TemporaryDirectory
from time import monotonic

MAY_TAKE_S = 60.0


def verb_s(length_s):
    """Return the wall seconds of the verb."""
    with TemporaryDirectory() as folder:
        start = monotonic()
        subprocess.run([sys.executable, '-m', 'ins_sim', 'delay-study', '-p',
                        f'duration_s:={length_s}', '-o', Path(folder) / 'study'], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return monotonic() - start


def main(length_s=3600.0):
    """Print the seconds, and their ratio."""
    # the first run on a machine compiles
    verb_s(60.0)
    spent = verb_s(length_s)
    print(f'delay-study, runs of {length_s:g} s: {spent:.1f} s, {spent / MAY_TAKE_S:.2f} of the '
          f'{MAY_TAKE_S:g} s it may take')


if __name__ == '__main__':
    main(*map(float, sys.argv[1:]))
