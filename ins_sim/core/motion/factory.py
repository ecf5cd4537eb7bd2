"""The motion that settings name, made by the maker in the table of motions."""

from importlib import import_module

from .motion import Motion


def make_motion(motion, datum, earth_settings) -> Motion:
    """
    Return the closed-form motion that the settings name.

    Parameters
    ----------
    motion : MotionSettings
        Its kind names the maker in the table ``settings.motion.MOTIONS``.
    datum : Datum
    earth_settings : Earth

    Raises
    ------
    ValueError
        On settings that no motion can have, a route that cannot be flown, and on a recording,
        whose poses must be read from a file (``ins_sim.io.motion.read_motion``).
    """
    if motion.maker is None:
        raise ValueError(f'motion.kind is {motion.kind}, whose poses are in a file; expected a '
                         'closed-form motion here')
    module, _, name = motion.maker.partition(':')
    return getattr(import_module(module), name)(motion, datum, earth_settings)
