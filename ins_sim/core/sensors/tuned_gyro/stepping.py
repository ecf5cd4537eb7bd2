"""
The dynamically tuned gyro, step by step.

At constant speed the gyro is linear, so that a step, exact or RK4, is one set of matrices: the
state and the mean reading of the interval are linear in the state at its start and in the rates
at its start, middle and end.  Exact steps take the rate between these as the parabola
(``quadratic``) or the straight line (``linear``) through them (docs/theory.md, "Dynamically tuned
gyro").
"""

from dataclasses import replace
import math
import warnings

import numpy as np

from .rotor import state_space
from .stability import rk4_window

METHODS = ('exact', 'rk4')
HOLDS = ('quadratic', 'linear')


def exact_matrices(space, dt_s, hold):
    """
    Return the map (n + 1, n + 3) of one exact step: next state and mean reading.

    Columns: state at the start, rates at start, middle, end.  Matrix exponential of the system
    augmented by the integral of the reading and by the rate's derivatives (Van Loan 1978).
    """
    from scipy.linalg import expm, matrix_balance
    n = len(space.g)
    big = np.zeros((n + 4, n + 4), dtype=complex)
    big[:n, :n] = space.f * dt_s
    big[:n, n + 1] = space.g * dt_s
    big[n, :n], big[n, n + 1] = space.c, space.d
    big[n + 1, n + 2] = big[n + 2, n + 3] = 1.0
    # balanced by powers of two, which is exact: theta and v differ by the nutation's frequency
    big, (scale, _) = matrix_balance(big, permute=False, separate=True)
    power = (scale[:, None] * expm(big) / scale)[:n + 1]
    by_value, by_slope, by_bend = power[:, n + 1], power[:, n + 2], power[:, n + 3]
    if hold == 'linear':
        start, middle, end = by_value - by_slope, 0.0 * by_slope, by_slope
    else:
        start = by_value - 3.0 * by_slope + 4.0 * by_bend
        middle = 4.0 * by_slope - 8.0 * by_bend
        end = 4.0 * by_bend - by_slope
    return np.column_stack((power[:, :n], start, middle, end))


def rk4_matrices(space, dt_s):
    """
    Return the map of one RK4 step and the map (4, n + 3) of the readings at its four stages.

    The classical Runge-Kutta step of a linear system is linear: this is it, column by column.
    """
    n = len(space.g)
    start, middle, end = np.eye(n + 3)[n:]
    state = np.eye(n, n + 3).astype(complex)

    def rates(at, u):
        return space.f @ at + np.outer(space.g, u)

    k1 = rates(state, start)
    k2 = rates(at2 := state + 0.5 * dt_s * k1, middle)
    k3 = rates(at3 := state + 0.5 * dt_s * k2, middle)
    k4 = rates(at4 := state + dt_s * k3, end)
    stages = np.array([space.c @ at + space.d * u for at, u in
                       ((state, start), (at2, middle), (at3, middle), (at4, end))])
    mean = (stages[0] + 2.0 * stages[1] + 2.0 * stages[2] + stages[3]) / 6.0
    return np.vstack((state + dt_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4), mean)), stages


def disturbance_matrix(table, space, dt_s, step_map):
    """
    Return what disturbances add to one step, (n + 1, 3): next state and mean reading.

    Columns: a moment and a pick-off error, constant over the step, and a jump of the latter at its
    start.  table: the map of the step; step_map: function (StateSpace) -> map, linear in g and d,
    whose three rate columns add up to the answer to a constant input.
    """
    n = len(space.g)
    moment = step_map(replace(space, g=space.moment, d=0.0j))[:, n:].sum(axis=1)
    tilt = step_map(replace(space, g=space.tilt, d=space.tilt_reading))[:, n:].sum(axis=1)
    jump = table[:, :n] @ space.jump
    jump[n] += space.jump_reading / dt_s
    return np.column_stack((moment, tilt, jump))


def step_two(x, u0, um, u1, gains):
    """Return the next state and the mean reading; two states, full matrix."""
    x0, x1 = x
    (a0, a1, a2, a3, a4), (b0, b1, b2, b3, b4), (m0, m1, m2, m3, m4) = gains
    return ((a0 * x0 + a1 * x1 + a2 * u0 + a3 * um + a4 * u1,
             b0 * x0 + b1 * x1 + b2 * u0 + b3 * um + b4 * u1),
            m0 * x0 + m1 * x1 + m2 * u0 + m3 * um + m4 * u1)


def step_three(x, u0, um, u1, gains):
    """Return the next state and the mean reading; three states, full matrix."""
    x0, x1, x2 = x
    ((a0, a1, a2, a3, a4, a5), (b0, b1, b2, b3, b4, b5), (c0, c1, c2, c3, c4, c5),
     (m0, m1, m2, m3, m4, m5)) = gains
    return ((a0 * x0 + a1 * x1 + a2 * x2 + a3 * u0 + a4 * um + a5 * u1,
             b0 * x0 + b1 * x1 + b2 * x2 + b3 * u0 + b4 * um + b5 * u1,
             c0 * x0 + c1 * x1 + c2 * x2 + c3 * u0 + c4 * um + c5 * u1),
            m0 * x0 + m1 * x1 + m2 * x2 + m3 * u0 + m4 * um + m5 * u1)


_KERNELS = {2: step_two, 3: step_three}


def _check_stability(roots, dt_s, method):
    """Return the sentence that says why the steps do not decay, or None."""
    if method == 'exact':
        if roots[0].real < 0.0:
            return None
        return (f'the gyro is unstable: a root grows with {roots[0].real:.4g} 1/s at '
                f'{abs(roots[0].imag) / (2.0 * math.pi):.4g} Hz; expected every root to decay')
    window = rk4_window(roots)
    if window is None:
        return 'the gyro is unstable and no RK4 step damps it; expected every root to decay'
    if window[0] < dt_s < window[1]:
        return None
    return (f'the RK4 step is {1e3 * dt_s:g} ms, at which this gyro grows; expected between '
            f'{1e3 * window[0]:.4g} and {1e3 * window[1]:.4g} ms')


class TunedGyro:
    """
    One gyro: rates in, mean readings out.

    parameters: TunedGyroParameters; dt_s: step; method: exact or rk4; hold: quadratic or linear
    (of the exact method); on_unstable: refuse or warn; speed_hz: where it is not the nominal one.
    state: a tuple of complex numbers that can be kept and set back; zero at first, a rotor without
    tilt that does not turn in inertial space (see settle).  Raises ValueError where the steps
    would grow.
    """

    def __init__(self, parameters, dt_s, method='exact', hold='quadratic', on_unstable='refuse',
                 speed_hz=None):
        for name, value, choices in (('method', method, METHODS), ('hold', hold, HOLDS),
                                     ('on_unstable', on_unstable, ('refuse', 'warn'))):
            if value not in choices:
                raise ValueError(f'{name} is {value!r}; expected {" or ".join(choices)}')
        if not 0.0 < dt_s < math.inf:
            raise ValueError(f'dt_s is {dt_s!r}; expected a finite number above 0')
        self.parameters, self.dt_s = parameters, dt_s
        self._options = method, hold, on_unstable
        self._build(speed_hz)
        self.state = (0.0j,) * len(self._space.g)

    def _build(self, speed_hz):
        method, hold, on_unstable = self._options
        space = state_space(self.parameters, speed_hz)
        sentence = _check_stability(space.roots, self.dt_s, method)
        if sentence and on_unstable == 'refuse':
            raise ValueError(sentence)
        if sentence:
            warnings.warn(sentence, stacklevel=3)
        n, stages = len(space.g), None
        if method == 'exact':
            table = exact_matrices(space, self.dt_s, hold)
            added = disturbance_matrix(table, space, self.dt_s,
                                       lambda s: exact_matrices(s, self.dt_s, hold))
        else:
            table, stages = rk4_matrices(space, self.dt_s)
            added = disturbance_matrix(table, space, self.dt_s,
                                       lambda s: rk4_matrices(s, self.dt_s)[0])
        self.speed_hz = self.parameters.speed_hz if speed_hz is None else speed_hz
        self._space = space
        self._kernel, self._gains = _KERNELS[n], tuple(map(tuple, table.tolist()))
        self.matrices = table, added
        self._added = tuple(map(tuple, added.tolist()))
        self._stages = None if stages is None else tuple(map(tuple, stages.tolist()))
        self._reading = (*space.c.tolist(), space.d)

    @property
    def space(self):
        """The StateSpace at the present speed."""
        return self._space

    @property
    def physical_state(self):
        """The state as (theta, v[, integral of theta]), rad, rad/s, rad s."""
        return self.state

    @physical_state.setter
    def physical_state(self, x):
        self.state = tuple(np.asarray(x, dtype=complex).tolist())

    def set_speed(self, speed_hz):
        """Go on with another speed of the rotor; the tilt is kept, the matrices are rebuilt."""
        if not 0.0 < speed_hz < math.inf:
            raise ValueError(f'speed_hz is {speed_hz!r}; expected a finite number above 0')
        x = self.physical_state
        self._build(speed_hz)
        self.physical_state = x

    def settle(self, u, moment=0.0, tilt=0.0):
        """Take the state of a gyro that has long turned at the constant rate u, rad/s."""
        space = self._space
        self.physical_state = np.linalg.solve(
            space.f, -(space.g * u + space.moment * moment + space.tilt * tilt))

    def step(self, u_start, u_mid, u_end):
        """Advance by dt; rates u_y + j u_z of the case, rad/s; return the mean reading."""
        self.state, mean = self._kernel(self.state, u_start, u_mid, u_end, self._gains)
        return mean

    def step_disturbed(self, u_start, u_mid, u_end, moment, tilt, jump):
        """
        Advance by dt as ``step`` does, under disturbances; return the mean reading.

        moment, complex rad/s: the rate it is mistaken for; tilt, rad: error of the pick-off; both
        constant over the step.  jump: by how much tilt differs from that of the step before.
        """
        state, mean = self._kernel(self.state, u_start, u_mid, u_end, self._gains)
        *rows, (a, b, c) = self._added
        self.state = tuple([x + (p * moment + q * tilt + r * jump)
                            for x, (p, q, r) in zip(state, rows)])
        return mean + (a * moment + b * tilt + c * jump)

    def reading(self, u):
        """Return the reading of this instant, the rate being u, rad/s."""
        total = self._reading[-1] * u
        for gain, x in zip(self._reading, self.state):
            total += gain * x
        return total

    def step_stages(self, u_start, u_mid, u_end):
        """Advance by dt with RK4; return the readings at its four stages."""
        x = (*self.state, u_start, u_mid, u_end)
        self.step(u_start, u_mid, u_end)
        if len(x) == 5:
            x0, x1, x2, x3, x4 = x
            return tuple([a * x0 + b * x1 + c * x2 + d * x3 + e * x4
                          for a, b, c, d, e in self._stages])
        x0, x1, x2, x3, x4, x5 = x
        return tuple([a * x0 + b * x1 + c * x2 + d * x3 + e * x4 + f * x5
                      for a, b, c, d, e, f in self._stages])

    def advance(self, u):
        """Return the mean readings (n,) of n steps; u (n, 3): rates at start, middle, end."""
        return np.array([self.step(*row) for row in np.asarray(u, dtype=complex).tolist()])
