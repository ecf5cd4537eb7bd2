"""The record of an instrument that rests on a level table, straight from its settings."""

from dataclasses import replace

from .error_settings import Sampling
from .motions import make_motion
from .settings import MotionSettings
from .simulation import sense


def at_rest(settings, duration_s):
    """Return simulation.Settings of the same instrument, level, at rest, every sample in time."""
    generator = replace(settings.motion_generator, duration_s=duration_s, motion=MotionSettings(
        kind='static', psi_deg=0.0, theta_deg=0.0, gamma_deg=0.0))
    sensor = replace(settings.imu_sensor, source='motion', motion=generator.motion,
                     sampling=Sampling())
    return replace(settings, motion_generator=generator, imu_sensor=sensor)


def resting_record(settings, duration_s):
    """Yield blocks of ImuSamples of the instrument at rest (see ``at_rest``)."""
    settings = at_rest(settings, duration_s)
    generator = settings.motion_generator
    yield from sense(settings, make_motion(generator.motion, generator.datum, generator.earth))
