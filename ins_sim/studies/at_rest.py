"""The record of an instrument at rest on a level table, computed from its settings."""

from dataclasses import replace

import numpy as np

from ins_sim.core.motion.factory import make_motion
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.simulation import inertial
from ins_sim.settings.instrument_errors import Sampling
from ins_sim.settings.motion import MotionSettings


def at_rest(settings, duration_s):
    """Return SimulationSettings of the same instrument, level, at rest, with even stamps."""
    generator = replace(settings.motion_generator, duration_s=duration_s, motion=MotionSettings(
        kind='static', psi_deg=0.0, theta_deg=0.0, gamma_deg=0.0))
    sensor = replace(settings.imu_sensor, source='motion', motion=generator.motion,
                     sampling=Sampling())
    return replace(settings, motion_generator=generator, imu_sensor=sensor)


def resting_record(settings, duration_s):
    """Yield blocks of ImuSamples of the instrument at rest (see ``at_rest``)."""
    settings = at_rest(settings, duration_s)
    generator = settings.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    if settings.imu_sensor.gyro.model != 'ideal':
        # The rotors of tuned gyros do not settle within the run.
        return inertial.imu_blocks(settings, motion)
    return inertial.sensed_blocks(settings.imu_sensor, _ideal_readings(settings, motion))


def _ideal_readings(settings, motion):
    """Yield blocks of the ideal readings; all but the first equal the second."""
    generator = settings.motion_generator
    imu = MotionImu(settings.imu_sensor, motion, round(generator.start_s * 1e9))
    count = inertial.reading_count(generator, imu.dt_ns)
    two = imu.advance(2)
    for start in range(0, count, inertial.BLOCK):
        k = np.arange(start, min(start + inertial.BLOCK, count), dtype=np.int64)
        yield replace(two[np.minimum(k, 1)], t_ns=two.t_ns[0] + imu.dt_ns * k)
