"""Where the antennas of the velocity meter are, in SI."""

from typing import NamedTuple


class Geometry(NamedTuple):
    """X0, Y0, m; s2: +1 antenna 2 on the right, -1 left; kappa: 1/2 physical, 1 effective."""

    x0: float
    y0: float
    s2: float
    kappa: float


def antenna_geometry(antennas):
    """Return the Geometry of Antennas (settings)."""
    return Geometry(antennas.x0_m, antennas.y0_m, 1.0 if antennas.antenna_2 == 'right' else -1.0,
                    0.5 if antennas.offsets == 'physical' else 1.0)
