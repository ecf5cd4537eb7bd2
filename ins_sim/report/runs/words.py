"""Quantities in words."""

from ..charts.scales import LENGTHS, scale


def distance(metres):
    """Return a distance as text with three digits, in the unit that its size needs."""
    factor, unit = scale(LENGTHS, metres)
    return f'{float(f"{metres * factor:.3g}"):g} {unit}'
