"""Check that the specific force at rest equals gravity: detect wrong units, or gravity removed."""

from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.numerics.units import STANDARD_GRAVITY

# Smallest mean force that defines a direction, m/s^2.
LEAST_FORCE = 1e-3
# Length of the mean force in each case, m/s^2; the guess at the cause; the remedy.
_GUESSES = ((1.0, 'is it in g?', 'units.force:=g converts it; '),
            (1000.0, 'is it in mg?', 'units.force:=mg converts it; '),
            (STANDARD_GRAVITY * STANDARD_GRAVITY, 'was it multiplied by g twice?', ''))
_PART = 0.15


def check_gravity(force, limit):
    """
    Raise ValueError if the mean specific force at rest, (3,), differs from gravity.

    limit: allowed difference of its length from 9.8 m/s^2.
    """
    force = length(force)
    if abs(force - STANDARD_GRAVITY) <= limit:
        return
    what, way = next((guess for size, *guess in _GUESSES if abs(force - size) <= _PART * size),
                     ('was gravity removed?' if force < 0.5 * STANDARD_GRAVITY else '', ''))
    raise ValueError(f'mean specific force at rest is {force:.1f} m/s^2; expected 9.8'
                     + (f': {what}' if what else '')
                     + f' ({way}the allowed difference is alignment.gravity_m_s2, {limit:g})')
