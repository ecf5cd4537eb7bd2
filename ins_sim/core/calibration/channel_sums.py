"""
The linear model of a gyro channel, and the sums over a record that least squares needs.

A channel i with delay tau and errors of bias, scale factor and sensitive axis reads::

    y_i = w_i - tau w_i' + s w_i + m_ij w_j + m_ik w_k + a |w_i| + b,

where w are the mean true rates over the sampling interval and w_i' their derivative (Titterton and
Weston, section 11.2, and the delay term of Bogdanov and Fomichev 2018). The asymmetry a of the
scale factor is included, because under an oscillating motion it would be mistaken for a bias. The
model is linear in all unknowns. If the delay is not small compared with the period of the motion,
w is evaluated at t - tau for the delay found so far (Gauss-Newton iteration). An angle random walk
is white noise of the rate, so the readings need no further whitening.
"""

from dataclasses import dataclass

import numpy as np

from .bench_record import TrueRates

# The columns of the model: delay, scale factor, misalignments towards the next two axes, asymmetry
# of the scale factor, bias.
DELAY, SCALE, NEXT, LAST, ASYMMETRY, BIAS = range(6)
COLUMNS = 6
AXES = 'xyz'
# Number of blocks of a record; the scatter of their sums tells how white the residuals are.
BLOCKS = 64
# Number of readings whose true rates are in memory at the same time.
AT_ONCE = 16384
# Half the interval for numerical derivatives of rates, ns; the relative error is (w h)^2 / 6.
STEP_NS = 2000
# Number of intervals of the rate's derivative over which residuals are shown.
BINS = 24


def other_axes(axis):
    """Return the other two axes, in the order of the columns NEXT and LAST."""
    return (axis + 1) % 3, (axis + 2) % 3


@dataclass(frozen=True, eq=False)
class ChannelSums:
    """
    Sums of one channel over a record, unweighted.

    Let a be the columns of the model and z the reading minus the true rate.

    Attributes
    ----------
    normal, right, square, count : (BLOCKS, 6, 6), (BLOCKS, 6), (BLOCKS,), (BLOCKS,) sums of a'a,
        a'z, z'z and 1 over each block
    bins : (BINS, 8) sums of 1, z and a over intervals of the derivative of the rate
    most : greatest absolute derivative, rad/s^2
    turning : sum over readings and axes of the squared rates minus their means, (rad/s)^2
    t_s : (BLOCKS,) middles of the blocks, s
    """

    normal: np.ndarray
    right: np.ndarray
    square: np.ndarray
    count: np.ndarray
    bins: np.ndarray
    most: float
    turning: float
    t_s: np.ndarray


def channel_sums(record, axis, late_ns, most=0.0):
    """
    Return the ChannelSums of a BenchRecord for one axis.

    Parameters
    ----------
    record : BenchRecord
    axis : 0, 1 or 2
    late_ns : delay about which the model is linearised, ns
    most : greatest derivative in ``bins``, rad/s^2; 0 for no bins
    """
    rates, imu = TrueRates(record), record.imu
    edges = np.arange(BLOCKS + 1) * len(imu) // BLOCKS
    normal, right = np.zeros((BLOCKS, COLUMNS, COLUMNS)), np.zeros((BLOCKS, COLUMNS))
    square, bins = np.zeros(BLOCKS), np.zeros((BINS, COLUMNS + 2))
    largest, total, squares = 0.0, np.zeros(3), np.zeros(3)
    for first in range(0, len(imu), AT_ONCE):
        part = imu[first:first + AT_ONCE]
        columns, true = _columns(rates, part.t_ns, axis, late_ns)
        left = part.omega[:, axis] - true[:, axis]
        largest = max(largest, float(np.abs(columns[:, DELAY]).max()))
        total, squares = (np.add.reduce(np.concatenate([old[None], new]), axis=0)
                          for old, new in ((total, true), (squares, true * true)))
        for block in range(BLOCKS):
            low, high = (min(max(int(e) - first, 0), len(part)) for e in edges[block:block + 2])
            if low < high:
                a, z = columns[low:high], left[low:high, None]
                normal[block] += np.add.reduce(a[:, :, None] * a[:, None, :], axis=0)
                right[block] += np.add.reduce(a * z, axis=0)
                square[block] += np.add.reduce(z * z, axis=0)[0]
        if most:
            _add_to_bins(bins, columns, left, most)
    mean = total / len(imu)
    turning = squares - len(imu) * mean * mean
    middles = imu.t_ns[(edges[:-1] + edges[1:]) // 2] * 1e-9
    return ChannelSums(normal, right, square, np.diff(edges), bins, largest,
                       float(turning[0] + turning[1] + turning[2]), middles)


def _columns(rates, t_ns, axis, late_ns):
    """Return the columns of the model (n, 5) and the true rates (n, 3)."""
    after, before = rates.at(t_ns - late_ns + STEP_NS), rates.at(t_ns - late_ns - STEP_NS)
    true = 0.5 * (after + before)
    columns = np.empty((len(t_ns), COLUMNS))
    columns[:, DELAY] = (before[:, axis] - after[:, axis]) / (2e-9 * STEP_NS)
    columns[:, SCALE] = true[:, axis]
    columns[:, NEXT], columns[:, LAST] = (true[:, k] for k in other_axes(axis))
    columns[:, ASYMMETRY], columns[:, BIAS] = np.abs(true[:, axis]), 1.0
    return columns, true


def _add_to_bins(bins, columns, left, most):
    place = ((0.5 - 0.5 / most * columns[:, DELAY]) * BINS).astype(np.int64)
    place = np.minimum(np.maximum(place, 0), BINS - 1)
    rows = np.column_stack([np.ones(len(left)), left, columns])
    for k in range(COLUMNS + 2):
        bins[:, k] += np.bincount(place, rows[:, k], BINS)
