"""
The loop of vehicle, autopilot and aided navigator, reduced to what matters in it, many at once.

The plant of ``linear_plant`` with a command that is limited, and the errors of the estimates: the
meter reads (1 + k_z) V sin(beta), the navigator has V sin(beta) + e_v cos(beta), and e_z' = e_v.
Neither the Earth nor the readings of an IMU are in it, which is why it flies a thousand flights in
the time of one; ``linear_loop`` is what it is for small angles.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from .linear_plant import after_period


class ReducedCases(NamedTuple):
    """
    Flights that differ in these, (n,) each.

    gain: as of ``linear_loop.Aiding``; k_z: lateral scale error; offset: z at the start, m.
    """

    gain: np.ndarray
    k_z: np.ndarray
    offset: np.ndarray


class ReducedFlights(NamedTuple):
    """Histories at t_s (m,), s: z, m, beta, rad, and errors of z, m, and v_z, m/s, (m, n)."""

    t_s: np.ndarray
    z: np.ndarray
    beta: np.ndarray
    error_z: np.ndarray
    error_v: np.ndarray


def fly_reduced(loop, aiding, cases, duration_s, most_rad, engaged_s=0.0, every=10):
    """
    Return the ReducedFlights of cases.

    Parameters
    ----------
    loop : LateralLoop
    aiding : linear_loop.Aiding
        Its gain is not used, those of the cases are.
    cases : ReducedCases
    duration_s : float
    most_rad : float
        The command is limited to plus and minus this.
    engaged_s : float
        The autopilot steers from then on; before, the command is zero.
    every : int
        Periods between the instants of the histories.

    """
    flight = _Flight(loop, aiding, cases, most_rad)
    kept = [flight.seen()]
    count, engaged = round(duration_s / loop.period_s), round(engaged_s / loop.period_s)
    for k in range(1, count + 1):
        flight.advance(k > engaged)
        if k % aiding.step == 0:
            flight.end_step(k)
        if k % every == 0:
            kept.append(flight.seen())
    t_s = every * loop.period_s * np.arange(len(kept))
    return ReducedFlights(t_s, *(np.array(columns) for columns in zip(*kept)))


class _Flight:
    def __init__(self, loop, aiding, cases, most_rad):
        self._loop, self._aiding, self._cases, self._most = loop, aiding, cases, most_rad
        self._step = after_period(loop)
        zero = np.zeros(len(cases.k_z))
        self._state = np.array((cases.offset + zero, zero, zero))
        self._errors = self._velocity = self._acceleration = zero
        self._command, self._late = zero, deque([zero] * loop.latency)
        # what is now, its sum since the start, and that at the ends of the last steps
        self._seen = self._seen_by_meter()
        self._sums = np.zeros((2, len(zero)))
        self._ends, self._last = deque([self._sums], aiding.cycles // aiding.step + 1), None

    def seen(self):
        """Return z, beta and the errors of z and its rate."""
        return self._state[0], self._state[2], self._errors, self._velocity

    def advance(self, engaged):
        """Fly one period."""
        loop, h, a = self._loop, self._loop.period_s, self._acceleration
        z, v, beta = self._state
        command = loop.k1 * (z + self._errors) + loop.k2 * (v + self._velocity)
        command = np.minimum(np.maximum(command, -self._most), self._most) if engaged else 0.0 * z
        self._late.append(command)
        new = self._late.popleft()
        before = self._velocity
        self._state = self._step @ np.array((z, v, beta, self._command, new))
        self._command = new
        self._errors = self._errors + h * before + 0.5 * h * h * a
        self._velocity = before + h * a
        now = self._seen_by_meter()
        self._sums = self._sums + 0.5 * (self._seen + now)
        self._seen = now

    def _seen_by_meter(self):
        """Return the lateral velocity V sin(beta), and the error e_v cos(beta) of the computed."""
        beta = self._state[2]
        return np.array((self._loop.speed * np.sin(beta), self._velocity * np.cos(beta)))

    def end_step(self, k):
        """Correct the estimates, if a whole window ends after k periods."""
        aiding = self._aiding
        self._ends.append(self._sums)
        if k < aiding.cycles:
            return
        mean, mean_error = (self._sums - self._ends[0]) / aiding.cycles
        read = (1.0 + self._cases.k_z) * mean
        if aiding.kind == 'conventional':
            computed = self._seen.sum(axis=0)
            self._velocity = self._velocity - self._cases.gain * (computed - read)
            self._seen = self._seen_by_meter()
            return
        residual, last = mean + mean_error - read, self._last
        if last is None:
            self._last = residual
            return
        span = aiding.cycles * self._loop.period_s
        change = self._cases.gain * (residual - last) / span
        self._acceleration = self._acceleration - change
        self._velocity = self._velocity - span * change
        self._errors = self._errors - 0.5 * span * span * change
        self._last = residual - 0.5 * span * change
        self._seen = self._seen_by_meter()
