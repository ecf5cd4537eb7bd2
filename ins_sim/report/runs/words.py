"""Quantities in words."""

from ..charts.scales import amount, LENGTHS


def distance(metres):
    """Return a distance as text, in the unit that its size needs."""
    return amount(LENGTHS, metres)
