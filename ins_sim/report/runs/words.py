"""Quantities in words."""

from ..charts.scales import LENGTHS, scale


def distance(metres):
    """Return a distance as text, in the unit that its size needs."""
    factor, unit = scale(LENGTHS, metres)
    return f'{metres * factor:.3g} {unit}'
