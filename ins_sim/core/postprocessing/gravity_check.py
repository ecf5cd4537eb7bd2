"""Whether a specific force at rest is that of gravity: an accelerometer in g, or without it."""

from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.numerics.units import STANDARD_GRAVITY

# A mean that is shorter shows no direction, m/s^2.
LEAST_FORCE = 1e-3
# What was done to a force of this size, as a part of it, and how one goes on.
_GUESSES = ((1.0, 'is it in g?', 'units.force:=g reads it so; '),
            (1000.0, 'is it in mg?', 'units.force:=mg reads it so; '),
            (STANDARD_GRAVITY * STANDARD_GRAVITY, 'was it multiplied by g twice?', ''))
_PART = 0.15


def check_gravity(force, limit):
    """
    Raise ValueError where the mean specific force at rest, (3,), is not that of gravity.

    limit: what its length may differ from 9.8 m/s^2 by.
    """
    force = length(force)
    if abs(force - STANDARD_GRAVITY) <= limit:
        return
    what, way = next((guess for size, *guess in _GUESSES if abs(force - size) <= _PART * size),
                     ('was gravity taken off it?' if force < 0.5 * STANDARD_GRAVITY else '', ''))
    raise ValueError(f'mean specific force at rest is {force:.1f} m/s^2; expected 9.8'
                     + (f': {what}' if what else '')
                     + f' ({way}it may differ by alignment.gravity_m_s2, {limit:g})')
