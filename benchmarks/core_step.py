"""
CPU time of one step of a node in plain Python, without receiving and publishing.

Run: python benchmarks/core_step.py
"""

from time import process_time

import numpy as np

from ins_sim.settings.catalogue import build
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.sensors.imu.with_errors import reported_variances
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.navigation.live import Navigator
from ins_sim.core.sensors.tuned_gyro.parity import ParityTest
from ins_sim.settings.presets import preset
from ins_sim.core.sensors.imu.sampling import Sampler
from ins_sim.settings.imu import ImuSensorSettings
from ins_sim.settings.motion import MotionGeneratorSettings
from ins_sim.settings.strapdown import StrapdownSettings
from ins_sim.messages import topics
from ins_sim.messages.convert import truth_blocks

LATE = {'gyro.delay_us.x': 1.0, 'gyro.delay_us.y': 2.0, 'gyro.delay_us.z': 3.0}
# Every error term on both triads, the rotors and the stamps.
EVERYTHING = {**LATE, **preset('tactical_dtg'), 'temperature.ramp_c_h': 5.0,
              'gyro.errors.bandwidth_hz': [100.0] * 3,
              'gyro.errors.g_sensitivity_deg_h_g': [0.1] * 3,
              'gyro.errors.g2_sensitivity_deg_h_g2': [0.01] * 3,
              'gyro.errors.bias_deg_h': [0.1] * 3, 'gyro.errors.misalignment_mrad': [0.1] * 3,
              'gyro.errors.scale_factor_ppm': [10.0] * 3,
              'gyro.dtg.fault.channel': 'gyro_1_y', 'gyro.dtg.fault.start_s': 1e6,
              'sampling.latency_us': 50.0, 'sampling.jitter_us': 20.0,
              'sampling.drop_out_probability': 1e-4}


def step_us(steps=5000, repeats=5, **sensor):
    """
    Return CPU microseconds of one step of the live IMU and navigator, the best run.

    The IMU is fed by the stream with three different delays; the navigator matches it with truth
    and computes solution, errors and drift.
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
            navigator.push_imu(*reading[:3])
        end = process_time()
        best = [min(best[0], middle - start), min(best[1], end - middle)]
    return best[0] / steps * 1e6, best[1] / steps * 1e6


def tuned_step_us(steps=5000, repeats=5, rate_hz=1000.0):
    """
    Return CPU microseconds of one step of a node with two tuned gyros and EVERYTHING.

    From the bytes of truth/imu to those of imu/data_raw and imu/parity: all that imu_sensor does
    except receiving and publishing.
    """
    generator = build(MotionGeneratorSettings, {'motion.kind': 'two_axis'})
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    truth = motion.at(period_ns(rate_hz) * np.arange(steps))
    values = truth_blocks(MapFrame(generator.datum, True), truth)[topics.TRUTH_IMU]
    messages = topics.TRUTH_IMU.writer().pack_block(truth.t_ns, values)
    settings = build(ImuSensorSettings, {**EVERYTHING, 'rate_hz': rate_hz})
    read, dt_ns = topics.TRUTH_IMU.reader().read, period_ns(rate_hz)
    pack = topics.imu_raw(*reported_variances(settings)).writer().pack
    pack_parity = topics.IMU_PARITY.writer().pack
    best = np.inf
    for _ in range(repeats):
        imu, sampler = make_imu(settings), Sampler(settings.sampling, 0, 0, 'sampling', dt_ns)
        test = ParityTest(settings, imu.pair)
        start = process_time()
        for data in messages:
            for t_ns, omega, f, parity in imu.push(*read(data)):
                stamp_ns = sampler.stamp(t_ns // dt_ns, t_ns)
                if stamp_ns is not None:
                    pack(stamp_ns, omega, f)
                    test.push(t_ns, omega, f, parity)
                    pack_parity(stamp_ns, (parity, test.mean, 0.0))
        best = min(best, process_time() - start)
    return best / steps * 1e6


def main():
    """Print the results."""
    imu, navigator = step_us()
    print(f'one IMU step {imu:.1f} us, one strapdown step with solution and errors '
          f'{navigator:.1f} us, together {imu + navigator:.1f} us (target 60)')
    print(f'one step of the IMU with two tuned gyros and every error: {tuned_step_us():.1f} us '
          '(target 120)')


if __name__ == '__main__':
    main()
