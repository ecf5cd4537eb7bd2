"""
Stability limits of the loop of vehicle, autopilot and aided navigator, exact in discrete time.

Between two corrections of the navigator everything is linear. The state x holds the estimates of z
and of its rate, beta, the command, the commands delayed by the latency, and the state of the
navigator. w is the lateral velocity read by the meter, and k_z its scale factor error:

    x+ = A x + b w,   w = (1 + k_z) D p,   p = c x

p is the mean lateral velocity V beta since the last correction. D averages p over a window: it is
1 if a window is one step, and (1 - Q^-n)/(n (1 - Q^-1)) if it is n steps, where Q is the operator
of one step forward. Errors that are unobservable (the absolute position, and for paper_corrected
the absolute velocity) are not in x. The characteristic equation is
(1 + k_z) D(Q) c (Q - A)^-1 b = 1; its solutions with Q on the unit circle and a real k_z are the
limits of k_z.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.linalg import schur

from .linear_plant import after_period

# Number of frequencies in the coarse search for real values of the response; each real value gives
# a limit of k_z.
POINTS = 2000
# Responses smaller than this are rounding errors and are ignored.
ROUNDING = 1e-9
KINDS = ('conventional', 'paper_corrected')


class Aiding(NamedTuple):
    """
    A navigator aided by a meter with windows of N cycles; a cycle is a control period.

    Attributes
    ----------
    kind : one of KINDS
    cycles : N
    step : cycles between the ends of windows, a divisor of N, and N for paper_corrected
    gain : for conventional the fraction of the error that a fix removes (if windows slide, K_v in
        1/s times the time between fixes), for paper_corrected K (docs/theory/aided_navigation.md)
    """

    kind: str
    cycles: int
    step: int
    gain: float


class Mode(NamedTuple):
    """Growth rate, 1/s, and frequency, rad/s, of the mode that grows fastest."""

    growth: float
    frequency: float


class StabilityLimit(NamedTuple):
    """A lateral scale error k_z at which a mode is undamped; its frequency, rad/s."""

    k_z: float
    frequency: float


class StabilityLimits(NamedTuple):
    """
    The positive and the negative StabilityLimit nearest to zero; None for a sign without a limit.

    unstable: number of modes that grow at k_z = 0. Only if it is zero do the limits bound the
    stable range.
    """

    positive: StabilityLimit | None
    negative: StabilityLimit | None
    unstable: int


class _Step(NamedTuple):
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray


def growth(loop, aiding, k_z):
    """
    Return the fastest growing mode at a lateral scale factor error k_z.

    The cost is of the order (N/step)^3: a second for some hundred steps in a window.
    """
    a, b, c = _step(loop, aiding)
    n, size = aiding.cycles // aiding.step, len(a)
    # Append to x the means of the n - 1 previous steps.
    whole = np.zeros((size + n - 1,) * 2)
    whole[:size, :size] = a + (1.0 + k_z) / n * np.outer(b, c)
    whole[:size, size:] = (1.0 + k_z) / n * b[:, None]
    if n > 1:
        whole[size, :size] = c
        whole[size + 1:, size:-1] = np.eye(n - 2)
    roots = np.linalg.eigvals(whole)
    root, step_s = roots[np.argmax(np.abs(roots))], aiding.step * loop.period_s
    return Mode(float(np.log(abs(root)) / step_s), float(abs(np.angle(root)) / step_s))


def limits(loop, aiding):
    """
    Return the StabilityLimits of k_z.

    The loop is sampled at the corrections, so the frequencies of the limits are aliased: they are
    at most pi divided by the time between corrections.

    Parameters
    ----------
    loop : LateralLoop
    aiding : Aiding
    """
    response = _Response(_step(loop, aiding), aiding.cycles // aiding.step)
    step_s, n = aiding.step * loop.period_s, aiding.cycles // aiding.step
    highest = math.pi / step_s
    omega = np.union1d(np.geomspace(1e-4 * highest, highest, POINTS),
                       np.linspace(0.0, highest, POINTS + 8 * n + 1)[1:])
    values = response.at(omega * step_s)
    crossings = np.flatnonzero(values.imag[:-1] * values.imag[1:] < 0.0)
    low, high = omega[crossings], omega[crossings + 1]
    sign = values.imag[crossings]
    for _ in range(50):
        middle = 0.5 * (low + high)
        same = response.at(middle * step_s).imag * sign > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    # At the highest frequency all values are real.
    places = np.append(low, highest)
    real = response.at(places * step_s).real
    found = [StabilityLimit(1.0 / x - 1.0, w) for x, w in zip(real.tolist(), places.tolist())
             if abs(x) > ROUNDING]
    positive = min((one for one in found if one.k_z > 0.0), default=None)
    negative = max((one for one in found if one.k_z < 0.0), default=None)
    return StabilityLimits(positive, negative, _unstable(response.roots, values))


def _unstable(roots, values):
    """
    Return the number of modes that grow at k_z = 0, by the principle of the argument.

    values: the response along the upper half of the unit circle, from near 1 to -1, where it is
    real; roots: eigenvalues of A.
    """
    around = np.unwrap(np.angle(1.0 - values))
    turns = 2.0 * (around[-1] - around[0]) / (2.0 * math.pi)
    outside = np.count_nonzero(np.abs(roots) > 1.0)
    return int(outside) - round(turns)


class _Response:
    """
    The response D(Q) c (Q - A)^-1 b on the unit circle; n: steps of a window.

    It uses the Schur form of A, so that the cost at each Q grows with the square, not the cube, of
    the number of states, which is large for a long latency.
    """

    def __init__(self, step, n):
        self._upper, basis = schur(step.a, output='complex')
        self._b, self._c, self._n = basis.conj().T @ step.b, step.c @ basis, n
        self.roots = np.diag(self._upper)

    def at(self, angles):
        """Return the response at Q = exp(i angles)."""
        q, upper = np.exp(1j * angles), self._upper
        x = np.zeros((len(upper), len(q)), dtype=complex)
        for k in reversed(range(len(upper))):
            x[k] = (self._b[k] + upper[k, k + 1:] @ x[k + 1:]) / (q - upper[k, k])
        return (self._c @ x) * window_mean(q, self._n)


def window_mean(q, n):
    """Return D(Q): the mean over n steps of a quantity that grows by the factor q in each."""
    return 1.0 if n == 1 else (1.0 - q ** -n) / (n * (1.0 - 1.0 / q))


def _step(loop, aiding):
    """Return the _Step from one correction to the next."""
    names = ('z', 'v', 'beta', 'command', *(f'latency_{k}' for k in range(loop.latency)),
             'sum_beta', 'acceleration', 'error', 'sum_error')
    e = dict(zip(names, np.eye(len(names))))
    rows = {name: e[name].copy() for name in names}
    h = loop.period_s
    command = loop.k1 * e['z'] + loop.k2 * e['v']
    for k in range(loop.latency):
        rows[f'latency_{k}'], command = command, e[f'latency_{k}']
    rows['command'] = command
    before = np.array((e['z'], e['v'], e['beta'], e['command'], command))
    rows['z'], rows['v'], rows['beta'] = after_period(loop) @ before
    rows['sum_beta'] += 0.5 * (e['beta'] + rows['beta'])
    # A constant error of the acceleration is integrated over the step.
    rows['z'] += 0.5 * h * h * e['acceleration']
    rows['v'] += h * e['acceleration']
    rows['error'] += h * e['acceleration']
    rows['sum_error'] += e['error'] + 0.5 * h * e['acceleration']
    x = np.linalg.matrix_power(np.array([rows[name] for name in names]), aiding.step)
    now = dict(zip(names, x))
    mean = loop.speed / aiding.step * now['sum_beta']
    # Coefficient of the meter's reading w in each state.
    read = {name: 0.0 for name in names}
    correct = _conventional if aiding.kind == 'conventional' else _paper_corrected
    correct(loop, aiding, now, mean, read)
    for name in ('sum_beta', 'sum_error'):
        now[name] = 0.0 * mean
    return _Step(np.array([now[name] for name in names]),
                 np.array([read[name] for name in names]), mean)


def _conventional(loop, aiding, now, mean, read):
    """
    Subtract ``gain`` times the innovation (estimate minus fix) from the velocity estimate.

    The state ``error`` is e_v, the error of the velocity estimate. The fix is used as if it were
    the velocity at the end of its window.
    """
    innovation = loop.speed * now['beta'] + now['error']
    for name in ('v', 'error'):
        now[name] = now[name] - aiding.gain * innovation
        read[name] = aiding.gain
    now['acceleration'] = 0.0 * mean


def _paper_corrected(loop, aiding, now, mean, read):
    """
    Subtract dW = K nu from the acceleration, T dW from velocity, T^2/2 dW from position.

    The state ``error`` is e_v - z', where z' is the residual of the last window after its
    correction (``PaperCorrectedFilter``): nu = (mean of ``error`` + mean of V beta - w)/T.
    """
    span = aiding.cycles * loop.period_s
    nu, by_read = (now['sum_error'] / aiding.cycles + mean) / span, -1.0 / span
    for name, part in (('z', 0.5 * span * span * aiding.gain), ('v', span * aiding.gain),
                       ('acceleration', aiding.gain),
                       ('error', span + 0.5 * span * aiding.gain)):
        now[name] = now[name] - part * nu
        read[name] = -part * by_read
