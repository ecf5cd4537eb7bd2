"""Positions of the antennas of the velocity meter, in SI units."""

from typing import NamedTuple


class Geometry(NamedTuple):
    """
    Positions of the antennas.

    Attributes
    ----------
    x0, y0 : distances of the antennas from the centre, along and across, m
    s2 : +1 if antenna 2 is on the right, -1 if on the left
    kappa : 1/2 for physical offsets of the antennas, 1 for effective ones (phase centres)
    """

    x0: float
    y0: float
    s2: float
    kappa: float


def antenna_geometry(antennas):
    """Return the Geometry of the settings Antennas."""
    return Geometry(antennas.x0_m, antennas.y0_m, 1.0 if antennas.antenna_2 == 'right' else -1.0,
                    0.5 if antennas.offsets == 'physical' else 1.0)
