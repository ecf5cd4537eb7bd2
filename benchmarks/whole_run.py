"""
An hour at 100 Hz as a whole process, including files: ours and pyins, alternately.

Run: python benchmarks/whole_run.py [seconds of the run, by default 3600]

Ours is ``ins_sim simulate`` of motion 2 in one pass: truth, readings with a late channel,
solution, errors, drift, prediction, summary and figure. pyins (from PyPI: python-ins, extra bench)
generates increments from similar angles of roll, pitch and heading, integrates them and saves
trajectories and increments. Compiled code of both is in the cache.
"""

from pathlib import Path
from statistics import median
import sys
import tempfile

from memory import measure
import numpy as np

REPEATS = 3
PSI_RATE, GAMMA_RATE, THETA_DEG = 1.0, 0.5, -30.0


def theirs(seconds, path):
    """Generate, integrate and save a run with pyins."""
    from pyins import sim, strapdown
    t = 0.01 * np.arange(round(100 * seconds) + 1)
    angles = np.stack([np.degrees(GAMMA_RATE * t), np.full(len(t), THETA_DEG),
                       np.degrees(PSI_RATE * t)], axis=-1)
    truth, imu = sim.generate_imu(t, [55.75, 37.5, 0.0], angles, np.zeros((len(t), 3)),
                                  'increment')
    increments = strapdown.compute_increments_from_imu(imu, 'increment')
    solution = strapdown.Integrator(truth.iloc[0]).integrate(increments)
    np.savez(path, truth=truth.to_numpy(), imu=imu.to_numpy(), solution=solution.to_numpy())


def main(seconds='3600'):
    """Print CPU seconds, the peak memory and the ratio."""
    commands = {'ins_sim': [sys.executable, '-m', 'ins_sim.cli.main', 'simulate', '--params-file',
                            'motion_2', '-p', f'duration_s:={float(seconds)}', '--no-twin', '-o'],
                'pyins': [sys.executable, __file__, '--theirs', seconds]}
    try:
        import pyins  # noqa: F401 - is it there?
    except ImportError as error:
        print(f'pyins is not installed ({error}): pip install python-ins')
        del commands['pyins']
    times = {name: [] for name in commands}
    with tempfile.TemporaryDirectory() as folder:
        for k in range(REPEATS + 1):
            for name, command in commands.items():
                memory, spent = measure([*command, str(Path(folder) / f'{name}_{k}')])
                # The first run may have to compile.
                if k:
                    times[name].append(spent)
                if k == REPEATS:
                    print(f'{name}: {median(times[name]):.2f} s of CPU for {float(seconds):g} s '
                          f'at 100 Hz, {memory:.0f} MB', flush=True)
    if len(times) == 2:
        print(f'ratio: {median(times["pyins"]) / median(times["ins_sim"]):.2f} times as fast')


if __name__ == '__main__':
    if sys.argv[1:2] == ['--theirs']:
        theirs(float(sys.argv[2]), sys.argv[3])
    else:
        main(*sys.argv[1:])
