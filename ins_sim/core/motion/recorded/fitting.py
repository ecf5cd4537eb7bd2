"""
Fit splines to the samples of a recorded flight (docs/theory/recorded_flights.md).

The attitude relative to local ENU is a C2 rotation spline on the recorder's own times (SciPy's
RotationSpline: the rotation vector within an interval is a cubic); positions are interpolating
splines of degree 5. Do not use slerp or linear interpolation: they bias the drift by up to 51 %.
If the rate was recorded too, the attitude is the cubic through attitude and rate at both ends.
SciPy solves for the coefficients.
"""

import math

import numpy as np

from ins_sim.core.attitude.interpolation import hermite_coefficients

DEGREE = 5

# A recorded rate is rejected as inconsistent if it differs from the differences of the attitude
# by more than the error of the trapezium rule (a twelfth of the square of the angle between
# samples) plus the effect of rounding.
RATE_PART = 0.1
RATE_RAD_S = 1e-3


def turns(q):
    """Return (n - 1, 3) rotation vectors from row to row, rad."""
    from scipy.spatial.transform import Rotation
    rotation = Rotation.from_quat(q)
    return (rotation[:-1].inv() * rotation[1:]).as_rotvec()


def smoothed(t, position, q, window_s):
    """
    Return positions (3, n) and quaternions (n, 4) averaged over a window centred on each row.

    The average is the integral of the interpolating spline, so that uneven stamps are handled;
    near the ends the window narrows to stay centred. The attitude is the normalised mean of
    quaternions with continuous signs: the mean rotation to third order in the spread, without
    a singularity at 90 deg of pitch (Markley et al., "Averaging Quaternions", 2007).
    """
    from scipy.interpolate import make_interp_spline
    half = np.minimum(0.5 * window_s, np.minimum(t - t[0], t[-1] - t))
    inner = slice(1, -1)
    low, high = t[inner] - half[inner], t[inner] + half[inner]

    def mean(values, degree):
        integral = make_interp_spline(t, values, k=degree).antiderivative()
        result = values.copy()
        result[inner] = (integral(high) - integral(low)) / (high - low)[:, None]
        return result

    q = mean(q, 3)
    norm = np.sqrt((q * q).sum(axis=1))
    if norm.min() < 0.5:
        # Uniform rotation by an angle A gives 4 sin(A/4) / A; 0.5 is a turn of 434 deg.
        raise ValueError(f'motion.recording.smoothing_s is {window_s:g} s, in which the vehicle '
                         'turns more than once; expected a window shorter than one turn takes')
    return mean(position.T, DEGREE).T, q / norm[:, None]


def position_spline(t, position):
    """
    Return coefficients (6, 3, intervals), highest first, about the start of each interval.

    Each polynomial passes through value, first and second derivative of the spline at both ends
    of its interval, so that neighbours match to rounding. Higher derivatives of the spline, taken
    at one end, would leave steps of 1e-9 m/s: 1 mm in ten minutes of cruise at 100 Hz.
    """
    from scipy.interpolate import make_interp_spline
    spline = make_interp_spline(t, position.T, k=DEGREE)
    p, v, a = position, *(spline(t, nu=k).T for k in (1, 2))
    h = np.diff(t)
    # Remainder at the end of the interval beyond the parabola from its start, in position units.
    far = np.diff(p) - (v[:, :-1] + 0.5 * a[:, :-1] * h) * h
    faster = (np.diff(v) - a[:, :-1] * h) * h
    bent = 0.5 * np.diff(a) * h * h
    return np.array([(6.0 * far - 3.0 * faster + bent) / h ** 5,
                     (-15.0 * far + 7.0 * faster - 2.0 * bent) / h ** 4,
                     (10.0 * far - 4.0 * faster + bent) / h ** 3,
                     0.5 * a[:, :-1], v[:, :-1], p[:, :-1]])


def rotation_spline(t, q):
    """Return local coefficients (4, 3, intervals) of the rotation vector within an interval."""
    from scipy.spatial.transform import Rotation, RotationSpline
    spline = RotationSpline(t, Rotation.from_quat(q))
    return np.ascontiguousarray(np.moveaxis(spline.interpolator.c, 1, 2))


def rotation_cubics(t, q, rate):
    """Return the same coefficients from the rates (n, 3), rad/s, at the ends of each interval."""
    h = np.diff(t)
    c1, c2, c3 = map(np.array, hermite_coefficients(h, turns(q).T, rate[:-1].T, rate[1:].T))
    return np.array([c3 / h ** 3, c2 / h ** 2, c1 / h, np.zeros_like(c1)])


def check_rates(path, t, q, rate):
    """Reject rates (n, 3), rad/s, inconsistent with the attitude: another frame, or zeros."""
    turning = turns(q) / np.diff(t)[:, None]
    off = _rms(turning - 0.5 * (rate[1:] + rate[:-1]))
    if off > max(RATE_RAD_S, RATE_PART * _rms(turning)):
        raise ValueError(f'{path}: the angular velocity differs by {off:.3g} rad/s rms from the '
                         f'rotation rate of the attitude, {_rms(turning):.3g} rad/s; expected the '
                         'angular velocity of the body, resolved in body axes')


def _rms(vectors):
    return math.sqrt(np.mean((vectors * vectors).sum(axis=1)))
