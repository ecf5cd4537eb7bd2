"""Delays, biases, scale factors and misalignments of a gyro triad from bench records."""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.numerics import fixed_order
from .bench_record import usable
from .channel_fit import fit_by_residuals, fit_channel, residual_noise
from .channel_sums import AXES, BIAS, channel_sums, DELAY, LAST, other_axes, SCALE
from .separability import unobservable, weak_directions

BY_WALK, BY_RESIDUALS = 'angle random walk', 'residuals'
# A scale factor error or misalignment above this shows that the motion is another one.
FOREIGN = 0.3
# A scale factor cannot be found from rates that vary by less, rad/s.
SLOW = 1e-3
# Largest difference between records of one instrument, in standard deviations.
APART = 6.0
# Change of a delay, s, below which it need not be linearised again; and derivative of the rate,
# rad/s^2, below which the bench does not turn.
SETTLED_S, LEAST_CHANGE = 1e-7, 1e-12
# Largest number of linearisations of a delay, and longest delay that is searched for, s.
PASSES, LONGEST_S = 10, 1.0


class NotObservable(ValueError):
    """Raised if the motion of the records does not show the delay of any channel."""


@dataclass(frozen=True, eq=False)
class ChannelEstimate:
    """
    The estimate for one gyro channel.

    Attributes
    ----------
    axis : 'x', 'y' or 'z', of FLU
    values : (m,) delay and lag (s), scale factor, misalignments towards ``towards`` (rad),
        asymmetry of the scale factor, and mean bias in each record (rad/s)
    covariance : (m, m) covariance of the values
    towards : the axes towards which misalignments turn the sensitive axis
    refused : why the delay is not observable, or ''
    weights : BY_WALK or BY_RESIDUALS, the source of the standard deviations
    ratio, limit : variance of the delay from the residuals divided by that from the angle random
        walk, and the value it exceeds once in a thousand times; ratio is 1 for an unknown walk
    noise, left : (records,) assumed standard deviation of a sample, and rms residuals, rad/s
    weak : arrays (m,), combinations of the values that the readings do not determine
    change : greatest derivative of the rate, rad/s^2
    blocks : for each record, middles of its blocks (n,), s, and their mean residuals divided by
        the expected standard deviation
    bins : (n,) each: derivative of the rate (rad/s^2), reading minus everything but the delay,
        residual, and its standard deviation (rad/s)
    """

    axis: str
    values: np.ndarray
    covariance: np.ndarray
    towards: tuple
    refused: str
    weights: str
    ratio: float
    limit: float
    noise: np.ndarray
    left: np.ndarray
    weak: tuple
    change: float
    blocks: tuple
    bins: tuple

    @property
    def delay(self):
        """Delay and lag of the channel, s."""
        return float(self.values[DELAY])

    @property
    def sigmas(self):
        """Standard deviations of the values, (m,)."""
        return np.sqrt(np.diagonal(self.covariance))

    @property
    def delay_sigma(self):
        """Standard deviation of the delay, s."""
        return float(self.sigmas[DELAY])


@dataclass(frozen=True, eq=False)
class TriadEstimate:
    """
    The estimate for a gyro triad.

    Attributes
    ----------
    channels : ChannelEstimates
    records : names of the records
    notes : sentences
    lags : (3,) apparent delay due to the bandwidth of the instrument, s; NaN if the motion does
        not show it; None if no bandwidth is known
    """

    channels: tuple
    records: tuple
    notes: tuple
    lags: np.ndarray | None = None


def estimate_triad(records):
    """
    Return the TriadEstimate from BenchRecords of one gyro triad.

    Delay, scale factor and misalignments are common to all records; each record has its own bias.

    Raises
    ------
    ValueError
        If a record is too short or does not belong to the given motion.
    NotObservable
        If the records do not show the delay of any channel.
    """
    kept, notes = [], []
    for record in records:
        record, said = usable(record)
        kept.append(record)
        notes += said
    channels = tuple(_channel(kept, axis) for axis in range(3))
    if all(c.refused for c in channels):
        raise NotObservable('delays are not observable in this motion: '
                            + '; '.join(c.refused for c in channels))
    notes += [f'{c.axis}: the residuals scatter {math.sqrt(c.ratio):.3g} times as much as the '
              'angle random walk predicts; the standard deviations are computed from the '
              'residuals'
              for c in channels if c.weights == BY_RESIDUALS and c.ratio > c.limit]
    return TriadEstimate(channels, tuple(r.name for r in records), tuple(notes))


def noise_of(records, axis):
    """Return the standard deviation of a sample from the angle random walk, (records,) rad/s."""
    return np.array([r.white[axis] / math.sqrt(r.dt_ns * 1e-9) for r in records])


def _channel(records, axis):
    """Return the ChannelEstimate of an axis; its delay is linearised until it converges."""
    walk, dt_s = noise_of(records, axis), min(r.dt_ns for r in records) * 1e-9
    late_ns, change, settled = 0, 0.0, False
    for _ in range(PASSES):
        sums = [channel_sums(r, axis, late_ns, change) for r in records]
        seen, change = change, max(LEAST_CHANGE, *(s.most for s in sums))
        if not settled:
            # Far from the delay the residuals come from the linearisation, not from noise. Weights
            # as weak as these keep the fit from using the parameters that the priors hold.
            weak = residual_noise(sums, np.zeros(BIAS + len(sums)))
            fit = fit_channel(sums, np.maximum(walk, weak))
            noise = walk if walk.all() else residual_noise(sums, fit.values)
            settled = bool(abs(fit.values[DELAY]) <= SETTLED_S or unobservable(
                axis, fit_channel(sums, noise), change, dt_s))
        if settled:
            fit, noise = (fit_channel(sums, walk), walk) if walk.all() else fit_by_residuals(sums)
            _check_motion(records, axis, fit, sums)
            refused = unobservable(axis, fit, change, dt_s)
            if seen and (refused or abs(fit.values[DELAY]) <= max(SETTLED_S,
                                                                  0.01 * fit.delay_sigma)):
                _check_one_instrument(records, axis, sums, noise, fit, dt_s)
                return _estimate(axis, late_ns, sums, fit, noise, bool(walk.all()), refused, seen)
            late_ns += 0 if refused else round(float(fit.values[DELAY]) * 1e9)
        else:
            late_ns += round(float(fit.values[DELAY]) * 1e9)
        if abs(late_ns) > LONGEST_S * 1e9:
            raise ValueError(f'{_names(records)}: the delay of {AXES[axis]} is estimated as '
                             f'{late_ns * 1e-9:.4g} s; expected at most {LONGEST_S:g} s: do the '
                             'stamps use the clock of the motion?')
    raise ValueError(f'{_names(records)}: the delay of {AXES[axis]} does not converge in '
                     f'{PASSES} iterations; expected readings of the given motion, with stamps '
                     'of its clock')


def _names(records):
    return ', '.join(r.name for r in records)


def _check_motion(records, axis, fit, sums):
    """
    Raise ValueError if the readings belong to another motion.

    With large residuals the priors hold scale factor and misalignments. The regression of the
    readings on the rate alone then shows that the two are unrelated.
    """
    off = fit.values[SCALE:LAST + 1].tolist()
    k = max(range(len(off)), key=lambda place: abs(off[place]))
    what = ('scale factor' if k == 0 else
            f'misalignment towards {AXES[other_axes(axis)[k - 1]]}')
    found = off[k]
    if abs(found) <= FOREIGN:
        found, what = _alone(sums), 'scale factor'
    if abs(found) > FOREIGN:
        raise ValueError(f'{_names(records)}: the {what} of {AXES[axis]} is estimated as '
                         f'{found:.3g}; expected less than {FOREIGN:g}: the readings do not '
                         'belong to the given motion, or their stamps not to its clock')


def _check_one_instrument(records, axis, sums, noise, fit, dt_s):
    """Raise ValueError if a record alone gives another delay than all records together."""
    for record, one, sigma in zip(records, sums, noise):
        alone = fit_channel([one], [sigma])
        off = float(alone.values[DELAY] - fit.values[DELAY])
        if len(records) > 1 and not unobservable(axis, alone, one.most, dt_s) and (
                abs(off) > APART * alone.delay_sigma + SETTLED_S):
            raise ValueError(f'{record.name}: the delay of {AXES[axis]} differs by '
                             f'{1e6 * off:.4g} us from the delay of all records together, with a '
                             f'sigma of {1e6 * alone.delay_sigma:.3g} us; expected records of one '
                             'instrument')


def _alone(sums):
    """Return the regression of (reading - rate) on the rate; 0 if it is not significant."""
    both = rate = left = count = 0.0
    for one in sums:
        n = float(np.add.reduce(one.count))
        normal, right = np.add.reduce(one.normal, axis=0), np.add.reduce(one.right, axis=0)
        both += float(right[SCALE] - right[BIAS] * normal[SCALE, BIAS] / n)
        rate += float(normal[SCALE, SCALE] - normal[SCALE, BIAS] * normal[SCALE, BIAS] / n)
        square = fixed_order.total(one.square.tolist())
        left += square - float(right[BIAS] * right[BIAS]) / n
        count += n
    if rate <= count * SLOW * SLOW:
        return 0.0
    found, sigma = both / rate, math.sqrt(max(left, 0.0) / count / rate)
    return found if abs(found) > 5.0 * sigma else 0.0


def _estimate(axis, late_ns, sums, fit, noise, walk_known, refused, most):
    values = fit.values.copy()
    values[DELAY] += late_ns * 1e-9
    by_walk = walk_known and fit.ratio <= fit.limit
    covariance = fit.covariance if by_walk else fit.scattered
    blocks = tuple((s.t_s, _block_residuals(s, k, fit.values) * np.sqrt(s.count) / noise[k])
                   for k, s in enumerate(sums))
    return ChannelEstimate(
        AXES[axis], values, covariance, tuple(AXES[k] for k in other_axes(axis)), refused,
        BY_WALK if by_walk else BY_RESIDUALS, fit.ratio if walk_known else 1.0, fit.limit, noise,
        residual_noise(sums, fit.values), weak_directions(fit, sums), most, blocks,
        _bins(sums, fit.values, late_ns * 1e-9, noise))


def _block_residuals(sums, record, values):
    """Return the mean residual of each block of a record, rad/s."""
    x = np.append(values[:BIAS], values[BIAS + record])
    row = sums.normal[:, BIAS, :]
    expected = row[:, 0] * x[0]
    for k in range(1, len(x)):
        expected = expected + row[:, k] * x[k]
    return (sums.right[:, BIAS] - expected) / sums.count


def _bins(sums, values, late_s, noise):
    """Return the arrays of ``ChannelEstimate.bins``."""
    count = with_delay = left = weight = change_sum = 0.0
    for k, (one, sigma) in enumerate(zip(sums, noise)):
        x = np.append(values[:BIAS], values[BIAS + k])
        model = one.bins[:, 2] * x[0]
        for column in range(1, len(x)):
            model = model + one.bins[:, 2 + column] * x[column]
        residual = one.bins[:, 1] - model
        count = count + one.bins[:, 0]
        left = left + residual
        with_delay = with_delay + residual + one.bins[:, 2] * (x[0] + late_s)
        weight = weight + one.bins[:, 0] * (sigma * sigma)
        change_sum = change_sum - one.bins[:, 2]
    there = count > 0.0
    count = count[there]
    return (change_sum[there] / count, with_delay[there] / count, left[there] / count,
            np.sqrt(weight[there]) / count)
