"""
Find a standstill in IMU samples: windows with little scatter and with agreeing means.

Samples that arrive one by one and a complete recording use the same ``StandstillSearch``.
"""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.numerics.elementary import sincos
from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.numerics.instants import seconds
from .windows import FEWEST, window_length_ns, WindowMoments

# Smallest number of frequencies whose power is averaged, however short the standstill.
FEWEST_FREQUENCIES = 3


@dataclass(frozen=True)
class Standstill:
    """
    A stationary interval: samples first to last (excluded) of a record.

    Attributes
    ----------
    start_ns, end_ns : stamps of the first and the last sample
    force, rate : (3,) means, m/s^2 and rad/s
    force_sd, rate_sd : standard deviations within a window, rms over the axes and mean over the
        windows, m/s^2 and rad/s; they are those of means over ``together`` samples
    rate_error : (3,) standard error of the mean rate, see ``standard_error``
    windows : number of windows
    together : see ``windows.WindowMoments``

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

    def describe(self):
        """Return a phrase with the interval and its standard deviations."""
        return (f'stationary from {seconds(self.start_ns)} for '
                f'{(self.end_ns - self.start_ns) * 1e-9:.3f} s: standard deviation '
                f'{self.force_sd:.3g} m/s^2 and {self.rate_sd:.3g} rad/s in {self.windows} '
                'windows' + (f', of means over {self.together} samples' if self.together > 1
                             else ''))


class StandstillSearch:
    """
    Finds runs of quiet windows that are long enough, one window at a time.

    Parameters
    ----------
    limits : AlignmentSettings
    length_ns : length of a window, ns

    Attributes
    ----------
    run : list of the StillWindows of the current run
    moved : why the last run has ended; '' if it was long enough
    needed : number of windows of the shortest run that is long enough
    length_s : length of a window, s

    """

    def __init__(self, limits, length_ns):
        self._limits, self.length_s = limits, length_ns * 1e-9
        self.needed = math.ceil(limits.shortest_s / self.length_s - 1e-9)
        self._used = max(self.needed, math.floor(limits.longest_s / self.length_s + 1e-9))
        self.run, self.moved = [], ''
        self._best = self._full = self._quiet_moving = 0
        self._quietest = None

    def take(self, window):
        """Process a window; return the run that ends with it or just before it, or None."""
        self._note(window)
        still, found = self._is_quiet(window) and not window.moving, None
        if self.run and not (still and self._joins(window)):
            why, found = self._why(window), self.end()
            self.moved = '' if found else why
        if still or self.run:
            self.run.append(window)
        if len(self.run) == self._used:
            found = self.end()
        return found

    def end(self):
        """End the current run; return it if it is long enough, or None."""
        run, self.run = self.run, []
        self._best = max(self._best, len(run))
        return run if len(run) >= self.needed else None

    def _is_quiet(self, window):
        limits = self._limits
        return (window.full and window.force_sd <= limits.force_sd_m_s2
                and window.rate_sd <= limits.rate_sd_rad_s
                and length(window.rate) <= limits.rate_rad_s)

    def _joins(self, window):
        """Return whether mean force and mean rate of a window agree with those of the run."""
        turned, changed = self._off_run(window)
        return turned <= self._limits.force_sd_m_s2 and changed <= self._limits.rate_sd_rad_s

    def _off_run(self, window):
        return (np.abs(window.force - np.array([w.force for w in self.run]).mean(axis=0)).max(),
                np.abs(window.rate - np.array([w.rate for w in self.run]).mean(axis=0)).max())

    def _note(self, window):
        self._full += window.full
        self._quiet_moving += window.moving and self._is_quiet(window)
        best = self._quietest
        if best is None or window.full and not (best.full and best.force_sd <= window.force_sd):
            self._quietest = window

    def _why(self, window):
        """Return why a window ends the run: it is not quiet, or differs from those before."""
        limits, (turned, changed) = self._limits, self._off_run(window)
        return (f'the vehicle has moved at {seconds(window.middle_ns)}: standard deviation '
                f'{window.force_sd:.3g} m/s^2 (limit {limits.force_sd_m_s2:g}) and '
                f'{window.rate_sd:.3g} rad/s (limit {limits.rate_sd_rad_s:g}), mean rate '
                f'{length(window.rate):.3g} rad/s (limit {limits.rate_rad_s:g}); change of the '
                f'means {turned:.3g} m/s^2 and {changed:.3g} rad/s (limits those of the standard '
                'deviations)'
                + (f'; the reference moves faster than {limits.speed_m_s:g} m/s'
                   if window.moving else ''))

    def describe(self):
        """Return why no standstill was found; requires at least one window."""
        limits, quietest = self._limits, self._quietest
        what = (f'no stationary interval of {limits.shortest_s:g} s in '
                f'{self._full * self.length_s:g} s: the longest has '
                f'{self._best * self.length_s:g} s, the quietest window, at '
                f'{seconds(quietest.middle_ns)}, a standard deviation of '
                f'{quietest.force_sd:.3g} m/s^2 (limit {limits.force_sd_m_s2:g}) and '
                f'{quietest.rate_sd:.3g} rad/s (limit {limits.rate_sd_rad_s:g})')
        if self._quiet_moving:
            what += (f', and in {self._quiet_moving} quiet windows the reference moves faster '
                     f'than {limits.speed_m_s:g} m/s')
        return what


def find_standstill(imu, limits, speed_at=None, longest=False):
    """
    Return the first (or the longest) Standstill of a RecordedImu.

    Parameters
    ----------
    imu : RecordedImu
    limits : AlignmentSettings
    speed_at : function of stamps (n,) that returns the speed of a reference, m/s, NaN if unknown
    longest : whether to return the longest instead of the first

    Raises
    ------
    ValueError : if no run of quiet windows is long enough; the message gives the longest run and
        the quietest window

    """
    if len(imu) < 2 * FEWEST:
        raise ValueError(f'{len(imu)} samples are too few to find a standstill')
    step_ns = imu.step_ns
    length_ns = window_length_ns(limits, step_ns)
    windows, search, found = WindowMoments(imu, step_ns, length_ns), StandstillSearch(
        limits, length_ns), None
    moving = np.zeros(len(windows.first), dtype=bool)
    if speed_at is not None:
        moving = np.nan_to_num(speed_at(windows.middle_ns)) > limits.speed_m_s
    for run in (*map(search.take, windows.each(moving)), search.end()):
        if run is not None and not longest:
            return standstill_of(imu, run, windows.together)
        if run is not None and (found is None or len(run) >= len(found)):
            found = run
    if found is not None:
        return standstill_of(imu, found, windows.together)
    raise ValueError(search.describe())


def standstill_of(imu, run, together):
    """Return the Standstill of a run of StillWindows of a record."""
    first, last = run[0].first, run[-1].last
    return Standstill(
        first, last, int(imu.t_ns[first]), int(imu.t_ns[last - 1]),
        imu.f[first:last].mean(axis=0), imu.omega[first:last].mean(axis=0),
        _mean([w.force_sd for w in run]), _mean([w.rate_sd for w in run]),
        standard_error(imu.omega[first:last], len(run)), len(run), together)


def standard_error(rate, windows):
    """
    Return the standard error (3,) of the mean of rates (n, 3) over a number of windows.

    It is the square root of the power at the lowest nonzero frequencies, up to a quarter of a
    cycle per window (Heidelberger and Welch, "A Spectral Method for Confidence Interval
    Generation", CACM 24, 1981). For white noise it is the standard deviation over root n; slow
    noise is included; and for a rocking base, whose angle is bounded so that its rate averages
    out, it is as small as the actual error.
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
    """Return the mean of values (n,), summed in their order."""
    return float(np.cumsum(values)[-1]) / len(values)
