"""
CPU time of a step of each stage of an offline run, plain, compiled, and of other packages.

Run: python benchmarks/steps.py [steps, by default 360000]

CPU time of one thread, ns per step, the best of a few runs in turns. Plain: the same loops without
Numba, over a twentieth of the steps. Truth and ideal readings are made before the clock starts,
except that an IMU on a motion evaluates it. Other packages (extra bench): pyins (from PyPI:
python-ins) generates increments and integrates them, inu generates readings.
"""

from dataclasses import replace
import sys
from time import process_time

import numpy as np

from ins_sim import parameter_files, resources
from ins_sim.core.numerics import compilation
from ins_sim.core.sensors.imu.with_errors import with_errors
from ins_sim.core.simulation.inertial import BLOCK, imu_blocks, navigate_blocks
from ins_sim.core.timeseries.collecting import Collected
from ins_sim.io.motion import read_motion

REPEATS = 3
PLAIN_PART = 20
LATE = ['gyro.delay_us.x:=1.0', 'gyro.delay_us.y:=2.0', 'gyro.delay_us.z:=3.0']


class Run:
    """The settings of shipped files, their motion, and the truth and readings of a run."""

    def __init__(self, steps, names, *assignments):
        self.settings = parameter_files.read(
            [resources.parameter_file(name) for name in names],
            [*LATE, f'duration_s:={steps / 100.0}', *assignments])
        self.motion = read_motion(self.settings.motion_generator)

    def sense(self):
        """Compute the readings of the IMU."""
        return collected(imu_blocks(self.settings, self.motion))


class Known:
    """A motion whose truth is in memory."""

    def __init__(self, truth):
        self._truth = truth

    def at(self, t_ns):
        """Return the truth at consecutive stamps."""
        first = int(np.searchsorted(self._truth.t_ns, t_ns[0]))
        return self._truth[first:first + len(t_ns)]


def collected(blocks):
    """Join blocks into one history."""
    store = Collected()
    for block in blocks:
        store.append(block)
    return store.history()


def without_errors(run):
    """Return the settings of a run whose IMU is ideal."""
    sensor = run.settings.imu_sensor
    return replace(run.settings, imu_sensor=replace(
        sensor, gyro=replace(sensor.gyro, errors=type(sensor.gyro.errors)()),
        accelerometer=replace(sensor.accelerometer,
                              errors=type(sensor.accelerometer.errors)())))


def stages(steps):
    """Yield name, target in ns, and a function that runs all steps."""
    for kind, names, goal in (('motion 2', ['motion_2'], 120), ('cruise', ['cruise'], 5000),
                              ('aggressive', ['aggressive'], 5000)):
        run = Run(steps, names, 'source:=motion')
        yield f'IMU on the motion, {kind}', goal, run.sense
    run = Run(steps, ['motion_2'], 'source:=stream')
    yield 'IMU on streamed truth, motion 2, both evaluated', 3000, run.sense
    run = Run(steps, ['motion_2', 'imu_tactical_fog'], 'source:=motion')
    blocks = list(imu_blocks(without_errors(run), run.motion))

    def err():
        errors = with_errors(run.settings.imu_sensor)
        for block in blocks:
            errors.advance(block)

    yield 'errors of both triads, tactical_fog', 60, err
    tuned = Run(steps, ['dtg_motion_2', 'imu_tactical_dtg'], 'source:=motion')
    yield 'tuned gyros with their errors, motion evaluated', 1000, tuned.sense
    flown = Run(steps, ['motion_2'])
    readings = flown.sense()
    known = Known(flown.motion.at(readings.t_ns))

    def navigate():
        return collected(errors for _, _, errors in navigate_blocks(
            flown.settings.strapdown, known, readings.blocks(BLOCK)))

    yield 'navigation with errors, drift and solution', 260, navigate


def turning(steps):
    """Return t and the angles roll, pitch, yaw of a rotating bench, deg, at steps + 1 instants."""
    t = 0.01 * np.arange(steps + 1)
    return t, np.stack([np.degrees(0.5 * t), np.full(len(t), -30.0), np.degrees(t)], axis=-1)


def pyins(steps):
    """Yield name and function for pyins."""
    from pyins import sim, strapdown
    t, angles = turning(steps)

    def generate():
        return sim.generate_imu(t, [55.75, 37.5, 0.0], angles, np.zeros((len(t), 3)), 'increment')

    truth, imu = generate()
    increments = strapdown.compute_increments_from_imu(imu, 'increment')
    yield 'pyins: generation of an IMU without delays', generate
    yield 'pyins: strapdown alone', lambda: strapdown.Integrator(
        truth.iloc[0]).integrate(increments)


def inu(steps):
    """Yield name and function for inu."""
    from inu import mech_inv
    t, angles = turning(steps)
    places = np.tile([np.radians(55.75), np.radians(37.5), 0.0], (len(t), 1))
    yield 'inu: generation of an IMU without delays', lambda: mech_inv(
        places, np.radians(angles), 0.01)


def best_ns(work, steps):
    """Return the least CPU time of a few calls, ns per step."""
    best = float('inf')
    for _ in range(REPEATS):
        start = process_time()
        work()
        best = min(best, process_time() - start)
    return 1e9 * best / steps


def main(steps=360000):
    """Print the table."""
    plain = {}
    usual, compilation.PLAIN_SAMPLES = compilation.PLAIN_SAMPLES, float('inf')
    for name, _, work in stages(steps // PLAIN_PART):
        plain[name] = best_ns(work, steps // PLAIN_PART)
    compilation.PLAIN_SAMPLES = usual
    print(f'{"ns a step":50} {"compiled":>9} {"plain":>9} {"goal":>6}')
    for name, goal, work in stages(steps):
        work()  # This call compiles.
        print(f'{name:50} {best_ns(work, steps):9.0f} {plain[name]:9.0f} {goal:6}', flush=True)
    for peer, package in ((pyins, 'python-ins'), (inu, 'inu')):
        try:
            for name, work in peer(steps):
                work()
                print(f'{name:50} {best_ns(work, steps):9.0f}', flush=True)
        except ImportError as error:
            print(f'{peer.__name__} is not installed ({error}): pip install {package}')


if __name__ == '__main__':
    main(*map(int, sys.argv[1:]))
