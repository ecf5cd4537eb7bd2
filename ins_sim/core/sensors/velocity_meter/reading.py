"""
From correlation functions to velocity: the fits and equations (2) to (5).

Source: Ivanov, Vestnik Koncerna PVO Almaz-Antey 2, 2015, with the corrections of
docs/theory/velocity_meter.md. Axes of the antennas: X1 forward, Z1 right. Lags are integers.
"""

import math
from typing import NamedTuple

from ins_sim.core.numerics.elementary import atan2, log, sincos
from ins_sim.core.timeseries.fixes import VALID

# The fit uses lags whose correlation is at least this fraction of the maximum.
PART = 0.5
LEAST_CROSS, LEAST_AUTO = 5, 3
# A determinant below this fraction of its terms is rounding error.
ROUNDING = 1e-12
PAIRS = ((0, 1), (1, 2), (0, 0), (1, 1), (2, 2))
NAMES = ('R12', 'R23', 'R11', 'R22', 'R33')


class Peak(NamedTuple):
    """Maximum of a correlation function: lag, curvature g (1/lag^2), logarithm of the value."""

    status: str
    lag: float = 0.0
    g: float = 0.0
    ln_max: float = 0.0


class Reading(NamedTuple):
    """
    The result of one window; ``status`` is VALID or the reason why there is no result.

    Attributes
    ----------
    v_x : V_x1, m/s
    v_z : V_z1 by amplitudes, m/s
    v_z_delays : V_z1 by delays alone, for comparison, m/s
    tau : tau12, tau23, s
    g : g12, g23, 1/s^2
    """

    status: str
    v_x: float = math.nan
    v_z: float = math.nan
    v_z_delays: float = math.nan
    tau: tuple = (0.0, 0.0)
    g: tuple = (0.0, 0.0)


def log_quadratic(values, first, even=False):
    """
    Return g, d, c of ln C = g k^2 + d k + c by least squares with weights C^2 (equation 6).

    With these weights the errors of C, which are alike at all lags, count equally. The result is
    NaN if too few lags have a weight that does not vanish.

    Parameters
    ----------
    values : positive correlations at the lags k = first, first + 1, ...
    first : first lag
    even : whether to fit an even function, d = 0
    """
    middle, top = 0 if even else first + len(values) // 2, max(values)
    s0 = s1 = s2 = s3 = s4 = t0 = t1 = t2 = 0.0
    for k, value in enumerate(values, first - middle):
        part, y = value / top, log(value)
        w = part * part
        w1, wy = w * k, w * y
        w2, wy1 = w1 * k, wy * k
        w3 = w2 * k
        s0, s1, s2, s3, s4 = s0 + w, s1 + w1, s2 + w2, s3 + w3, s4 + w3 * k
        t0, t1, t2 = t0 + wy, t1 + wy1, t2 + wy1 * k
    if even:
        determinant = s4 * s0 - s2 * s2
        if determinant <= ROUNDING * s4 * s0:
            return (math.nan,) * 3
        g = (t2 * s0 - t0 * s2) / determinant
        return g, 0.0, (t0 - g * s2) / s0
    # Moments about the mean lag decouple the unknowns.
    m = s1 / s0
    a2, a3 = s2 - m * s1, s3 - m * s2
    a4 = s4 - s2 * s2 / s0
    b1, b2 = t1 - m * t0, t2 - s2 / s0 * t0
    determinant = a2 * a4 - a3 * a3
    if a2 <= ROUNDING * s2 or determinant <= ROUNDING * a2 * a4:
        return (math.nan,) * 3
    g, d = (a2 * b2 - a3 * b1) / determinant, (a4 * b1 - a3 * b2) / determinant
    c = (t0 - d * s1 - g * s2) / s0
    return g, d - 2.0 * g * middle, c - d * middle + g * middle * middle


def cross_peak(values):
    """
    Return the Peak of a cross-correlation function: lag -d/(2g), ln R_max = c - d^2/(4g).

    The fit uses the contiguous lags with C >= PART C_max, at least LEAST_CROSS (equation 6).
    """
    last = len(values) - 1
    top = max(range(last + 1), key=values.__getitem__)
    if top in (0, last):
        return Peak(f'peaks at the {"last" if top else "first"} lag')
    if values[top] <= 0.0:
        return Peak('has no positive value')
    low = high = top
    while low > 0 and values[low - 1] >= PART * values[top]:
        low -= 1
    while high < last and values[high + 1] >= PART * values[top]:
        high += 1
    while high - low + 1 < LEAST_CROSS:
        if high == last or (low > 0 and values[low - 1] >= values[high + 1]):
            low -= 1
        else:
            high += 1
    if min(values[low:high + 1]) <= 0.0:
        return Peak('has a value that is not positive in the fit')
    g, d, c = log_quadratic(values[low:high + 1], low)
    if not g < 0.0:
        return Peak('has no maximum in the fit')
    lag = -d / (2.0 * g)
    if not low <= lag <= high:
        return Peak('has its maximum outside the fitted lags')
    return Peak(VALID, lag, g, c - d * d / (4.0 * g))


def auto_peak(values):
    """
    Return the Peak, at lag 0, of an autocorrelation function.

    The fit omits lag 0, which contains the noise. It uses the lags from 1 while C >= PART C(1), at
    least LEAST_AUTO. The function is even, so d = 0.
    """
    high = 1
    while high < len(values) - 1 and (high < LEAST_AUTO or values[high + 1] >= PART * values[1]):
        high += 1
    if min(values[1:high + 1]) <= 0.0:
        return Peak('has a value that is not positive in the fit')
    g, _, c = log_quadratic(values[1:high + 1], 1, even=True)
    return Peak(VALID, 0.0, g, c) if g < 0.0 else Peak('has no maximum in the fit')


def secant(tan_alpha):
    """Return 1/cos(alpha)."""
    return math.sqrt(1.0 + tan_alpha * tan_alpha)


def slowness(tau, geometry, tan_alpha):
    """
    Return a_K and b of equations (2) and (3), s/m.

    a = (tau12 + tau23)/(2 X0), a_K = a/cos(alpha), b = (tau12 - tau23)/(2 Y0).

    Parameters
    ----------
    tau : tau12, tau23, s
    geometry : Geometry
    tan_alpha : tangent of the angle of attack
    """
    a = (tau[0] + tau[1]) / (2.0 * geometry.x0) * secant(tan_alpha)
    return a, (tau[0] - tau[1]) / (2.0 * geometry.y0)


def delay_velocity(a, b, geometry):
    """
    Return the speeds by delays, m/s.

    The first is along the projection of X1 on the plane of motion, the second along Z1.

    Equation (3), which is exact: kappa a/(a^2 + b^2), and -s2 kappa b/(a^2 + b^2).

    Parameters
    ----------
    a, b : as `slowness` returns them, s/m
    geometry : Geometry
    """
    scale = geometry.kappa / (a * a + b * b)
    return scale * a, -geometry.s2 * scale * b


def sideslip(r12, r23, a, b, geometry, tan_alpha):
    """
    Return the sideslip beta by amplitudes (equation 5), rad, or None for a sine beyond 1.

    sin(2 beta) = s2 (R12 - R23)/(2 X0 Y0 (a^2 + b^2)), in which X0 is replaced by X0 cos(alpha),
    and a by a_K. The factor k_b of equation (5) is left out: it is 1 for both values of kappa.

    Parameters
    ----------
    r12, r23 : (ln B_max - (ln A_i max + ln A_j max)/2)/g of each pair, s^2
    a, b : as `slowness` returns them, s/m
    geometry : Geometry
    tan_alpha : tangent of the angle of attack
    """
    x0 = geometry.x0 / secant(tan_alpha)
    sine = geometry.s2 * (r12 - r23) / (2.0 * x0 * geometry.y0 * (a * a + b * b))
    if abs(sine) > 1.0:
        return None
    return 0.5 * atan2(sine, math.sqrt((1.0 - sine) * (1.0 + sine)))


def read_correlations(correlations, lag_s, geometry, tan_alpha):
    """
    Return the Reading of five correlation functions.

    Equation (3) gives the speed along the projection of X1 on the plane of motion; v_x is its
    component along X1, smaller by the factor cos(alpha).

    Parameters
    ----------
    correlations : (5, lags) in the order of PAIRS
    lag_s : time between lags, s
    geometry : Geometry
    tan_alpha : tangent of the angle of attack
    """
    rows = correlations.tolist()
    peaks = [cross_peak(row) for row in rows[:2]] + [auto_peak(row) for row in rows[2:]]
    for name, peak in zip(NAMES, peaks):
        if peak.status != VALID:
            return Reading(f'{name} {peak.status}')
    p12, p23, *autos = peaks
    tau = (p12.lag * lag_s, p23.lag * lag_s)
    g = (p12.g / (lag_s * lag_s), p23.g / (lag_s * lag_s))
    a, b = slowness(tau, geometry, tan_alpha)
    trace, v_z_delays = delay_velocity(a, b, geometry)
    r12 = (p12.ln_max - 0.5 * (autos[0].ln_max + autos[1].ln_max)) / g[0]
    r23 = (p23.ln_max - 0.5 * (autos[1].ln_max + autos[2].ln_max)) / g[1]
    beta = sideslip(r12, r23, a, b, geometry, tan_alpha)
    if beta is None:
        return Reading('amplitudes of R12 and R23 give no sideslip')
    sin, cos = sincos(beta)
    return Reading(VALID, trace / secant(tan_alpha), trace * (sin / cos), v_z_delays, tau, g)
