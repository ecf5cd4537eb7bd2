"""The limits of a record: delays that its motion does not show, and unknowns that look alike."""

import math

import numpy as np

from ins_sim.core.numerics.units import DEG
from .channel_fit import PRIOR
from .channel_sums import AXES, BIAS, DELAY, LAST, other_axes, SCALE

# A delay whose sigma exceeds this fraction of the sampling period has not been measured.
COARSE = 0.1

# Largest number of sweeps of the Jacobi method; some matrices of size 6 need 8.
SWEEPS = 50
# Components of a direction below this fraction of the largest are not named.
NAMED = 0.2


def unobservable(axis, fit, change, dt_s):
    """
    Return why the readings do not determine the delay of a channel, or ''.

    The reason is a sentence without its end. A delay is not determined if the priors contribute
    more than half of its variance.

    Parameters
    ----------
    axis : 0, 1 or 2
    fit : ChannelFit
    change : greatest derivative of the rate, rad/s^2
    dt_s : sampling period, s
    """
    name, sigma = AXES[axis], fit.delay_sigma
    if fit.told_by_prior > 0.5:
        row = fit.covariance[DELAY]
        k = SCALE + int(np.argmax(np.abs(row[SCALE:LAST + 1])))
        what = ('ppm of its scale factor' if k == SCALE else
                f'urad of misalignment towards {AXES[other_axes(axis)[k - SCALE - 1]]}')
        return (f'a delay of {name} of 1 us has the effect of {abs(row[k] / row[DELAY]):.3g} '
                f'{what} (sigma {1e6 * sigma:.4g} us)')
    if sigma > COARSE * dt_s:
        return (f'the rate of {name} changes by at most {change / DEG:.3g} deg/s^2, which leaves '
                f'a sigma of {1e6 * sigma:.4g} us; expected less than '
                f'{1e6 * COARSE * dt_s:.4g} us, a tenth of the sampling period')
    return ''


def weak_directions(fit, sums):
    """
    Return the combinations of values about which the readings tell less than the priors.

    The result is a tuple of arrays (m,) in the units of ``ChannelFit.values``; small components
    are set to zero. Values are scaled by their a-priori standard deviation. Delay and bias have
    none; they are scaled to cause the same error as a misalignment of 1e-3.

    Parameters
    ----------
    fit : ChannelFit
    sums : ChannelSums of the records
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
    """Return rows with the same span in echelon form: each has zeros at the pivots of others."""
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
    Return eigenvalues (m,) and eigenvectors, columns of (m, m), of a symmetric matrix.

    Cyclic Jacobi method (Golub and Van Loan, section 8.5). It uses only + - * / sqrt, so its bits
    are the same on every machine.
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
