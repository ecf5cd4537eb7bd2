"""
Recorded flight as a motion: splines through the samples (docs/theory/recorded_flights.md).

The polynomials fitted to the samples (``fitting``) are evaluated elementwise, in the time since
the first sample of the interval. Thus the result at an instant does not depend on the other
instants in the call, and int64 nanoseconds lose no precision far from zero.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics import taylor
from ins_sim.core.timeseries.histories import Truth
from . import fitting, quality
from ..motion import Motion
from ..truth import truth_from_pose
from .faults import median_interval, unbroken_part

# The ends are not flown: the spline is inexact there, and delayed channels need earlier samples.
PAD_S = 3.0
FEWEST_ROWS = 8
# Longest interval between rows that is interpolated; longest run that the settings allow.
LONGEST_INTERVAL_S, LONGEST_S = 600.0, 1e7

# -3 dB of a boxcar of T seconds: sin(x)/x = 1/sqrt(2) at x = pi f T, so f T = 0.4429.
BOXCAR_3DB = 0.4429

# Blocks keep the temporaries in the cache; any size gives the same result.
BLOCK = 16384

# Power series of cos sqrt(x) and sin sqrt(x) / sqrt(x), highest power first. x = (angle / 2)^2 is
# small between two samples: a few terms are exact to rounding, without sine or branch at zero.
_COS = [(-1.0) ** n / math.factorial(2 * n) for n in range(19, -1, -1)]
_SINC = [(-1.0) ** n / math.factorial(2 * n + 1) for n in range(19, -1, -1)]


class RecordedMotion(Motion):
    """
    A recorded flight, valid from -3 s to end_s + 3 s of motion time.

    Motion time 0 is recorder time start_s after the first row; the recording must extend 3 s
    further on both sides (end effects of the splines; history of delayed channels).

    Parameters
    ----------
    poses : RecordedPoses
    recording : settings.motion.Recording
    earth : settings.place.Earth

    Attributes
    ----------
    end_s : last motion time that may be used, s
    zero_ns : recorder stamp of motion time 0, ns
    warnings : sentences on what was assumed, cut, smoothed or found noisy

    Raises
    ------
    ValueError : for an unusable record (see ``faults``) or a start outside it

    """

    end_name = 'the end of the recording'

    def __init__(self, poses, recording, earth):
        """Check the poses and fit splines to them."""
        self.path = recording.path
        self._earth_rotation, self._gravity = earth.rotation, earth.gravity
        rows = poses
        q, rate = rows.q_nb, rows.omega_nb_b
        part, cut = unbroken_part(rows, fitting.turns(q), recording.start_s, recording.on_gap)
        self.warnings = [*rows.notes, *cut]
        self.zero_ns = int(rows.t_ns[0]) + round(recording.start_s * 1e9)
        self._knots = rows.t_ns[part] - self.zero_ns
        self._check_extent(recording, int(rows.t_ns[0]))
        pad_ns = round(PAD_S * 1e9)
        self._span = (-pad_ns, int(self._knots[-1]))
        self.end_s = (self._span[1] - pad_ns) * 1e-9

        # Only differences are splined: a latitude of 0.8 rad has a rounding error of 1e-9 m, which
        # a second derivative at 50 Hz turns into 1e-5 m/s^2.
        t = (self._knots - self._knots[0]) * 1e-9
        position = np.stack([np.radians(rows.lat_deg[part]), np.radians(rows.lon_deg[part]),
                             rows.height_m[part]])
        self._origin = position[:, 0].copy()
        position -= self._origin[:, None]
        q = q[part]
        if recording.smoothing_s:
            # The recorded rates do not belong to the smoothed motion, so they are not used.
            position, q, rate = *fitting.smoothed(t, position, q, recording.smoothing_s), None
            self.warnings += self._smoothing_report(recording.smoothing_s, t)
        self._base = q
        self._position = fitting.position_spline(t, position)
        if rate is None:
            self._rotation = fitting.rotation_spline(t, q)
        else:
            fitting.check_rates(rows.path, t, q, rate[part])
            self._rotation = fitting.rotation_cubics(t, q, rate[part])
        self._terms = _terms(self._rotation, np.diff(t))
        lat, lon, height = position + self._origin[:, None]
        self.warnings += quality.describe_quality(
            rows.path, int(self._knots[0]) + self.zero_ns, t, lat, lon, height, fitting.turns(q),
            rows.resolution, recording.smoothing_s)

    def _check_extent(self, recording, zero_ns):
        """Reject a recording shorter than two pads, and a start outside it."""
        knots = self._knots
        length_s = (knots[-1] - knots[0]) * 1e-9
        if len(knots) < FEWEST_ROWS or length_s <= 2.0 * PAD_S:
            raise ValueError(f'{recording.path} holds {len(knots)} rows over {length_s:g} s'
                             f'{" in the part that is kept" if recording.on_gap == "cut" else ""}'
                             f'; expected at least {FEWEST_ROWS} rows over more than '
                             f'{2.0 * PAD_S:g} s: a run cannot use the ends, {PAD_S:g} s each')
        interval_s = median_interval(np.diff(knots) * 1e-9)
        if interval_s > LONGEST_INTERVAL_S or length_s > LONGEST_S:
            raise ValueError(f'{recording.path} holds a row every {interval_s:g} s over '
                             f'{length_s:g} s; expected a row every {LONGEST_INTERVAL_S:g} s or '
                             f'more often, over {LONGEST_S:g} s at most')
        if knots[0] > -PAD_S * 1e9 or knots[-1] <= PAD_S * 1e9:
            first = recording.start_s + knots[0] * 1e-9
            raise ValueError(f'motion.recording.start_s is {recording.start_s:g} s; expected '
                             f'{first + PAD_S:.6g} to {first + length_s - PAD_S:.6g} s, because a '
                             f'run cannot use the ends of {recording.path}, {PAD_S:g} s each')

    def _smoothing_report(self, window_s, t):
        report = (f'{self.path}: smoothed with a boxcar of {window_s:g} s, which removes motion '
                  f'above {BOXCAR_3DB / window_s:.3g} Hz (-3 dB)')
        if window_s < 2.0 * median_interval(np.diff(t)):
            report += '; a window shorter than two intervals has almost no effect'
        if window_s > 2.0 * PAD_S:
            report += (f'; it narrows towards the ends, within {0.5 * window_s:g} s of the first '
                       'and the last row')
        return [report]

    def at(self, t_ns):
        """
        Return the Truth at motion times t_ns (n,) int64.

        Raises ValueError outside -3 s .. end_s + 3 s.
        """
        t_ns = np.asarray(t_ns, dtype=np.int64)
        first, last = self._span
        if t_ns.size and (t_ns.min() < first or t_ns.max() > last):
            bad = int(t_ns.min() if t_ns.min() < first else t_ns.max())
            raise ValueError(f'motion time {bad * 1e-9:.9g} s is outside the recording '
                             f'{self.path}; expected {-PAD_S:g} to {last * 1e-9:.9g} s')
        if len(t_ns) <= BLOCK:
            return self._at(t_ns)
        return Truth.concatenate(self._at(t_ns[k:k + BLOCK])
                                 for k in range(0, len(t_ns), BLOCK))

    def _at(self, t_ns):
        interval = np.searchsorted(self._knots, t_ns, side='right') - 1
        interval = np.minimum(interval, len(self._knots) - 2)
        h = (t_ns - self._knots[interval]) * 1e-9
        value, rate, half = _horner2(self._position[:, :, interval], h)
        value += self._origin[:, None]
        lat, lon, height = (taylor.Series(np.array([value[k], rate[k], half[k]]))
                            for k in range(3))
        step = _exponential(*_horner(self._rotation[:, :, interval], h), self._terms)
        base = self._base[interval]
        q_nb = quaternion.multiply(tuple(base[:, k] for k in range(4)), step)
        return truth_from_pose(t_ns, lat, lon, height, q_nb, self._earth_rotation,
                               self._gravity)


def _horner(c, x):
    """Return value and first derivative at x of a polynomial; c: coefficients, highest first."""
    p, d = c[0] + 0.0 * x, 0.0
    for coefficient in c[1:]:
        d = d * x + p
        p = p * x + coefficient
    return p, d


def _horner2(c, x):
    """Return the Taylor coefficients at x: value, first and half the second derivative."""
    p, d, e = c[0], 0.0, 0.0
    for coefficient in c[1:]:
        e = e * x + d
        d = d * x + p
        p = p * x + coefficient
    return p, d, e


def _terms(c, dt):
    """Return the number of terms of _COS and _SINC needed for rotation vectors c, (4, 3, m)."""
    power = dt ** np.arange(len(c) - 1, -1, -1)[:, None]
    bound = (np.abs(c) * power[:, None, :]).sum(axis=0)
    x = 0.25 * float((bound * bound).sum(axis=0).max())
    return next((n for n in range(2, len(_COS))
                 if x ** n < 1e-17 * math.factorial(2 * n - 1)), len(_COS))


def _exponential(r, r_rate, terms):
    """
    Return the quaternion Series of order 1 of a rotation vector (3, n), rad, and its rate.

    (S(x) u, C(x)) with u = r / 2, x = u . u, S = sinc and C = cos of sqrt x; C' = -S u . u'.
    terms: number of terms used of both power series.
    """
    u, w = 0.5 * r, 0.5 * r_rate
    x = u[0] * u[0] + u[1] * u[1] + u[2] * u[2]
    dot = u[0] * w[0] + u[1] * w[1] + u[2] * w[2]
    c = _horner(_COS[-terms:], x)[0]
    s, slope = _horner(_SINC[-terms:], x)
    s_rate = slope * (2.0 * dot)
    return tuple(taylor.Series(np.array([s * u[k], s_rate * u[k] + s * w[k]]))
                 for k in range(3)) + (taylor.Series(np.array([c, -s * dot])),)
