"""
Reduced simulation of the loop of vehicle, autopilot and aided navigator, for many flights.

It consists of the plant of ``linear_plant`` with a limited command and the errors of the
estimates. Without the Earth and IMU readings it simulates a hundred flights in a fraction of the
time of one full simulation; for small angles it agrees with ``linear_loop``.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from .linear_plant import after_period


class ReducedCases(NamedTuple):
    """
    Parameters in which the flights differ, (n,) each.

    Attributes
    ----------
    gain : see ``linear_loop.Aiding``
    k_z : lateral scale error
    offset : initial z, m
    """

    gain: np.ndarray
    k_z: np.ndarray
    offset: np.ndarray


class ReducedFlights(NamedTuple):
    """Histories at t_s (m,), s: z (m), beta (rad), errors of z (m) and v_z (m/s), (m, n)."""

    t_s: np.ndarray
    z: np.ndarray
    beta: np.ndarray
    error_z: np.ndarray
    error_v: np.ndarray


def fly_reduced(loop, aiding, cases, duration_s, most_rad, engaged_s=0.0, forward=True):
    """
    Simulate the flights of cases; return ReducedFlights, one row every ten control periods.

    Parameters
    ----------
    loop : LateralLoop
    aiding : linear_loop.Aiding
        Its gain is not used; the cases have their own.
    cases : ReducedCases
    duration_s : float
    most_rad : float
        Limit of the magnitude of the command.
    engaged_s : float
        The autopilot steers from this time on; before, the command is zero.
    forward : bool
        Whether the forward velocity is aided too, as in the filters. Its error, of second order
        in beta, couples into the lateral one if the nose is off the leg.

    Returns
    -------
    ReducedFlights
    """
    flight = (_TwoChannels if forward else _Lateral)(loop, aiding, cases, most_rad)
    kept = [flight.shown()]
    count, engaged = round(duration_s / loop.period_s), round(engaged_s / loop.period_s)
    for k in range(1, count + 1):
        flight.advance(k > engaged)
        if k % aiding.step == 0:
            flight.end_step(k)
        if k % 10 == 0:
            kept.append(flight.shown())
    t_s = 10 * loop.period_s * np.arange(len(kept))
    return ReducedFlights(t_s, *(np.array(columns) for columns in zip(*kept)))


class _Lateral:
    """
    The lateral channel alone, at the speed V.

    The meter measures (1 + k_z) V sin(beta); the navigator has V sin(beta) + e_v cos(beta).
    """

    def __init__(self, loop, aiding, cases, most_rad):
        self._loop, self._aiding, self._cases, self._most = loop, aiding, cases, most_rad
        self._step = after_period(loop)
        zero = np.zeros(len(cases.k_z))
        self._state = np.array((cases.offset + zero, zero, zero))
        self._errors = self._velocity = self._acceleration = zero
        self._command, self._late = zero, deque([zero] * loop.latency)
        # Current values, their sums since the start, and these sums at the ends of the last steps.
        self._now = self._of_means()
        self._sums = np.zeros_like(self._now)
        self._ends, self._last = deque([self._sums], aiding.cycles // aiding.step + 1), None

    def shown(self):
        """Return z, beta and the errors of z and its rate."""
        return self._state[0], self._state[2], self._errors, self._velocity

    def advance(self, engaged):
        """Advance by one control period."""
        loop, h, a = self._loop, self._loop.period_s, self._acceleration
        z, v, beta = self._state
        command = loop.k1 * (z + self._errors) + loop.k2 * (v + self._velocity)
        command = np.minimum(np.maximum(command, -self._most), self._most) if engaged else 0.0 * z
        self._late.append(command)
        new = self._late.popleft()
        self._state = self._step @ np.array((z, v, beta, self._command, new))
        self._command = new
        self._errors = self._errors + h * self._velocity + 0.5 * h * h * a
        self._velocity = self._velocity + h * a
        now = self._of_means()
        self._sums = self._sums + 0.5 * (self._now + now)
        self._now = now

    def end_step(self, k):
        """Correct the estimates if a whole window ends after k periods."""
        self._ends.append(self._sums)
        if k >= self._aiding.cycles:
            self._correct(*(self._sums - self._ends[0]) / self._aiding.cycles)
            self._now = self._of_means()

    def _of_means(self):
        """Return V sin(beta) and the error of the computed value: the quantities to average."""
        beta = self._state[2]
        return np.array((self._loop.speed * np.sin(beta), self._velocity * np.cos(beta)))

    def _correct(self, mean, mean_error):
        read = (1.0 + self._cases.k_z) * mean
        if self._aiding.kind == 'conventional':
            computed = self._now.sum(axis=0)
            self._velocity = self._velocity - self._cases.gain * (computed - read)
            return
        residual, last = mean + mean_error - read, self._last
        if last is None:
            self._last = residual
            return
        span = self._aiding.cycles * self._loop.period_s
        change = self._cases.gain * (residual - last) / span
        self._acceleration = self._acceleration - change
        self._velocity = self._velocity - span * change
        self._errors = self._errors - 0.5 * span * span * change
        self._last = residual - 0.5 * span * change


class _TwoChannels(_Lateral):
    """
    Both channels; a heading off the leg couples them.

    Complex numbers: the real part is along the leg, or along the nose, the imaginary part to the
    right. V along the leg is constant; the nose is off the leg by atan(v_z/V) - beta.
    """

    def __init__(self, loop, aiding, cases, most_rad):
        zero = np.zeros(len(cases.k_z), dtype=complex)
        # Errors of the velocity along the leg; corrections of the acceleration along the nose.
        self._both = self._corrections = zero
        self._a1 = self._b2 = zero
        super().__init__(loop, aiding, cases, most_rad)

    def advance(self, engaged):
        """Advance by one control period."""
        before, h = self._nose(), self._loop.period_s
        super().advance(engaged)
        if self._aiding.kind == 'conventional':
            return
        middle = np.exp(0.5j * (before + self._nose()))
        change = -h * middle * self._corrections
        self._errors = self._errors + 0.5 * h * change.imag
        self._set(self._both + change)
        a1 = self._a1 + h * middle
        self._b2 = self._b2 + 0.5 * h * np.conj(middle) * (a1 + self._a1)
        self._a1 = a1
        now = self._of_means()
        self._sums = self._sums + 0.5 * (now - self._now)
        self._now = now

    def _set(self, both):
        self._both, self._velocity = both, both.imag

    def _nose(self):
        _, v, beta = self._state
        return np.arctan2(v, self._loop.speed) - beta

    def _of_means(self):
        """Return the velocity over ground and the error of the computed one, along the nose."""
        turn = np.exp(-1j * self._nose())
        return np.array(((self._loop.speed + 1j * self._state[1]) * turn, self._both * turn))

    def _correct(self, mean, mean_error):
        read = mean + 1j * self._cases.k_z * mean.imag
        if self._aiding.kind == 'conventional':
            residual = self._now.sum(axis=0) - read
            self._set(self._both - self._cases.gain * residual * np.exp(1j * self._nose()))
            return
        residual, last = mean + mean_error - read, self._last
        span = self._aiding.cycles * self._loop.period_s
        change = 0.0 if last is None else self._cases.gain * (residual - last) / span
        self._corrections = self._corrections + change
        self._set(self._both - self._a1 * change)
        self._errors = self._errors - 0.5 * span * (self._a1 * change).imag
        self._last = residual - self._b2 / span * change
        self._a1 = self._b2 = 0.0 * self._a1
