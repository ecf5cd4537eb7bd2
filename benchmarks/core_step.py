"""
What one step costs in pure Python, and how long an hour takes offline.

Run: python benchmarks/core_step.py [--hour]
"""

import sys
from time import process_time

import numpy as np

from ins_sim.core.catalogue import build
from ins_sim.core.imu import period_ns
from ins_sim.core.imu_stream import make_imu
from ins_sim.core.map_frame import MapFrame
from ins_sim.core.motions import make_motion
from ins_sim.core.navigator import Navigator
from ins_sim.core.settings import ImuSensorSettings, MotionGeneratorSettings, StrapdownSettings
from ins_sim.core.simulation import Settings, simulate

LATE = {'gyro.delay_us.x': 1.0, 'gyro.delay_us.y': 2.0, 'gyro.delay_us.z': 3.0}


def step_us(steps=5000, repeats=5, **sensor):
    """
    Return CPU microseconds of one step of the live IMU and of the live navigator, the best run.

    The IMU works from the stream with three different delays; the navigator matches it with
    truth and computes solution, errors and drift.
    """
    generator = build(MotionGeneratorSettings, {'motion.kind': 'two_axis'})
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    frame = MapFrame(generator.datum, True)
    truth = motion.at(period_ns(100.0) * np.arange(steps))
    pose = [x.tolist() for x in frame.pose(truth.lat, truth.lon, truth.height, truth.v_n,
                                           truth.q_nb)]
    t_ns = truth.t_ns.tolist()
    samples = list(zip(t_ns, pose[1], truth.omega_ib_b.tolist(), truth.f_ib_b.tolist()))
    best = [np.inf, np.inf]
    for _ in range(repeats):
        imu = make_imu(build(ImuSensorSettings, {**LATE, **sensor}))
        start = process_time()
        readings = [r for s in samples for r in imu.push(*s)]
        middle = process_time()
        navigator = Navigator(build(StrapdownSettings, {}))
        for reading, *truth_sample in zip(readings, t_ns, *pose):
            navigator.push_truth(*truth_sample)
            navigator.push_imu(*reading)
        end = process_time()
        best = [min(best[0], middle - start), min(best[1], end - middle)]
    return best[0] / steps * 1e6, best[1] / steps * 1e6


def hour_s():
    """Return CPU seconds of one hour of motion 2 at 100 Hz offline, twin left out."""
    late = {'gyro.delay_us.y': 1.0, 'source': 'motion'}
    settings = Settings(build(MotionGeneratorSettings, {}), build(ImuSensorSettings, late),
                        build(StrapdownSettings, {}))
    start = process_time()
    simulate(settings, twin=False)
    return process_time() - start


def main():
    """Print the figures."""
    imu, navigator = step_us()
    print(f'one IMU step {imu:.1f} us, one strapdown step with solution and errors '
          f'{navigator:.1f} us, together {imu + navigator:.1f} us (target 60)')
    if '--hour' in sys.argv:
        print(f'one hour of motion 2 at 100 Hz offline: {hour_s():.1f} s (target 60)')


if __name__ == '__main__':
    main()
