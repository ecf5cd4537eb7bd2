"""What the motion of a record cannot tell: delays that do not show, and what looks alike."""

import math

import numpy as np

from ins_sim.core.numerics.units import DEG
from .channel_fit import PRIOR
from .channel_sums import AXES, BIAS, DELAY, LAST, other_axes, SCALE

# A delay whose sigma is longer than this part of the sampling period has not been measured.
COARSE = 0.1

# Turns of the Jacobi method; some matrices of 6 need 8.
SWEEPS = 50
# A part of a direction that is smaller than this is not named.
NAMED = 0.2


def unobservable(axis, fit, change, dt_s):
    """
    Return why the readings do not tell the delay of a channel, a sentence without its end, or ''.

    axis: 0, 1, 2; fit: ChannelFit; change: greatest derivative of its rate, rad/s^2; dt_s:
    sampling period, s. It is told by the priors where they make more than half of its variance.
    """
    name, sigma = AXES[axis], fit.delay_sigma
    if fit.told_by_prior > 0.5:
        row = fit.covariance[DELAY]
        k = SCALE + int(np.argmax(np.abs(row[SCALE:LAST + 1])))
        what = ('ppm of its scale factor' if k == SCALE else
                f'urad of misalignment towards {AXES[other_axes(axis)[k - SCALE - 1]]}')
        return (f'a delay of {name} of 1 us reads like {abs(row[k] / row[DELAY]):.3g} {what} '
                f'(sigma {1e6 * sigma:.4g} us)')
    if sigma > COARSE * dt_s:
        return (f'the rate of {name} changes by at most {change / DEG:.3g} deg/s^2, which leaves '
                f'a sigma of {1e6 * sigma:.4g} us; expected less than '
                f'{1e6 * COARSE * dt_s:.4g} us, a tenth of the sampling period')
    return ''


def weak_directions(fit, sums):
    """
    Return combinations of the values of a channel that the readings tell less of than the priors.

    fit: ChannelFit; sums: its ChannelSums. The result is a tuple of arrays (m,) in the units of
    ``ChannelFit.values``, with zeros for what hardly takes part. Values are measured by what is
    known of them beforehand. A delay has no such measure and takes the one with which it errs as
    much as a misalignment of 1e-3, and so does a bias.
    """
    count = float(np.add.reduce(np.concatenate([one.count for one in sums])))
    rate = math.sqrt(max(_total(one.turning for one in sums), 0.0) / count)
    change = math.sqrt(_total(float(np.add.reduce(one.normal, axis=0)[DELAY, DELAY])
                              for one in sums) / count)
    unit = np.full(len(fit.values), PRIOR)
    unit[DELAY] = PRIOR * rate / change if change else 1.0
    unit[BIAS:] = PRIOR * rate if rate else 1.0
    sizes, directions = eigenvectors(fit.information * unit * unit[:, None])
    found = []
    for v in _echelon(directions.T[sizes < 1.0]):
        v = np.where(np.abs(v) >= NAMED * np.abs(v).max(), v, 0.0)
        found.append(v * unit * math.copysign(1.0, v[np.flatnonzero(v)[0]]))
    return tuple(found)


def _echelon(rows):
    """Return rows that span what the given ones do, each with zeros where another has its one."""
    rows = rows.copy()
    for k in range(len(rows)):
        place = int(np.argmax(np.abs(rows[k:])))
        at, column = k + place // rows.shape[1], place % rows.shape[1]
        rows[[k, at]] = rows[[at, k]]
        rows[k] = rows[k] / rows[k, column]
        for i in range(len(rows)):
            if i != k:
                rows[i] = rows[i] - rows[i, column] * rows[k]
    return rows


def _total(values):
    total = 0.0
    for value in values:
        total += value
    return total


def eigenvectors(a):
    """
    Return eigenvalues (m,) and eigenvectors, columns (m, m), of a symmetric matrix.

    By the cyclic method of Jacobi (Golub and Van Loan, section 8.5), whose bits are those of
    + - * / sqrt alone.
    """
    a, v = a.copy(), np.eye(len(a))
    for _ in range(SWEEPS):
        off = False
        for p in range(len(a) - 1):
            for q in range(p + 1, len(a)):
                if abs(a[p, q]) <= 1e-15 * math.sqrt(abs(a[p, p] * a[q, q])):
                    continue
                off = True
                theta = (a[q, q] - a[p, p]) / (2.0 * a[p, q])
                t = math.copysign(1.0, theta) / (abs(theta) + math.sqrt(theta * theta + 1.0))
                c = 1.0 / math.sqrt(t * t + 1.0)
                s = t * c
                for m in (a, a.T, v):
                    m[:, p], m[:, q] = c * m[:, p] - s * m[:, q], s * m[:, p] + c * m[:, q]
        if not off:
            break
    return np.diagonal(a).copy(), v
