"""
Windows of fixed duration in IMU samples, with their means and standard deviations.

Windows are counted from the first sample, so that samples that arrive one by one have the same
windows as a complete recording.
"""

import math
from typing import NamedTuple

import numpy as np

# Fewer samples in a window are too few for a variance estimate.
FEWEST = 5
# Samples are averaged in groups of at most 1 / BAND_HZ, s, before the standard deviation is taken.
BAND_HZ = 400.0


class StillWindow(NamedTuple):
    """
    A window: samples first to last (excluded) of a record, of a fixed duration.

    Attributes
    ----------
    middle_ns : its middle, ns
    full : whether at least half of its samples are present
    force, rate : (3,) means, m/s^2 and rad/s
    force_sd, rate_sd : standard deviations, rms over the axes, m/s^2 and rad/s
    moving : whether a reference measures a speed above the limit

    """

    first: int
    last: int
    middle_ns: int
    full: bool
    force: np.ndarray
    rate: np.ndarray
    force_sd: float
    rate_sd: float
    moving: bool = False


class WindowMoments:
    """
    Counts, means and standard deviations of the n windows of a record.

    Parameters
    ----------
    imu : RecordedImu
    step_ns : typical step of its stamps, ns
    length_ns : length of a window, ns

    Attributes
    ----------
    first, last : (n,) indices of the samples of each window, last excluded
    count : (n,) number of samples
    full : (n,) whether at least half of the samples are present
    together : number of samples that are averaged before the standard deviation is computed
    force, rate : (n, 3) means, m/s^2 and rad/s
    force_sd, rate_sd : (n,) standard deviations, rms over the axes, m/s^2 and rad/s
    middle_ns : (n,) middle of each window, ns

    """

    def __init__(self, imu, step_ns, length_ns):
        index = (imu.t_ns - imu.t_ns[0]) // length_ns
        self.first = np.flatnonzero(np.diff(index, prepend=-1))
        self.last = np.append(self.first[1:], len(imu))
        self.count = self.last - self.first
        self.full = self.count >= max(FEWEST, 0.5 * length_ns / step_ns)
        self.together = together_at(step_ns)
        self.force, self.force_sd = self._moments(imu.f)
        self.rate, self.rate_sd = self._moments(imu.omega)
        self.middle_ns = (imu.t_ns[self.first] + imu.t_ns[self.last - 1]) // 2

    def _moments(self, x):
        count = self.count[:, None]
        mean = np.add.reduceat(x, self.first) / count
        off, first = x - np.repeat(mean, self.count, axis=0), self.first
        if self.together > 1:
            off, first, count = self._grouped(off)
        variance = np.add.reduceat(off * off, first) / np.maximum(count - 1, 1)
        return mean, np.sqrt((variance[:, 0] + variance[:, 1] + variance[:, 2]) / 3.0)

    def _grouped(self, off):
        """
        Return means over ``together`` samples each, the starts of the windows, and the counts.

        The remaining samples at the end of a window are averaged separately.
        """
        within = np.arange(len(off)) - np.repeat(self.first, self.count)
        start = np.flatnonzero(within % self.together == 0)
        size = np.diff(np.append(start, len(off)))[:, None]
        counts = -(-self.count // self.together)
        first = np.append(0, np.cumsum(counts)[:-1])
        return np.add.reduceat(off, start) / size, first, counts[:, None]

    def each(self, moving):
        """Yield the n StillWindows; moving (n,): whether a reference moves in each of them."""
        for values in zip(self.first.tolist(), self.last.tolist(), self.middle_ns.tolist(),
                          self.full.tolist(), self.force, self.rate, self.force_sd.tolist(),
                          self.rate_sd.tolist(), moving.tolist()):
            yield StillWindow(*values)


def together_at(step_ns):
    """
    Return the number of samples that are averaged before their scatter is compared to the limits.

    The limits are meant for vehicle motion, but the scatter of white noise grows with the sampling
    rate.
    """
    return max(1, math.floor(1e9 / step_ns / BAND_HZ))


def window_length_ns(limits, step_ns):
    """Return the length of a window, ns; limits: AlignmentSettings."""
    return max(round(limits.window_s * 1e9), round(2 * FEWEST * step_ns))
