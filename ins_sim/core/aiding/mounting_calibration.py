"""
Calibrate the mounting error of the velocity meter and the azimuth error of the INS with GNSS.

Both estimates are independent of the filter. The azimuth error follows from the velocity error of
a free INS in a turn; the sum of azimuth and mounting error follows from the lateral velocity
(Ivanov 2015, equation 27; docs/theory/aided_navigation.md). Signs: mu > 0 if the antennas are
turned left, dpsi > 0 if the computed heading is too far clockwise.
"""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.timeseries.histories import NavStates

# Longest span over which the velocity error of a free INS is close to a quadratic in time.
SPAN_NS = 600_000_000_000


@dataclass(frozen=True)
class MountingCalibration:
    """
    Estimates and their standard deviations, which assume white residuals.

    The sigma of dpsi leaves out the part of the INS error that is not quadratic in time: 0.7
    arcmin for a mid-grade INS.

    Attributes
    ----------
    dpsi : azimuth error, rad
    dpsi_sigma : its standard deviation, rad
    total : mu + dpsi by equation (27), rad
    fitted : mu + dpsi by least squares, rad
    fitted_sigma : its standard deviation, rad
    k_z : lateral scale error by least squares
    k_z_sigma : its standard deviation

    """

    dpsi: float
    dpsi_sigma: float
    total: float
    fitted: float
    fitted_sigma: float
    k_z: float
    k_z_sigma: float

    @property
    def two_manoeuvres(self):
        """Return mu by equation (27) and the turn, rad."""
        return self.total - self.dpsi

    @property
    def least_squares(self):
        """Return mu by least squares and the turn, and its standard deviation, rad."""
        variance = self.fitted_sigma * self.fitted_sigma + self.dpsi_sigma * self.dpsi_sigma
        return self.fitted - self.dpsi, math.sqrt(variance)


def calibrate_mounting(states, gnss, meter):
    """
    Return the MountingCalibration of a flight with a turn.

    Invalid fixes are left out, and so are windows during which GNSS has a gap.

    Parameters
    ----------
    states : NavStates
        Solution of a free INS at every navigation cycle.
    gnss : list of GnssFix
    meter : list of VelocityFix

    Raises
    ------
    ValueError
        If there are too few fixes, or if the velocity does not turn.
    """
    fixes = _about_the_turn([fix for fix in gnss if fix.valid
                             and states.t_ns[0] <= fix.t_ns <= states.t_ns[-1]])
    if len(fixes) < 10:
        raise ValueError(f'{len(fixes)} GNSS fixes; expected at least 10 for the azimuth')
    t_ns = np.array([fix.t_ns for fix in fixes])
    v_gnss = np.array([fix.v_n[:2] for fix in fixes])
    at = np.searchsorted(states.t_ns, t_ns)
    if (states.t_ns[at] != t_ns).any():
        raise ValueError('the INS has no solution at some GNSS fixes; expected one at every cycle')
    dpsi, dpsi_sigma = azimuth_error((t_ns - t_ns[0]) * 1e-9, states.v_n[at, :2], v_gnss)
    read, computed = _windows(states, t_ns, v_gnss, meter)
    return MountingCalibration(dpsi, dpsi_sigma, mounting_sum(read, computed),
                               *least_squares(read, computed))


def _about_the_turn(fixes):
    """Return the fixes of the SPAN_NS in which the velocity changes most."""
    best, most = fixes, -1.0
    for first in range(0, len(fixes), max(1, len(fixes) // 50)):
        end_ns = fixes[first].t_ns + SPAN_NS
        span = [fix for fix in fixes[first:] if fix.t_ns <= end_ns]
        spread = float(np.var([fix.v_n[:2] for fix in span], axis=0).sum())
        if spread > most:
            best, most = span, spread
        if fixes[-1].t_ns <= end_ns:
            break
    return best


def azimuth_error(t_s, v_ins, v_gnss):
    """
    Return the azimuth error dpsi and its standard deviation, rad.

    The velocity error of a free INS is modelled as a quadratic in time (tilt and gyro errors) plus
    -dpsi times the change of e_up x V; all are fitted by least squares.

    Parameters
    ----------
    t_s : (n,) instants, s
    v_ins, v_gnss : (n, 2) east and north velocity during a turn, m/s

    Raises
    ------
    ValueError : if the velocity does not turn

    """
    spread = np.linalg.svd(v_gnss - v_gnss.mean(axis=0), compute_uv=False) / math.sqrt(len(t_s))
    if spread[0] < 0.05 * np.linalg.norm(v_gnss, axis=1).mean():
        raise ValueError(f'the velocity changes by {spread[0]:.3g} m/s; expected a turn, because '
                         'the azimuth error is observable only in turns')
    scale = t_s / max(t_s[-1], 1.0)
    powers = np.stack([np.ones_like(scale), scale, scale ** 2], axis=1)
    rows = np.zeros((len(t_s), 2, 7))
    rows[:, 0, 0:3] = rows[:, 1, 3:6] = powers
    # The term is -dpsi e_up x V = dpsi (V_N, -V_E).
    rows[:, 0, 6], rows[:, 1, 6] = v_gnss[:, 1], -v_gnss[:, 0]
    x, sigma = _fit(rows.reshape(-1, 7), (v_ins - v_gnss).reshape(-1))
    return float(x[6]), float(sigma[6])


def mounting_sum(read, computed):
    """
    Return mu + dpsi, rad, by equation (27) of Ivanov (2015): sum(V_z - V_z1N) / sum(V_x).

    Parameters
    ----------
    read : (n, 2) forward and right velocity measured by the meter, m/s
    computed : (n, 2) GNSS velocity, resolved forward and right with the attitude of the INS, m/s

    """
    return float((read[:, 1] - computed[:, 1]).sum() / read[:, 0].sum())


def least_squares(read, computed):
    """
    Return mu + dpsi (rad), its sigma, k_z and its sigma; a cross-wind has no effect.

    V_z - V_z1N is fitted by [V_x, V_z1N] in the least-squares sense
    (docs/theory/aided_navigation.md); parameters as in ``mounting_sum``. The meter first rotates
    the velocity by the mounting error and then scales it, so that the first coefficient is
    (1 + k_z)(mu + dpsi).
    """
    rows = np.stack([read[:, 0], computed[:, 1]], axis=1)
    x, sigma = _fit(rows, read[:, 1] - computed[:, 1])
    scale = 1.0 + x[1]
    return float(x[0] / scale), float(sigma[0] / scale), float(x[1]), float(sigma[1])


def _fit(rows, values):
    """Return the least-squares solution and its standard deviations from the residuals."""
    x, *_ = np.linalg.lstsq(rows, values, rcond=None)
    left = values - rows @ x
    variance = left @ left / max(1, len(values) - rows.shape[1])
    return x, np.sqrt(variance * np.diagonal(np.linalg.inv(rows.T @ rows)))


def _windows(states, t_ns, v_gnss, meter):
    """Return the mean velocities by the meter and by the INS, (n, 2), forward and right, m/s."""
    inside = (states.t_ns >= t_ns[0]) & (states.t_ns <= t_ns[-1])
    now = states.t_ns[inside]
    v_n = np.stack([np.interp(now, t_ns, v_gnss[:, 0]), np.interp(now, t_ns, v_gnss[:, 1]),
                    states.v_n[inside, 2]], axis=1)
    v_b = body_velocity(NavStates(now, states.lat[inside], states.lon[inside],
                                  states.height[inside], v_n, states.q_nb[inside]))
    steps = 0.5 * (v_b[1:, :2] + v_b[:-1, :2]) * (np.diff(now) * 1e-9)[:, np.newaxis]
    path = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    read, computed = [], []
    for fix in meter:
        if not (fix.valid and fix.start_ns >= now[0] and fix.end_ns <= now[-1]
                and _covered(fix, t_ns)):
            continue
        a, b = np.searchsorted(now, (fix.start_ns, fix.end_ns))
        mean = (path[b] - path[a]) / ((now[b] - now[a]) * 1e-9)
        read.append((fix.velocity[0], -fix.velocity[1]))
        computed.append((mean[0], -mean[1]))
    if len(read) < 3:
        raise ValueError(f'{len(read)} windows of the velocity meter during GNSS coverage; '
                         'expected at least 3')
    return np.array(read), np.array(computed)


def _covered(fix, t_ns):
    """Return whether there are GNSS fixes throughout a window, without a gap."""
    step = int(np.diff(t_ns).min())
    first, last = np.searchsorted(t_ns, (fix.start_ns, fix.end_ns), side='right')
    span = t_ns[max(0, first - 1):last + 1]
    return len(span) < 2 or int(np.diff(span).max()) == step
