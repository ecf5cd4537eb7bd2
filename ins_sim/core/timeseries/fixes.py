"""What the aiding instruments say: one fix of the velocity meter, and one of GNSS."""

from dataclasses import dataclass
import math

VALID = 'valid'
# why GNSS has no fix
OUTAGE = 'outage'


@dataclass(frozen=True)
class VelocityFix:
    """
    The velocity over one window of the correlation velocity meter.

    start_ns, end_ns: the window (start, end] in motion time; cycles: navigation cycles in it;
    velocity: mean forward and left velocity relative to the ground in velocity_meter_link, m/s
    (the paper's V_x1 and -V_z1); sigma: their standard deviations, m/s; tan_alpha: tangent of the
    attack angle that was used; tau: delays tau12 and tau23 of the maxima, s; g: curvatures g12
    and g23 of the fits, 1/s^2 (tau and g zero from the surrogate); status: VALID, or why the fix
    is none, and then the velocity is NaN; arrival_ns: motion time at which it is there.
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
        """Return whether there is a velocity."""
        return self.status == VALID

    @property
    def t_ns(self):
        """Return the stamp, the end of the window."""
        return self.end_ns

    @property
    def up(self):
        """Return V_y1 = -V_x1 tan(alpha), m/s: no measurement (equation 4), never to be fused."""
        return -self.velocity[0] * self.tan_alpha


@dataclass(frozen=True)
class GnssFix:
    """
    Position and velocity of the GNSS antenna.

    t_ns: motion time of validity; lat, lon: rad; height: m; v_n: m/s, East, North, Up;
    position_sigma m and velocity_sigma m/s by East, North, Up; status: VALID, or why the fix is
    none, and then its numbers are NaN; arrival_ns: motion time at which it is there.
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
        """Return whether there is a position."""
        return self.status == VALID


def no_gnss_fix(t_ns, status, arrival_ns):
    """Return the GnssFix that is none, for a reason."""
    nothing = (math.nan,) * 3
    return GnssFix(t_ns, *nothing, nothing, nothing, nothing, status, arrival_ns)
