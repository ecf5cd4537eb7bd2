"""The units in which values of some size are read: kilometres where metres read badly."""

import math

# (from this size on, in SI, factor from SI, unit)
LENGTHS = ((1e4, 1e-3, 'km'), (0.1, 1.0, 'm'), (0.0, 1e3, 'mm'))
SPEEDS = ((0.01, 1.0, 'm/s'), (0.0, 1e3, 'mm/s'))
ANGLES = ((math.radians(2.0), math.degrees(1.0), 'deg'),
          (math.radians(0.05), 60.0 * math.degrees(1.0), 'arcmin'),
          (0.0, 3600.0 * math.degrees(1.0), 'arcsec'))
TIMES = ((3.0 * 3600.0, 1.0 / 3600.0, 'h'), (300.0, 1.0 / 60.0, 'min'), (0.0, 1.0, 's'))


def scale(units, largest):
    """
    Return (factor from SI, unit) in which values up to a size are drawn.

    units: LENGTHS, SPEEDS, ANGLES or TIMES; largest: the largest value, in SI.
    """
    return next((factor, unit) for least, factor, unit in units if largest >= least or not least)


def amount(units, value):
    """Return a value in SI as text: three digits at least, in the unit of its size."""
    factor, unit = scale(units, abs(value))
    value *= factor
    return f'{value:.0f} {unit}' if abs(value) >= 999.5 else f'{value:.3g} {unit}'


def distance(metres):
    """Return a distance as text, as ``amount`` does."""
    return amount(LENGTHS, metres)
