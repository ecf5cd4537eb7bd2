"""
Wall and CPU time of the error budget of an hour.

Run: python benchmarks/budget.py [seconds of motion, by default 3600]

The linear covariance by source on the racetrack and on motion 2, the best of three; then the whole
command, with its figures and its page. The aim is 2 s for an hour.
"""

import sys
import tempfile
import time

from ins_sim import parameter_files, resources
from ins_sim.cli.main import main as command
from ins_sim.core.prediction.budget.linear_budget import error_budget
from ins_sim.io.motion import read_motion

CASES = (('racetrack', 'imu_tactical_fog'), ('racetrack', 'imu_tactical_mems'),
         ('motion_2', 'imu_tactical_fog'))
AIM_S = 2.0


def took(work):
    """Return wall and CPU time of a call, s."""
    wall, cpu = time.perf_counter(), time.process_time()
    work()
    return time.perf_counter() - wall, time.process_time() - cpu


def main(seconds=3600.0):
    """Print the table."""
    for names in CASES:
        settings = parameter_files.read([resources.parameter_file(name) for name in names],
                                        [f'duration_s:={seconds}'])
        motion = read_motion(settings.motion_generator)
        times = [took(lambda: error_budget(settings, motion)) for _ in range(3)]
        wall, cpu = (min(column) for column in zip(*times))
        print(f'{" + ".join(names):40} {wall:5.2f} s, CPU {cpu:5.2f} s; {wall / AIM_S:4.2f} of '
              f'{AIM_S:g} s', flush=True)
    with tempfile.TemporaryDirectory() as folder:
        words = [word for name in CASES[0] for word in ('--params-file', name)]
        wall, cpu = took(lambda: command(['budget', *words, '-p', f'duration_s:={seconds}', '-o',
                                          f'{folder}/budget']))
    print(f'{"the verb, with figures and page":40} {wall:5.2f} s, CPU {cpu:5.2f} s')


if __name__ == '__main__':
    main(*map(float, sys.argv[1:]))
