"""
Sums over the current window of the velocity meter, as needed by the filters.

Each sum is a tuple of floats; a function returns its value one sampling cycle later. A filter has
the sums that it asks for in ``needs``; the others stay None.
"""

from typing import NamedTuple

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.interpolation import middle_attitude
from ins_sim.core.attitude.matrix import dcm_of
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import elementary


class BodyMean(NamedTuple):
    """
    Mean velocity in b over the window so far, by the trapezoid rule.

    time_s: length of the window so far; path: integral of the forward and left velocity, m.
    """

    time_s: float = 0.0
    path: tuple[float, float] = (0.0, 0.0)

    @property
    def value(self):
        """Return the mean forward and left velocity, m/s."""
        return self.path[0] / self.time_s, self.path[1] / self.time_s


class Integrals(NamedTuple):
    """
    Matrices of the window, between level axes (east, north) and body axes (forward, left).

    a1 = sum C T_c, a2 = sum A1 T_c, b1 = sum C^T T_c / T, b2 = sum C^T A1 T_c / T
    (docs/theory/aided_navigation.md). They map a constant error of the acceleration in b (a1, a2,
    b2) or of the velocity in n (b1) to errors at the end of the window: a1 to velocity, a2 to
    position, b1 and b2 to the mean velocity in b. Here each matrix is four floats, row by row;
    b1 and b2 are stored multiplied by T.
    """

    a1: tuple = (0.0, 0.0, 0.0, 0.0)
    a2: tuple = (0.0, 0.0, 0.0, 0.0)
    b1: tuple = (0.0, 0.0, 0.0, 0.0)
    b2: tuple = (0.0, 0.0, 0.0, 0.0)

    def matrices(self, time_s):
        """Return a1, a2, b1, b2, each (2, 2), of a window of length time_s."""
        a1, a2, b1, b2 = (np.array(x).reshape(2, 2) for x in self)
        return a1, a2, b1 / time_s, b2 / time_s


class DoubleIntegral(NamedTuple):
    """An acceleration (forward, left) integrated once, m/s, and twice, m, over the window."""

    once: tuple[float, float] = (0.0, 0.0)
    twice: tuple[float, float] = (0.0, 0.0)


class Force(NamedTuple):
    """Integral of the specific force in b over some samples, m/s, and their duration, s."""

    steps: int = 0
    time_s: float = 0.0
    increment: tuple[float, float, float] = (0.0, 0.0, 0.0)


class WindowSums(NamedTuple):
    """
    All sums of a filter; those it does not ask for are None.

    Attributes
    ----------
    mean : BodyMean
    integrals : Integrals
    accelerations : two DoubleIntegrals, of the acceleration in b and of its part rate x velocity
    turned : rotation about the vertical axis of b, rad
    force : Force

    """

    mean: tuple
    integrals: tuple | None = None
    accelerations: tuple | None = None
    turned: float | None = None
    force: tuple | None = None


def sums_after(mean, integrals, accelerations, turned, force, before, after, position, rate,
               delta_v, dt):
    """
    Return WindowSums one cycle later, as a plain tuple.

    Parameters
    ----------
    mean, integrals, accelerations, turned, force : the sums before the cycle, see WindowSums
    before, after : q_nb, velocity in b and in n (m/s), at the start and end of the cycle
    position : latitude (rad), longitude (rad) and height (m) at the end of the cycle
    rate : (3,) angular rate, rad/s
    delta_v : (3,) velocity increment, resolved in b at the start, m/s
    dt : length of the cycle, s

    """
    return (mean_after(mean, before[1], after[1], dt),
            None if integrals is None else integrals_after(integrals, before[0], after[0], dt),
            None if accelerations is None else accelerations_after(accelerations, before, after,
                                                                   position, dt),
            None if turned is None else turned + rate[2] * dt,
            None if force is None else force_after(force, delta_v, dt))


def mean_after(mean, before, after, dt):
    """Return a BodyMean one cycle of dt (s) later; before, after: velocity in b at its ends."""
    time_s, path = mean
    half = 0.5 * dt
    return time_s + dt, (path[0] + half * (before[0] + after[0]),
                         path[1] + half * (before[1] + after[1]))


def integrals_after(integrals, q_start, q_end, dt):
    """Return Integrals one cycle of dt (s) later; q_start, q_end: q_nb at its ends."""
    a1, a2, b1, b2 = integrals
    m = dcm_of(middle_attitude(q_start, q_end))
    c = (m[0], m[1], m[3], m[4])
    t = (c[0], c[2], c[1], c[3])
    now = _weighted(a1, c, dt)
    mid = (0.5 * (a1[0] + now[0]), 0.5 * (a1[1] + now[1]), 0.5 * (a1[2] + now[2]),
           0.5 * (a1[3] + now[3]))
    both = (a1[0] + now[0], a1[1] + now[1], a1[2] + now[2], a1[3] + now[3])
    product = (t[0] * mid[0] + t[1] * mid[2], t[0] * mid[1] + t[1] * mid[3],
               t[2] * mid[0] + t[3] * mid[2], t[2] * mid[1] + t[3] * mid[3])
    return (now, _weighted(a2, both, 0.5 * dt), _weighted(b1, t, dt),
            _weighted(b2, product, dt))


def _weighted(total, x, weight):
    return (total[0] + x[0] * weight, total[1] + x[1] * weight, total[2] + x[2] * weight,
            total[3] + x[3] * weight)


def accelerations_after(accelerations, before, after, position, dt):
    """
    Return the DoubleIntegrals of the acceleration one cycle later; arguments as in sums_after.

    The acceleration is resolved in a level frame that does not turn about the vertical while the
    vehicle follows a great circle.
    """
    whole, turning = accelerations
    (q_start, b_start, v), (q_end, b_end, v_end), (lat, _, height) = before, after, position
    sin_lat, cos_lat = elementary.sincos(lat)
    _, r_e = ellipsoid.radii(sin_lat)
    spin = v[0] * (sin_lat / cos_lat) / (r_e + height) * dt
    w = quaternion.rotate_back(middle_attitude(q_start, q_end), (
        v_end[0] - v[0] - spin * v[1], v_end[1] - v[1] + spin * v[0], v_end[2] - v[2]))
    turn = w[0] - b_end[0] + b_start[0], w[1] - b_end[1] + b_start[1]
    return twice_integrated(whole, w, dt), twice_integrated(turning, turn, dt)


def twice_integrated(total, increment, dt):
    """Return a DoubleIntegral later by dt (s), in which the velocity grows by increment (m/s)."""
    (a, b), half = total, 0.5 * dt
    return ((a[0] + increment[0], a[1] + increment[1]),
            (b[0] + dt * a[0] + half * increment[0], b[1] + dt * a[1] + half * increment[1]))


def force_after(force, delta_v, dt):
    """Return a Force later by dt (s), in which the velocity grows by delta_v (m/s)."""
    steps, time_s, f = force
    return steps + 1, time_s + dt, (f[0] + delta_v[0], f[1] + delta_v[1], f[2] + delta_v[2])
