"""Make the motion that the settings name, with the maker from the table of motions."""

from ins_sim.core.numerics.located import located
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
        For settings that describe no valid motion; a route that cannot be flown; a maker that
        cannot be imported or returns no Motion; and a recording, whose poses must be read from a
        file (``ins_sim.io.motion.read_motion``).
    """
    if motion.maker is None:
        raise ValueError(f'motion.kind is {motion.kind}, which is read from a file; expected '
                         'a closed-form motion (ins_sim.io.motion.read_motion reads files)')
    made = located(motion.maker, f'motion.kind {motion.kind}')(motion, datum, earth_settings)
    if not isinstance(made, Motion):
        raise ValueError(f'motion.kind {motion.kind} is at {motion.maker!r} in its table, which '
                         f'returns {type(made).__name__}; expected an object of a subclass of '
                         'ins_sim.Motion')
    return made
