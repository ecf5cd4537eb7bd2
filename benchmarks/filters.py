"""
CPU time of the stages of the filter study, in microseconds per IMU sample.

Also that of a flight of compare-filters, relative to the target, and of a run of an aided
ensemble.

Run: python benchmarks/filters.py [seconds of flight, by default 600]
"""

from dataclasses import replace
import sys
from time import process_time

from ins_sim import parameter_files, resources
from ins_sim.core.ensemble.aided_runs import simulate_aided_runs
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.simulation.aided import make_instruments
from ins_sim.core.simulation.aided_run import navigate_aided, Reported, with_truth
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.settings.aided_navigator import FILTERS
from ins_sim.studies.filters import cases_of, fly_filters
import numpy as np

FLIGHTS, FLIGHT_S = 24, 3000.0
# Target for compare-filters on two cores.
MOST_MIN, CORES = 8.0, 2
RUNS = 8


def timed(work):
    """Return the result of the work and its CPU time, s."""
    start = process_time()
    found = work()
    return found, process_time() - start


def main(seconds=600.0):
    """Print a line for each stage."""
    settings = parameter_files.read_aided(
        [resources.config(name) for name in ('route_flight', 'grade_mid')],
        [f'duration_s:={seconds}'])
    generator = settings.simulation.motion_generator
    motion, motion_s = timed(lambda: make_motion(generator.motion, generator.datum,
                                                 generator.earth))
    print(f'motion: {motion_s:.2f} s')
    total = 0.0

    def report(name, spent):
        nonlocal total
        total += spent
        print(f'{name}: {1e6 * spent / steps:.2f} us a step')

    imu, spent = timed(lambda: list(imu_blocks(settings.simulation, motion)))
    steps = sum(map(len, imu))
    report('IMU', spent)
    blocks, spent = timed(lambda: list(with_truth(motion, imu)))
    report('truth at its stamps', spent)
    fixes = []
    for name, instrument in zip(('velocity meter', 'GNSS'), make_instruments(settings)):
        found, spent = timed(lambda: [f for _, t in blocks for f in instrument.advance(t)])
        fixes.append(found)
        report(name, spent)
    for name in FILTERS:
        chosen = replace(settings.aided_navigator, filter=name, output_every=500)

        def fly():
            return navigate_aided(chosen, blocks, Reported(fixes[0]), Reported(fixes[1]))

        fly()
        report(f'filter {name}', timed(fly)[1])
    cases = cases_of()
    spent = timed(lambda: fly_filters(settings, cases, 1))[1]
    minutes = FLIGHTS * (spent / seconds * FLIGHT_S) / 60.0
    print(f'a flight of compare-filters: {1e6 * spent / steps:.1f} us a step (its stages together '
          f'{1e6 * (total + motion_s) / steps:.1f})')
    print(f'{FLIGHTS} flights of {FLIGHT_S:g} s: {minutes:.1f} min of CPU, on {CORES} cores '
          f'{minutes / CORES:.1f} min, {minutes / CORES / MOST_MIN:.2f} of what is asked')
    wanted_ns = np.arange(0.0, seconds + 1.0, 60.0) * 1e9
    spent = timed(lambda: simulate_aided_runs(settings, motion, range(RUNS), wanted_ns))[1]
    print(f'a run of an aided ensemble, {RUNS} side by side: {1e6 * spent / RUNS / steps:.1f} us '
          'a step')


if __name__ == '__main__':
    main(*map(float, sys.argv[1:]))
