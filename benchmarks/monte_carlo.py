"""
Wall time, CPU time and memory of an ensemble of a thousand one-hour runs.

Run: python benchmarks/monte_carlo.py [runs, by default 1000] [seconds, by default 3600]

On every core, 100 Hz on the racetrack: a FOG with six white noises and an in-run bias, and the
whole preset imu_tactical_fog. Wall and CPU time include compiling if the loops are not in the
cache. Memory is the largest sum over this process and its workers when a block is finished; shared
pages count once (PSS).
"""

from multiprocessing import active_children
import os
from pathlib import Path
import re
import resource
import sys
import time

from ins_sim import parameter_files, resources
from ins_sim.io.motion import read_motion
from ins_sim.jobs.executors import open_executor
from ins_sim.jobs.processes import cores
from ins_sim.studies.ensembles import EnsemblePlan, fly_ensemble

IN_RUN = ['gyro.errors.angle_random_walk_deg_sqrt_h:=[0.01, 0.01, 0.01]',
          'accelerometer.errors.velocity_random_walk_m_s_sqrt_h:=[0.01, 0.01, 0.01]',
          'gyro.errors.gauss_markov_sigma_deg_h:=[0.05, 0.05, 0.05]']


def cpu_s():
    """Return the CPU time of this process and of its ended children, s."""
    return sum(usage.ru_utime + usage.ru_stime for usage in map(
        resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def memory_mb():
    """Return the memory of this process and its children, MB."""
    total = 0
    for pid in (os.getpid(), *(child.pid for child in active_children())):
        try:
            text = Path(f'/proc/{pid}/smaps_rollup').read_text(encoding='ascii')
        except OSError:
            # The process has ended.
            continue
        total += int(re.search(r'^Pss: +(\d+) kB', text, re.MULTILINE).group(1))
    return total / 1024.0


def main(runs=1000, seconds=3600):
    """Print the table."""
    for name, names, assignments in (
            ('six normals and an in-run bias', ['racetrack'], IN_RUN),
            ('preset imu_tactical_fog', ['racetrack', 'imu_tactical_fog'], [])):
        settings = parameter_files.read([resources.parameter_file(n) for n in names],
                                        [f'duration_s:={seconds}', *assignments])
        wall, before = time.monotonic(), cpu_s()
        with open_executor() as executor:
            most = [0.0]
            fly_ensemble(EnsemblePlan(settings, runs), read_motion, executor,
                         progress=lambda done: most.append(memory_mb()))
        wall, spent = time.monotonic() - wall, cpu_s() - before
        per = 1e9 * spent / (runs * seconds * settings.imu_sensor.rate_hz)
        print(f'{name:32} {runs} runs of {seconds} s on {cores()} cores: {wall:.1f} s of wall '
              f'time, {spent:.1f} s of CPU, {per:.0f} ns a run and step, '
              f'{max(most):.0f} MB', flush=True)


if __name__ == '__main__':
    main(*map(int, sys.argv[1:]))
