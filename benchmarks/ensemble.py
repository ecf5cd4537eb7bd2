"""
CPU time of a step of one run of an ensemble, of a single run, and of the strapdown of pyins.

Run: python benchmarks/ensemble.py [runs, by default 48] [steps, by default 360000]

CPU time of the process with one thread, in ns per run and step, the best of a few: the whole
ensemble on motion 2 (truth and ideal readings are computed once for all runs), and its parts.
pyins (from PyPI: python-ins) integrates the increments of one run.
"""

import sys

from ins_sim import parameter_files, resources
from ins_sim.core.ensemble import many_runs
from ins_sim.io.motion import read_motion
from steps import best_ns

BIAS = ['gyro.errors.turn_on_bias_sigma_deg_h:=[0.1, 0.1, 0.1]',
        'accelerometer.errors.turn_on_bias_sigma_ug:=[50.0, 50.0, 50.0]']
WHITE = [*BIAS, 'gyro.errors.angle_random_walk_deg_sqrt_h:=[0.01, 0.01, 0.01]',
         'accelerometer.errors.velocity_random_walk_m_s_sqrt_h:=[0.01, 0.01, 0.01]']
IN_RUN = [*WHITE, 'gyro.errors.gauss_markov_sigma_deg_h:=[0.05, 0.05, 0.05]']


def ensemble(runs, steps, assignments):
    """Return a function that simulates an ensemble."""
    settings = parameter_files.read([resources.parameter_file('motion_2')],
                                    [f'duration_s:={steps / 100.0}', *assignments])
    motion = read_motion(settings.motion_generator)
    return lambda: many_runs.simulate_runs(settings, motion, range(runs), [steps / 100.0])


def pyins_ns(steps):
    """Return the CPU time of a step of the strapdown of pyins, ns."""
    import numpy as np
    from pyins import sim, strapdown
    t = 0.01 * np.arange(steps + 1)
    angles = np.stack([np.degrees(0.5 * t), np.full(len(t), -30.0), np.degrees(t)], axis=-1)
    truth, imu = sim.generate_imu(t, [55.75, 37.5, 0.0], angles, np.zeros((len(t), 3)),
                                  'increment')
    increments = strapdown.compute_increments_from_imu(imu, 'increment')

    def work():
        strapdown.Integrator(truth.iloc[0]).integrate(increments)

    work()
    return best_ns(work, steps)


def main(runs=48, steps=360000):
    """Print the table."""
    if runs <= 16:
        sys.exit(f'runs is {runs}; expected more than the 16 of the ensemble it is compared with')
    try:
        peer = pyins_ns(steps)
        print(f'pyins, strapdown: {peer:.0f} ns a step')
    except ImportError as error:
        peer = float('nan')
        print(f'pyins is not installed ({error}): pip install python-ins')
    for name, assignments in (('different biases', BIAS), ('and six white normals', WHITE),
                              ('and in-run biases of the gyros', IN_RUN)):
        work = ensemble(runs, steps, assignments)
        work()  # This call compiles.
        few = ensemble(16, steps, assignments)
        # Truth and ideal readings are not counted, because they are the same for all runs.
        found = (best_ns(work, 1) - best_ns(few, 1)) / ((runs - 16) * steps)
        print(f'{name:32} {found:6.1f} ns a run and step, pyins / this {peer / found:6.1f}',
              flush=True)


if __name__ == '__main__':
    main(*map(int, sys.argv[1:]))
