"""
Coarse self-alignment at a standstill: level from gravity, heading from the rate of the Earth.

TRIAD of two vectors that are known in n (Black, AIAA Journal 2, 1964; Groves, 2nd ed., section
5.6): up, the specific force at rest, and the rate of the Earth, whose cross product with up
points East.  A force bias b tilts by b / g; a rate bias along East turns by it over
Omega cos(lat); a tilt about North turns by tan(lat) times it.
"""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.attitude import matrix, quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.elementary import sincos
from ins_sim.core.numerics.fixed_order import dot, length
from ins_sim.core.numerics.instants import seconds
from ins_sim.core.numerics.units import DEG_PER_HOUR

# A window of fewer samples has no variance to speak of.
FEWEST = 5
# The standard deviation of a standstill is that of means over at least 1 / BAND_HZ, s.
BAND_HZ = 400.0
# Of a shorter standstill the power at so many frequencies is taken all the same.
FEWEST_FREQUENCIES = 3


@dataclass(frozen=True)
class Standstill:
    """
    A stationary interval: samples first to last (not included) of a record.

    start_ns, end_ns: stamps of the first and the last sample; force, rate (3,): means, m/s^2 and
    rad/s; force_sd, rate_sd: mean standard deviation of an axis within a window, of means over
    ``together`` samples; rate_error (3,): standard error of the mean rate, ``standard_error``;
    windows: how many.
    """

    first: int
    last: int
    start_ns: int
    end_ns: int
    force: np.ndarray
    rate: np.ndarray
    force_sd: float
    rate_sd: float
    rate_error: np.ndarray
    windows: int
    together: int = 1


class _Windows:
    """Counts, means and standard deviations of the windows of a record."""

    def __init__(self, imu, window_s):
        length_ns = max(round(window_s * 1e9), round(2 * FEWEST * imu.step_ns))
        index = (imu.t_ns - imu.t_ns[0]) // length_ns
        self.first = np.flatnonzero(np.diff(index, prepend=-1))
        self.last = np.append(self.first[1:], len(imu))
        self.count = self.last - self.first
        self.full = self.count >= max(FEWEST, 0.5 * length_ns / imu.step_ns)
        # The limits hold for the motion of a vehicle; white noise grows with the rate.
        self.together = max(1, math.floor(1e9 / imu.step_ns / BAND_HZ))
        self.force, self.force_sd = self._moments(imu.f)
        self.rate, self.rate_sd = self._moments(imu.omega)
        self.middle_ns = (imu.t_ns[self.first] + imu.t_ns[self.last - 1]) // 2
        self.length_s = length_ns * 1e-9

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
        Return the means of ``together`` samples each, where the windows begin, and their counts.

        Those that are left at the end of a window make a mean of their own.
        """
        within = np.arange(len(off)) - np.repeat(self.first, self.count)
        start = np.flatnonzero(within % self.together == 0)
        size = np.diff(np.append(start, len(off)))[:, None]
        counts = -(-self.count // self.together)
        first = np.append(0, np.cumsum(counts)[:-1])
        return np.add.reduceat(off, start) / size, first, counts[:, None]


def find_standstill(imu, limits, speed_at=None, longest=False):
    """
    Return the first (or the longest) Standstill of a RecordedImu.

    limits: navigate_settings.Alignment; speed_at: function of stamps (n,) that returns the speed
    of a reference, m/s, NaN where unknown.  Raises ValueError, saying what was found, where no
    run of quiet windows is long enough.
    """
    if len(imu) < 2 * FEWEST:
        raise ValueError(f'{len(imu)} samples are too few to find a standstill in')
    windows = _Windows(imu, limits.window_s)
    quiet = (windows.full & (windows.force_sd <= limits.force_sd_m_s2)
             & (windows.rate_sd <= limits.rate_sd_rad_s)
             & (length(windows.rate) <= limits.rate_rad_s))
    moving = np.zeros_like(quiet)
    if speed_at is not None:
        moving = np.nan_to_num(speed_at(windows.middle_ns)) > limits.speed_m_s
    needed = math.ceil(limits.shortest_s / windows.length_s - 1e-9)
    used = max(needed, math.floor(limits.longest_s / windows.length_s + 1e-9))
    best, start, found = 0, None, None
    # one round more than windows, which ends a run at the end of the record
    for k in range(len(quiet) + 1):
        if start is not None and (k == len(quiet) or k - start == used
                                  or not _joins(windows, quiet & ~moving, start, k, limits)):
            if k - start >= needed:
                if not longest:
                    return _standstill(imu, windows, start, k)
                if k - start >= best:
                    found = start, k
            best = max(best, k - start)
            start = None
        if k < len(quiet) and start is None and quiet[k] and not moving[k]:
            start = k
    if found is not None:
        return _standstill(imu, windows, *found)
    raise ValueError(_nothing(windows, quiet, moving, best, limits))


def _joins(windows, still, start, k, limits):
    """Return whether window k is as still as those from start on, and points the same way."""
    if not still[k]:
        return False
    run = slice(start, k)
    turned = np.abs(windows.force[k] - windows.force[run].mean(axis=0)).max()
    changed = np.abs(windows.rate[k] - windows.rate[run].mean(axis=0)).max()
    return turned <= limits.force_sd_m_s2 and changed <= limits.rate_sd_rad_s


def _standstill(imu, windows, start, stop):
    first, last = int(windows.first[start]), int(windows.last[stop - 1])
    run = slice(start, stop)
    count = stop - start
    return Standstill(
        first, last, int(imu.t_ns[first]), int(imu.t_ns[last - 1]),
        imu.f[first:last].mean(axis=0), imu.omega[first:last].mean(axis=0),
        _mean(windows.force_sd[run]), _mean(windows.rate_sd[run]),
        standard_error(imu.omega[first:last], count), count, windows.together)


def standard_error(rate, windows):
    """
    Return the standard error (3,) of the mean of rates (n, 3) over some windows.

    Square root of the power at the lowest frequencies that are not zero, up to a quarter of a
    cycle a window (Heidelberger and Welch, "A Spectral Method for Confidence Interval
    Generation", CACM 24, 1981). Of white noise it is the scatter over root n; slow noise counts;
    and on a base that rocks, where the angle is bounded and the rate averages out, it is small as
    the error is.
    """
    count = max(FEWEST_FREQUENCIES, windows // 4)
    turn = 2.0 * math.pi / len(rate) * np.arange(len(rate))
    off, power = rate - rate.mean(axis=0), np.zeros(3)
    for k in range(1, count + 1):
        for wave in sincos(k * turn):
            total = np.cumsum(wave[:, None] * off, axis=0)[-1] / len(rate)
            power = power + total * total
    return np.sqrt(power / count)


def _mean(values):
    """Return the mean of values (n,), added in their order."""
    return float(np.cumsum(values)[-1]) / len(values)


def _nothing(windows, quiet, moving, best, limits):
    k = int(np.argmin(np.where(windows.full, windows.force_sd, np.inf)))
    full_s = np.count_nonzero(windows.full) * windows.length_s
    what = (f'no stationary interval of {limits.shortest_s:g} s in {full_s:g} s: the longest has '
            f'{best * windows.length_s:g} s, the quietest window, at '
            f'{seconds(windows.middle_ns[k])}, a standard deviation of '
            f'{windows.force_sd[k]:.3g} m/s^2 (limit {limits.force_sd_m_s2:g}) and '
            f'{windows.rate_sd[k]:.3g} rad/s (limit {limits.rate_sd_rad_s:g})')
    if (quiet & moving).any():
        what += (f', and in {np.count_nonzero(quiet & moving)} quiet windows the reference '
                 f'moves faster than {limits.speed_m_s:g} m/s')
    return what


@dataclass(frozen=True)
class Gyrocompass:
    """
    A gyrocompassing.

    q_nb, None where the mean rate is parallel to up; sigma: standard error of the heading from
    the noise of the rate and from the bias of the gyros, rad; noise_sigma: that from the noise
    alone; excess: length of the mean rate less that of the Earth, rad/s;
    excess_up: the same of its part along up; both are the bias of the gyros, as far as it can
    be seen; bias_sigma: standard deviation of it that was assumed, rad/s.
    """

    q_nb: tuple
    sigma: float
    noise_sigma: float
    excess: float
    excess_up: float
    bias_sigma: float

    def describe(self):
        """Return what was found, and of what its standard error is made."""
        return (f'standard error {math.degrees(self.sigma):.3g} deg, by noise '
                f'{math.degrees(self.noise_sigma):.3g} deg and by the bias of '
                f'{self.bias_sigma * DEG_PER_HOUR:.3g} deg/h of alignment.gyro_bias_sigma_deg_h; '
                f'mean rate {self.excess * DEG_PER_HOUR:+.3g} deg/h from that of the Earth')


def gyrocompass(still, lat, bias_sigma=0.0):
    """
    Return the Gyrocompass of a Standstill at a latitude, rad.

    bias_sigma: standard deviation of the bias of the gyros, rad/s.  Its part along East turns the
    heading and cannot be seen at a standstill.
    """
    up = still.force / length(still.force)
    east = np.cross(still.rate, up)
    level = length(east)
    spin_level, spin_up = _spin(lat)
    q_nb, sigma, noise = None, math.inf, math.inf
    if level > 0.0:
        east /= level
        q_nb = _attitude(east, up)
        noise = length(still.rate_error * east) / spin_level
        by_bias = bias_sigma / spin_level
        sigma = math.sqrt(noise * noise + by_bias * by_bias)
    return Gyrocompass(q_nb, sigma, noise, length(still.rate) - ellipsoid.ROTATION_RATE,
                       dot(still.rate, up) - spin_up, bias_sigma)


def _spin(lat, rate=ellipsoid.ROTATION_RATE):
    """Return the level (North) and upward rate of the Earth, rad/s."""
    s, c = sincos(lat)
    return rate * c, rate * s


def is_trusted(compass, still, lat, sigma):
    """
    Return whether a Gyrocompass can be believed to within sigma, rad.

    Its standard error must not exceed sigma; nor may the bias that shows in length or upward part
    of the mean rate, beyond three standard errors, be one that turns the heading by more.
    """
    allowed = sigma * _spin(lat)[0] + 3.0 * length(still.rate_error)
    return compass.sigma <= sigma and max(abs(compass.excess), abs(compass.excess_up)) <= allowed


def level_attitude(force, heading):
    """
    Return q_nb of a mean specific force (3,) at rest and a heading, clockwise, rad.

    Raises ValueError where the forward axis is vertical, so that it has no heading.
    """
    up = force / length(force)
    forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
    size = length(forward)
    if size < 0.02:
        raise ValueError('the forward axis is within 1 deg of the vertical, so that it has no '
                         'heading; expected another mounting (mounting.source, '
                         'mounting.rpy_deg)')
    forward /= size
    right = np.cross(forward, up)
    s, c = sincos(heading)
    return _attitude(s * forward + c * right, up)


def _attitude(east, up):
    """Return q_nb of the unit vectors East and up in b."""
    return matrix.quaternion_of((*east.tolist(), *np.cross(up, east).tolist(),
                                 *up.tolist()))


def gyro_bias(still, q_nb, lat, spin):
    """Return the mean rate less that of the Earth, (3,) rad/s, of a Standstill; spin: rad/s."""
    earth_b = quaternion.rotate_back(q_nb, (0.0, *_spin(lat, spin)))
    return still.rate - np.array(earth_b)
