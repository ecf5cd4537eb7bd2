"""
Find the longest evenly sampled part of a recorded IMU, as needed for an Allan deviation.

Samples count as evenly sampled if their stamps follow one rate over the record. A single stamp may
be late, early or part of a burst; it is corrected if the samples before and after it are within
half an interval of the even rate. Otherwise samples were lost or the clock has jumped, and the
record is cut there.
"""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.timeseries.histories import ImuSamples
from .allan import LEAST

# An interval is irregular if it differs from the usual one by more than this part of it. Samples
# were lost if the samples after it are late by more than that.
JITTER = 0.5
# Number of samples before and after an irregular interval that decide whether samples were lost;
# NEAR_IN_BURSTS if more than the part BURSTS of all intervals is irregular.
NEAR, NEAR_IN_BURSTS, BURSTS = 10, 400, 0.1
# Irregular intervals that recur with this evenness are caused by a coarse clock.
EVENLY = 0.25
# The rate is constant if the mean intervals of PARTS parts of the record agree within STEADY.
PARTS, STEADY = 100, 0.02
WAY_OUT = '"-p rate_hz:=HZ" uses all readings in their order, evenly spaced at that rate'


@dataclass(frozen=True)
class RegularRecord:
    """Evenly sampled part: ``imu``, ``rate_hz``, and ``notes``, sentences on what was changed."""

    imu: ImuSamples
    rate_hz: float
    notes: tuple


def regular_record(imu, rate_hz=None):
    """
    Return the longest evenly sampled part of ImuSamples.

    Parameters
    ----------
    imu : ImuSamples
    rate_hz : rate of all samples, Hz, regardless of their stamps; None to use the stamps

    Returns
    -------
    RegularRecord

    Raises
    ------
    ValueError : fewer than LEAST samples are left; the message says why
    """
    notes, total, given = [], len(imu), rate_hz is not None
    finite = np.isfinite(imu.omega).all(axis=1) & np.isfinite(imu.f).all(axis=1)
    if not finite.all():
        bad = total - np.count_nonzero(finite)
        notes.append(f'{bad} of {total} readings {"holds" if bad == 1 else "hold"} a value that '
                     'is not a number and counts as lost')
    if given:
        cuts = np.flatnonzero(np.diff(finite)) + 1
        imu = _longest(imu, cuts, finite, notes)
        notes.append(f'{len(imu)} readings are assumed to be spaced evenly at {rate_hz:.6g} Hz '
                     f'(rate_hz); the rate of their stamps is {_stamped_rate(imu.t_ns)}')
    else:
        imu = _without_copies(imu[finite], notes)
        if len(imu) >= LEAST:
            imu, rate_hz = _steady(imu, notes)
    if len(imu) < LEAST:
        stamps = not given and np.count_nonzero(finite) >= LEAST
        said = '; '.join(notes)
        raise ValueError(f'the record has {total} readings, of which {len(imu)} are left'
                         f'{f" ({said})" if said else ""}; expected at least {LEAST}'
                         f'{f"; {WAY_OUT}" if stamps else ""}')
    return RegularRecord(imu, rate_hz, tuple(notes))


def _stamped_rate(t_ns):
    length_s = (int(t_ns[-1]) - int(t_ns[0])) * 1e-9 if len(t_ns) else 0.0
    return f'{(len(t_ns) - 1) / length_s:.6g} Hz' if length_s > 0.0 else 'not defined'


def _longest(imu, cuts, good, notes):
    """Return the longest part between cuts whose readings are good."""
    edges = np.concatenate([[0], cuts, [len(imu)]])
    lengths = np.where(good[edges[:-1].clip(max=len(imu) - 1)], np.diff(edges), 0)
    k = int(np.argmax(lengths))
    part = imu[edges[k]:edges[k] + lengths[k]]
    if len(cuts) and len(part):
        since_s = (int(part.t_ns[0]) - int(imu.t_ns[0])) * 1e-9
        notes.append(f'the longest part between them is used: {len(part)} of {len(imu)} '
                     f'readings, from {since_s:.6g} s after the start')
    return part


def _without_copies(imu, notes):
    """Remove duplicate samples (same stamp and values)."""
    again = (np.diff(imu.t_ns) == 0) & (imu.omega[1:] == imu.omega[:-1]).all(axis=1) & (
        imu.f[1:] == imu.f[:-1]).all(axis=1)
    if again.any():
        twice = _told(np.count_nonzero(again), 'reading is', 'readings are')
        notes.append(f'{twice} present twice, with the same stamp and values; the copies are '
                     'removed')
        imu = imu[np.concatenate([[True], ~again])]
    return imu


def _steady(imu, notes):
    """Return the longest part at one rate, and that rate, Hz."""
    t_s = (imu.t_ns - imu.t_ns[0]) * 1e-9
    step = _usual_step(t_s)
    if not step > 0.0:
        raise ValueError(f'the stamps of the record do not increase: of {len(t_s) - 1} intervals '
                         f'{np.count_nonzero(np.diff(t_s) <= 0.0)} are not positive; {WAY_OUT}')
    cuts, late = _losses(t_s, step)
    if len(cuts):
        lost, jumps = int(np.round(late[late > 0.0]).sum()), int(np.count_nonzero(late < 0.0))
        back = f'the stamps fall behind at {_told(jumps, "place", "places")}'
        what = (f'{back} and jump forward by {lost} intervals in all' if jumps and lost else
                back if jumps else _told(lost, 'reading is lost', 'readings are lost'))
        notes.append(f'{what}, the first at {t_s[cuts[0] - 1]:.6g} s')
        imu = _longest(imu, cuts, np.full(len(imu), True), notes)
    imu = _at_one_rate(imu, notes)
    if len(imu) < LEAST:
        return imu, 1.0 / step
    t_s = (imu.t_ns - imu.t_ns[0]) * 1e-9
    count = np.arange(len(t_s))
    step, first = np.polyfit(count, t_s, 1)
    off = np.abs(t_s - first - step * count)
    uneven = int(np.count_nonzero(_odd(np.diff(t_s), step)))
    if uneven:
        notes.append(f'{uneven} of {len(t_s) - 1} intervals differ from {step:.6g} s by more than '
                     f'half of it: the stamps are evened out, by at most {off.max():.3g} s')
    return imu, 1.0 / float(step)


def _told(count, one, many):
    return f'{count} {one if count == 1 else many}'


def _odd(steps, step):
    return np.abs(steps - step) > JITTER * step


def _usual_step(t_s):
    """Return the usual interval, s: of neighbours if only losses disturb it, else the mean."""
    steps = np.diff(t_s)
    usual = float(np.median(steps))
    odd = np.count_nonzero(_odd(steps, usual))
    short = np.count_nonzero(steps < (1.0 - JITTER) * usual)
    apart = max(1, min(100, len(steps) // 4))
    mean = float(np.median(t_s[apart:] - t_s[:-apart])) / apart
    return usual if usual > JITTER * mean and short < BURSTS * odd else mean


def _losses(t_s, step):
    """
    Return the indices of samples before which others were lost, and how many were lost.

    In bursts, losses near an end of the record cannot be distinguished from a burst and are not
    found.
    """
    steps = np.diff(t_s)
    odd = np.flatnonzero(_odd(steps, step)) + 1
    bursts = len(odd) > BURSTS * len(steps) and (steps[odd - 1] < step).any()
    late = np.concatenate([[0.0], np.cumsum(t_s / step - np.arange(len(t_s)))])
    if not bursts:
        shift = _mean(late, odd, odd + NEAR) - _mean(late, odd - NEAR, odd)
        lost = np.abs(shift) > JITTER
        gaps = np.diff(odd[lost])
        if len(gaps) >= NEAR and gaps.std() < EVENLY * gaps.mean():
            # The irregular intervals are the beat of a coarse clock with the sampling rate.
            return odd[:0], shift[:0]
        return odd[lost], steps[odd[lost] - 1] / step - 1.0
    half = min(NEAR_IN_BURSTS, len(t_s) // 4) // 2
    odd = odd[(odd >= 2 * half) & (odd + 2 * half <= len(t_s))]
    two, one, none, more = (_mean(late, odd + k * half, odd + (k + 1) * half)
                            for k in (-2, -1, 0, 1))
    # Subtract the shift that a slow change of the rate causes.
    shift = (none + more - two - one) / 2.0 - (more - none + one - two)
    seen = np.flatnonzero(np.abs(shift) > JITTER)
    cuts, most = [], []
    for group in np.split(seen, np.flatnonzero(np.diff(odd[seen]) > 2 * half) + 1):
        if len(group):
            # The loss is somewhere between these two samples.
            cuts += [odd[group[0]], odd[group[-1]]]
            most += [shift[group[np.argmax(np.abs(shift[group]))]], 0.0]
    return np.array(cuts, dtype=int), np.array(most)


def _mean(sums, first, end):
    """Return the means between indices of a record, given its cumulative sums."""
    first, end = (np.clip(edge, 0, len(sums) - 1) for edge in (first, end))
    return (sums[end] - sums[first]) / np.maximum(end - first, 1)


def _at_one_rate(imu, notes):
    """Return the longest part in which the rate stays within STEADY."""
    steps = np.diff(imu.t_ns) * 1e-9
    # A part must be long enough for its mean not to be changed by one late stamp.
    least = NEAR_IN_BURSTS if _odd(steps, np.median(steps)).any() else 2 * NEAR
    edges = np.linspace(0, len(steps), min(PARTS, len(steps) // least + 1) + 1).astype(int)
    means = np.array([steps[a:b].mean() for a, b in zip(edges, edges[1:])])
    best = 0, 0
    for first in range(len(means)):
        lowest = np.minimum.accumulate(means[first:])
        highest = np.maximum.accumulate(means[first:])
        count = int(np.argmin(np.append(highest <= lowest * (1.0 + 2.0 * STEADY), False)))
        best = max(best, (count, -first))
    count, first = best[0], -best[1]
    if count == len(means):
        return imu
    part = imu[edges[first]:edges[first + count] + 1]
    notes.append(f'the rate changes, from {1.0 / means.max():.6g} to {1.0 / means.min():.6g} Hz: '
                 f'the longest part within {100.0 * STEADY:.0f} % of one rate is used, '
                 f'{len(part)} of {len(imu)} readings, from '
                 f'{(int(part.t_ns[0]) - int(imu.t_ns[0])) * 1e-9:.6g} s after its start')
    return part
