"""A recorded IMU of any rate and with faults: samples in order, losses counted, gaps."""

from bisect import bisect_left
from dataclasses import dataclass, replace

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.instants import seconds
from ins_sim.core.timeseries.histories import History


@dataclass(frozen=True, eq=False)
class RecordedImu(History):
    """
    Samples as they were recorded, in the sensor frame s or in the body frame b.

    Attributes
    ----------
    t_ns : (n,) int64 stamps
    omega : (n, 3) angular rates, rad/s
    f : (n, 3) specific forces, m/s^2
    q_ns : (n, 4) orientations from the messages, NaN for messages without an orientation

    """

    t_ns: np.ndarray
    omega: np.ndarray
    f: np.ndarray
    q_ns: np.ndarray

    @property
    def step_ns(self):
        """Return the median step of the stamps, ns."""
        return float(np.median(np.diff(self.t_ns)))

    def turned(self, q_bs):
        """Return the samples rotated into b; q_bs maps s to b."""
        def turn(vectors):
            return np.stack(quaternion.rotate(q_bs, vectors.T), axis=-1)

        q_nb = quaternion.multiply(self.q_ns.T, quaternion.conjugate(q_bs))
        return RecordedImu(self.t_ns, turn(self.omega), turn(self.f), np.stack(q_nb, axis=-1))

    def less_bias(self, bias):
        """Return the samples with a gyro bias (3,), rad/s, subtracted."""
        return replace(self, omega=self.omega - bias)


@dataclass(frozen=True)
class Losses:
    """
    Numbers of dropped samples.

    not_finite; repeated: same stamp as the sample before; out_of_order; first_back: text about
    the first stamp that goes back, or ''.
    """

    not_finite: int
    out_of_order: int
    repeated: int = 0
    first_back: str = ''


def ordered_samples(imu):
    """
    Return the finite samples with increasing stamps, and the Losses.

    If stamps are out of order, the smallest possible number of samples is dropped (longest
    increasing subsequence; Fredman, Discrete Mathematics 11, 1975): a single stamp far ahead costs
    one sample, not all that follow. Raises ValueError if fewer than two samples remain.
    """
    finite = np.isfinite(imu.omega).all(axis=1) & np.isfinite(imu.f).all(axis=1)
    good = imu[finite]
    steps = np.diff(good.t_ns)
    kept, back = good, ''
    if len(good) and (steps <= 0).any():
        kept = good[_rising(good.t_ns.tolist())]
    if (steps < 0).any():
        k = int(np.argmax(steps < 0))
        back = f' (the first by {-int(steps[k]) * 1e-9:.9g} s after {seconds(good.t_ns[k])})'
    dropped = len(good) - len(kept)
    repeated = min(dropped, int(np.count_nonzero(steps == 0)))
    losses = Losses(int(np.count_nonzero(~finite)), dropped - repeated, repeated, back)
    if len(kept) < 2:
        more = '' if not repeated else (
            f', and {repeated} with the stamp of the one before, {seconds(good.t_ns[0])}')
        way = '' if not repeated else (
            '; stamps.source log uses the log times of a bag, and stamps.source even '
            'computes the stamps from stamps.rate_hz')
        raise ValueError(f'the IMU has {len(imu)} samples, {losses.not_finite} of them not finite '
                         f'and {losses.out_of_order} out of order{more}; expected at least two '
                         f'good ones{way}')
    return kept, losses


def _rising(stamps):
    """Return the indices of a longest strictly increasing subsequence."""
    ends, tails, before = [], [], []
    for k, stamp in enumerate(stamps):
        place = bisect_left(tails, stamp)
        before.append(ends[place - 1] if place else -1)
        if place == len(tails):
            tails.append(stamp)
            ends.append(k)
        else:
            tails[place], ends[place] = stamp, k
    indices, k = [], ends[-1]
    while k >= 0:
        indices.append(k)
        k = before[k]
    return indices[::-1]


def find_gaps(t_ns, factor):
    """Return the indices k for which the step to k + 1 exceeds factor times the median step."""
    return np.flatnonzero(np.diff(t_ns) > gap_limit_ns(t_ns, factor))


def gap_limit_ns(t_ns, factor):
    """Return the longest step that is not a gap: factor times the median step."""
    return float(factor * np.median(np.diff(t_ns)))
