"""Bench records for the tests of the delay estimation."""

from dataclasses import replace

import numpy as np

from ins_sim.core.calibration.bench_record import BenchRecord
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.sensors.imu.triad_errors import TriadErrors
from ins_sim.core.sensors.imu.triad_model import triad_model
from ins_sim.settings.presets import preset
from support.studies import settings

FOG = {name: value for name, value in preset('tactical_fog').items()
       if name.startswith('gyro.errors.')}
# Oscillation about the diagonal of the body axes.
DIAGONAL = {'motion.kind': 'rocking', 'motion.psi_deg': 35.26438968, 'motion.theta_deg': -45.0,
            'motion.gamma_deg': 0.0}
MOTION_2 = {'motion.kind': 'two_axis', 'motion.theta_deg': -30.0}
REVERSED_2 = {**MOTION_2, 'motion.two_axis.psi_rate_rad_s': -1.0,
              'motion.two_axis.gamma_rate_rad_s': -0.5}
THREE_ANGLES = {'motion.kind': 'sinusoids'}
DELAYS = {'gyro.delay_us.x': 2.0, 'gyro.delay_us.y': 1.0, 'gyro.delay_us.z': 3.0}


def ideal(values, duration_s, start_s=0.0):
    """Return the BenchRecord of gyros with delays and no other error, and SimulationSettings."""
    chosen = settings(values)
    generator, sensor = chosen.motion_generator, chosen.imu_sensor
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    imu = MotionImu(sensor, motion, round(start_s * 1e9))
    samples = imu.advance(round(duration_s * sensor.rate_hz))
    white = triad_model(sensor.gyro.errors, imu.dt_ns * 1e-9).white
    return BenchRecord('bench', samples, imu.dt_ns, motion, generator.datum, generator.earth,
                       sensor.output, white), chosen


def read(record, chosen, seed):
    """Return a BenchRecord read by the gyros of SimulationSettings with a seed."""
    dt_ns, imu = record.dt_ns, record.imu
    triad = TriadErrors(chosen.imu_sensor.gyro.errors, seed, 0, 'gyro.errors', dt_ns * 1e-9)
    omega = triad.advance(int(imu.t_ns[0]) // dt_ns, imu.omega, imu.f, imu.t_ns * 1e-9)
    return replace(record, imu=replace(imu, omega=omega))


def thinned(record, kept):
    """Return a BenchRecord of the readings selected by a mask."""
    return replace(record, imu=record.imu[np.asarray(kept)])
