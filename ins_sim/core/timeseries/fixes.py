"""Fixes of the aiding instruments: the velocity meter and GNSS."""

from dataclasses import dataclass
import math

VALID = 'valid'
# Status of a GNSS fix during an outage.
OUTAGE = 'outage'


@dataclass(frozen=True)
class VelocityFix:
    """
    The velocity over one window of the correlation velocity meter (Ivanov 2015).

    Attributes
    ----------
    start_ns, end_ns : the window (start, end] in motion time, ns
    cycles : number of navigation cycles in it
    velocity : mean forward and left velocity relative to the ground in velocity_meter_link, m/s
        (V_x1 and -V_z1); NaN if invalid
    sigma : their standard deviations, m/s
    tan_alpha : tangent of the angle of attack that was used
    tau : delays tau12 and tau23 of the maxima, s; zero in mode surrogate
    g : curvatures g12 and g23 of the fits, 1/s^2; zero in mode surrogate
    status : VALID, or the reason why the fix is invalid
    arrival_ns : motion time at which the fix is available, ns
    """

    start_ns: int
    end_ns: int
    cycles: int
    velocity: tuple[float, float]
    sigma: tuple[float, float]
    tan_alpha: float = 0.0
    tau: tuple[float, float] = (0.0, 0.0)
    g: tuple[float, float] = (0.0, 0.0)
    status: str = VALID
    arrival_ns: int = 0

    @property
    def valid(self):
        """Return whether the fix has a velocity."""
        return self.status == VALID

    @property
    def t_ns(self):
        """Return the stamp, the end of the window."""
        return self.end_ns

    @property
    def up(self):
        """Return V_y1 = -V_x1 tan(alpha), m/s; not a measurement (equation 4), never fuse it."""
        return -self.velocity[0] * self.tan_alpha


@dataclass(frozen=True)
class GnssFix:
    """
    Position and velocity of the GNSS antenna.

    Attributes
    ----------
    t_ns : motion time of validity, ns
    lat, lon, height : rad, rad, m; NaN if invalid, like the other numbers
    v_n : velocity East, North, Up, m/s
    position_sigma, velocity_sigma : standard deviations East, North, Up, m and m/s
    status : VALID, or the reason why the fix is invalid
    arrival_ns : motion time at which the fix is available, ns
    """

    t_ns: int
    lat: float
    lon: float
    height: float
    v_n: tuple[float, float, float]
    position_sigma: tuple[float, float, float]
    velocity_sigma: tuple[float, float, float]
    status: str = VALID
    arrival_ns: int = 0

    @property
    def valid(self):
        """Return whether the fix has a position."""
        return self.status == VALID


def no_gnss_fix(t_ns, status, arrival_ns):
    """Return an invalid GnssFix with its reason as status."""
    nothing = (math.nan,) * 3
    return GnssFix(t_ns, *nothing, nothing, nothing, nothing, status, arrival_ns)
