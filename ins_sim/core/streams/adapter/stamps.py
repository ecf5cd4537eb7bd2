"""The stamps of the input: rate, jitter, gaps, and the instants to which they belong."""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.numerics.fixed_order import dot, total
from ins_sim.core.numerics.instants import seconds
from ..faults import check_later, MOST_PERIODS, StreamFault

# A gap is a step longer than GAP periods plus JITTERS times the jitter.
GAP, JITTERS = 1.5, 5.0
# Bandwidth with which the nominal instants follow the stamps, rad/s.
FOLLOW = 0.1
# A period within this many sigmas of a round value is treated as round.
ROUND_SIGMAS = 4.0


@dataclass(frozen=True)
class Steadiness:
    """Period of the stamps (ns, a float) and jitter: rms deviation from a straight line, ns."""

    period_ns: float
    jitter_ns: float

    @property
    def longest_ns(self):
        """The longest step that does not count as a gap, ns."""
        return GAP * self.period_ns + JITTERS * self.jitter_ns


def steadiness(t_ns):
    """
    Return the Steadiness of stamps and the straight line through them.

    Parameters
    ----------
    t_ns : list of int, ns

    Returns
    -------
    Steadiness
    line : (n,) instants, ns since the first stamp, a multiple of the period apart
    """
    stamps = np.array(t_ns) - t_ns[0]
    steps = np.diff(stamps)
    number = np.concatenate([[0], np.cumsum(np.maximum(1, np.rint(steps / np.median(steps))))])
    centred = number - total(number) / len(number)
    period = dot(centred, stamps) / dot(centred, centred)
    line = total(stamps) / len(stamps) + centred * period
    off = stamps - line
    return Steadiness(period, math.sqrt(dot(off, off) / len(off))), line


def round_period_ns(steady, count):
    """Return the nearest period that is a whole rate in Hz or whole ms, if the stamps allow it."""
    period_ns = steady.period_ns
    # Add 0.01 ns, because stamps are whole nanoseconds.
    sigma_ns = steady.jitter_ns * math.sqrt(12.0 / count) / count + 0.01
    for nearest_ns in (1e9 / max(1, round(1e9 / period_ns)), 1e6 * round(1e-6 * period_ns)):
        if abs(nearest_ns - period_ns) <= ROUND_SIGMAS * sigma_ns:
            return nearest_ns
    return period_ns


class NominalClock:
    """
    Equally spaced instants that follow the stamps.

    A second-order loop lets the deviation of the stamps adjust the step, never the instants
    directly, so that jitter does not shake the motion.

    Parameters
    ----------
    base_ns : the last instant, ns
    period_ns : the step, a float, ns
    """

    def __init__(self, base_ns, period_ns):
        self._base_ns, self._period = base_ns, period_ns
        self._last = self._slip = 0.0

    def instant(self, t_ns):
        """Return the instant of the next stamp, ns."""
        off = float(t_ns - self._base_ns) - self._last
        count = max(1.0, float(round(off / self._period)))
        step = count * self._period
        turn = FOLLOW * step * 1e-9
        self._slip = self._slip + turn * (FOLLOW * (off - step) - 2.0 * self._slip)
        self._last = self._last + step + self._slip * step * 1e-9
        return self._base_ns + round(self._last)


class StampCheck:
    """
    Raises StreamFault for stamps that do not follow each other.

    Parameters
    ----------
    name : name of the input, for messages
    dt_ns : period of the IMU, ns; a step may be at most MOST_PERIODS of it
    """

    def __init__(self, name, dt_ns):
        self._name, self._dt_ns = name, dt_ns
        self._last_ns = None

    def check(self, t_ns, steady):
        """Check a stamp; steady is the Steadiness of the input, or None if not yet known."""
        last_ns = self._last_ns
        if last_ns is None:
            self._last_ns = t_ns
            return
        check_later(self._name, t_ns, last_ns)
        longest_ns = MOST_PERIODS * self._dt_ns if steady is None else steady.longest_ns
        if t_ns - last_ns > longest_ns:
            raise gap_fault(self._name, last_ns, t_ns, longest_ns, restart=True)
        self._last_ns = t_ns


def gap_fault(name, last_ns, t_ns, longest_ns, restart):
    """Return the StreamFault for a gap between two stamps."""
    return StreamFault(f'{name} has a gap from {seconds(last_ns)} to {seconds(t_ns)}; expected '
                       f'steps of at most {longest_ns * 1e-9:.4g} s', restart=restart)
