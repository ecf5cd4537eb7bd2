"""Amplitude, frequency and growth rate of a sampled oscillation."""

import math

import numpy as np

# Fraction at the end of a history over which its range is taken.
LAST = 0.3
FEWEST = 3


def half_range(values, part=LAST):
    """Return half the peak-to-peak value over the last part of a history (n,)."""
    last = values[len(values) - max(1, round(part * len(values))):]
    return 0.5 * float(last.max() - last.min())


def frequency(t_s, values):
    """
    Return the frequency, rad/s, from rising zero crossings in the last half of a history (n,).

    Return None if there are fewer than FEWEST.
    """
    half = len(t_s) // 2
    t, x = t_s[half:], values[half:] - values[half:].mean()
    k = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
    if len(k) < FEWEST:
        return None
    zeros = t[k] - x[k] * (t[k + 1] - t[k]) / (x[k + 1] - x[k])
    return 2.0 * math.pi * (len(zeros) - 1) / float(zeros[-1] - zeros[0])


def growth_rate(t_s, values):
    """
    Return the growth rate of an oscillation, 1/s, from its peaks in the last 60 %.

    Raises ValueError if there are fewer than FEWEST.
    """
    first = round(0.4 * len(t_s))
    t, size = t_s[first:], np.abs(values[first:])
    inside = size[1:-1]
    k = 1 + np.flatnonzero((inside > size[:-2]) & (inside >= size[2:]))
    if len(k) < FEWEST:
        raise ValueError(f'the oscillation has {len(k)} peaks; expected at least {FEWEST}')
    # Maximum of the parabola through a peak and its neighbours.
    low, top, high = size[k - 1], size[k], size[k + 1]
    peaks = top + (high - low) ** 2 / (8.0 * (2.0 * top - low - high))
    return float(np.polyfit(t[k], np.log(peaks), 1)[0])
