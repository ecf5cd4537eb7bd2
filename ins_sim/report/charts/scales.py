"""Choose readable units by magnitude, for example kilometres instead of thousands of metres."""

import math

# (smallest magnitude in SI, factor from SI, unit)
LENGTHS = ((1e4, 1e-3, 'km'), (0.1, 1.0, 'm'), (0.0, 1e3, 'mm'))
SPEEDS = ((0.01, 1.0, 'm/s'), (0.0, 1e3, 'mm/s'))
ANGLES = ((math.radians(2.0), math.degrees(1.0), 'deg'),
          (math.radians(0.05), 60.0 * math.degrees(1.0), 'arcmin'),
          (0.0, 3600.0 * math.degrees(1.0), 'arcsec'))
TIMES = ((3.0 * 3600.0, 1.0 / 3600.0, 'h'), (300.0, 1.0 / 60.0, 'min'), (0.0, 1.0, 's'))


def scale(units, largest):
    """
    Return (factor from SI, unit) for drawing values.

    ``units`` is LENGTHS, SPEEDS, ANGLES or TIMES; ``largest`` is the largest value in SI.
    """
    return next((factor, unit) for least, factor, unit in units if largest >= least or not least)


def amount(units, value):
    """Return a value in SI as text in a suitable unit, with at least three digits."""
    factor, unit = scale(units, abs(value))
    value *= factor
    return f'{value:.0f} {unit}' if abs(value) >= 999.5 else f'{value:.3g} {unit}'


def distance(metres):
    """Return a distance as text, as ``amount`` does."""
    return amount(LENGTHS, metres)
