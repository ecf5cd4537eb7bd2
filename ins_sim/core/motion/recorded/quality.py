"""
Report, in sentences, rounding noise and correction steps of a recording.

Differentiating rounded positions twice at a high rate can add specific-force noise of several
m/s^2; the functions here compute how much.
"""

import math

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.instants import seconds
from .faults import step_displacements, step_excess

# Noise below 10 mg is not reported: the motion of a vehicle hides it.
WORTH_SAYING_M_S2 = 0.1

# A correction step is reported if it implies an acceleration or rate that most vehicles cannot
# reach, and if it is an outlier (1.4826 median |x| is the sigma of a normal x; 8 sigma practically
# never occurs by chance).
STEP_M_S2 = 20.0
STEP_DEG_S = 100.0
STEP_SIGMAS = 8.0

# Rms gains for white noise of the second difference (sqrt 6) and of half the fourth difference
# (sqrt 70 / 2), from the binomial coefficients 1 2 1 and 1 4 6 4 1.
SECOND_GAIN = math.sqrt(6.0)
FOURTH_GAIN = 0.5 * math.sqrt(70.0)


def spline_gain(window=0.0):
    """
    Return the rms gain from white position noise to the acceleration of the spline, in 1/dt^2.

    For the interpolating spline of degree 5 with uniform knots,
    D(w) = (-1 + 2/3 cos w + 1/3 cos 2w) / ((66 + 52 cos w + 2 cos 2w) / 120), from the values of
    the quintic B-spline and of its second derivative at the knots (de Boor).  window: length of
    the boxcar that smoothed the positions, in dt; without one the gain is 4.798.
    """
    w = (np.arange(4096) + 0.5) * (math.pi / 4096)
    d = ((-1.0 + 2.0 / 3.0 * np.cos(w) + np.cos(2.0 * w) / 3.0)
         / ((66.0 + 52.0 * np.cos(w) + 2.0 * np.cos(2.0 * w)) / 120.0))
    return float(np.sqrt(np.mean((d * np.sinc(window * w / (2.0 * math.pi))) ** 2)))


def rounding_noise(resolution, lat, height, interval_s, smoothing_s):
    """
    Return the acceleration noise caused by rounded positions: east, north, up, m/s^2 rms.

    Parameters
    ----------
    resolution : rounding steps (deg, deg, m) of lat, lon, height; a step q has the standard
        deviation q / sqrt(12)
    lat, height : latitude (rad) and height (m), to convert degrees to metres
    interval_s, smoothing_s : sampling interval, and length of the boxcar, s

    """
    level = ellipsoid.level_metres(math.radians(resolution[0]), math.radians(resolution[1]),
                                   math.sin(lat), math.cos(lat), height)
    gain = spline_gain(smoothing_s / interval_s) / interval_s ** 2
    return np.array([q / math.sqrt(12.0) * gain for q in (*level, resolution[2])])


def sample_noise(t, lat, lon, height):
    """
    Return the rms and the robust (median-based) noise of the second differences, (2, 3) m/s^2.

    Columns: east, north, up.  The noise is the difference between a second difference and the
    mean of its two neighbours, scaled by the gains for white noise; a smooth motion leaves only
    its fourth derivative in it.
    """
    dt = np.diff(t)
    velocity = step_displacements(lat, lon, height) / dt[:, None]
    second = np.diff(velocity, axis=0) / (0.5 * (dt[1:] + dt[:-1]))[:, None]
    beyond = second[1:-1] - 0.5 * (second[2:] + second[:-2])
    rms = np.sqrt(np.mean(beyond ** 2, axis=0))
    robust = 1.4826 * np.median(np.abs(beyond), axis=0)
    return np.stack([rms, robust]) * (SECOND_GAIN / FOURTH_GAIN)


def _stand_out(size, least):
    return np.flatnonzero(size > np.maximum(least, STEP_SIGMAS * 1.4826 * np.median(size)))


def _count(items, name):
    return f'{len(items)} {name}' + ('s' if len(items) != 1 else '')


def _cadence(t, steps):
    """Return ', about one every x s' if the steps are periodic, else ''."""
    if len(steps) < 4:
        return ''
        # Two consecutive intervals with a step are counted as one step.
    apart = np.diff(t[steps])
    apart = apart[apart > 2.5 * np.median(np.diff(t))]
    return f', one about every {np.median(apart):.3g} s' if len(apart) > 2 else ''


def describe_quality(path, start_ns, t, lat, lon, height, turns, resolution, smoothing_s):
    """
    Return sentences on the noise and the steps of a recording, as they affect its spline.

    Parameters
    ----------
    path, start_ns : name of the recording, and stamp of its first row
    t : (n,) time since the first row, s
    lat, lon, height : (n,) rad, rad, m
    turns : (n - 1, 3) rotation vectors from row to row, rad
    resolution : see ``rounding_noise``
    smoothing_s : length of the boxcar already applied, s

    """
    dt = np.diff(t)
    interval_s = float(np.median(dt))
    sentences = []
    far = step_excess(step_displacements(lat, lon, height), dt)
    steps = _stand_out(far, STEP_M_S2 * interval_s ** 2)
    if len(steps):
        worst = steps[np.argmax(far[steps])]
        sentences.append(
            f'{path}: {_count(steps, "position step")}{_cadence(t, steps)}, the largest '
            f'{far[worst]:.3g} m after t_s = {seconds(start_ns + round(t[worst] * 1e9))}; '
            f'in the spline this becomes about {far[worst] / dt[worst] ** 2:.2g} m/s^2')
    turned = np.degrees(step_excess(turns, dt))
    steps = _stand_out(turned, STEP_DEG_S * interval_s)
    if len(steps):
        worst = steps[np.argmax(turned[steps])]
        at = seconds(start_ns + round(t[worst] * 1e9))
        sentences.append(
            f'{path}: {_count(steps, "attitude step")}{_cadence(t, steps)}, '
            f'the largest {turned[worst]:.3g} deg after t_s = {at}')
    rounding = rounding_noise(resolution, float(lat.mean()), float(height.mean()), interval_s,
                              smoothing_s)
    rms, robust = sample_noise(t, lat, lon, height)
    # Values with few decimals may be exact: report rounding only if the values scatter accordingly
    # (white noise scatters by half the force noise).
    rounding[rms < 0.1 * rounding] = 0.0
    if rounding.max() >= WORTH_SAYING_M_S2:
        sentences.append(
            f'{path}: positions rounded to {resolution[0]:.1g} deg, {resolution[1]:.1g} deg, '
            f'{resolution[2]:.1g} m and differentiated twice at {1.0 / interval_s:.4g} Hz put '
            f'{_enu(rounding)} m/s^2 rms of noise (east, north, up) into the specific force; '
            'motion.recording.smoothing_s reduces it')
    if rms.max() >= WORTH_SAYING_M_S2:
        sentences.append(
            f'{path}: the second differences of its positions scatter from row to row by '
            f'{_enu(rms)} m/s^2 rms (east, north, up), {_enu(robust)} m/s^2 without the outliers')
    return sentences


def _enu(values):
    return '/'.join(f'{value:.2g}' for value in values)
