"""The record of an instrument that rests on a level table, straight from its settings."""

from dataclasses import replace

from ins_sim.core.motion.factory import make_motion
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.settings.instrument_errors import Sampling
from ins_sim.settings.motion import MotionSettings


def at_rest(settings, duration_s):
    """Return SimulationSettings of the same instrument, level, at rest, every sample in time."""
    generator = replace(settings.motion_generator, duration_s=duration_s, motion=MotionSettings(
        kind='static', psi_deg=0.0, theta_deg=0.0, gamma_deg=0.0))
    sensor = replace(settings.imu_sensor, source='motion', motion=generator.motion,
                     sampling=Sampling())
    return replace(settings, motion_generator=generator, imu_sensor=sensor)


def resting_record(settings, duration_s):
    """Yield blocks of ImuSamples of the instrument at rest (see ``at_rest``)."""
    settings = at_rest(settings, duration_s)
    generator = settings.motion_generator
    yield from imu_blocks(settings,
                          make_motion(generator.motion, generator.datum, generator.earth))
