"""
The peak memory and the CPU time of runs of any length, each in a process of its own.

Run: python benchmarks/memory.py [--full]
"""

import os
from pathlib import Path
import subprocess
import sys
import tempfile

from paired import environment

HERE = Path(__file__).resolve().parent
DAY_S = 86400
# Name, arguments of the command, whether it writes a folder, memory target in MB.
HOUR = ('simulate', '--params-file', 'motion_2', '-p', 'duration_s:=3600.0')
SLOW = ('--params-file', 'motion_2', '-p', 'rate_hz:=1.0', '-p')
SHORT = (('simulate, 1 h at 100 Hz, with its twin', HOUR, True, 250),
         ('simulate, 24 h at 1 Hz', ('simulate', *SLOW, f'duration_s:={DAY_S}.0'), True, 300),
         ('predict, 24 h', ('predict', *SLOW, f'duration_s:={DAY_S}.0'), False, 300))
LONG = (('simulate, 10 days at 1 Hz', ('simulate', *SLOW, f'duration_s:={10 * DAY_S}.0'), True,
         300),
        ('predict, 10 days', ('predict', *SLOW, f'duration_s:={10 * DAY_S}.0'), False, 300))


def measure(command):
    """Return the peak memory, MB, and the CPU seconds of a command."""
    process = subprocess.Popen(command, env=environment(HERE.parent), stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f'{" ".join(command)} failed')
    return used.ru_maxrss / 1024.0, used.ru_utime + used.ru_stime


def main(full=False):
    """Print a line for each run."""
    for name, words, writes, most in (*SHORT, *(LONG if full else ())):
        with tempfile.TemporaryDirectory() as folder:
            output = ['-o', str(Path(folder) / 'run')] if writes else []
            memory, seconds = measure([sys.executable, '-m', 'ins_sim.cli.main', *words, *output])
        print(f'{name}: {memory:.0f} MB (target {most}), {seconds:.1f} s of CPU', flush=True)


if __name__ == '__main__':
    main('--full' in sys.argv)
