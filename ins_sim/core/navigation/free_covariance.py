"""
Covariance of the errors of an unaided strapdown, found by propagation alone.

The model has 27 states: the nine of ``error_dynamics``, and the constant instrument errors by
body axis: biases, scale factors and misalignments of accelerometers and gyros. The mean error,
nine numbers that are the same in every run (given initial errors, non-orthogonality, asymmetry,
g-sensitivity), is propagated separately; its squares are added to the variances
(docs/design/covariance.md).
"""

import numpy as np

from ins_sim.core.attitude.interpolation import middle_attitude
from ins_sim.core.attitude.matrix import dcm_of
from ins_sim.core.numerics.fixed_order import applied, product
from .error_dynamics import change, GROWING, inertial_rows, turn_by_position

P, V, PHI, UP = slice(0, 3), slice(3, 6), slice(6, 9), (2, 5)
BA, BG, SA, SG, MA, MG = (slice(k, k + 3) for k in range(9, 27, 3))
SIZE = 27
# Longest step, s, and largest rotation of the body in a step, rad. The coefficients of a step are
# evaluated at its middle.
STEP_S, STEP_RAD = 0.5, 0.6
# Standard deviations of exactly known states, so that P stays positive definite. Position m,
# velocity m/s, attitude rad; instruments m/s^2, rad/s, scale factors 1, misalignments rad.
KNOWN = np.array((1e-3,) * 3 + (1e-5,) * 3 + (1e-8,) * 3 + (1e-9,) * 3 + (1e-12,) * 3
                 + (1e-12,) * 12)
NONE = (0.0,) * 12
DIAGONAL = slice(None, None, SIZE + 1)


def coefficients(lat, height, v, c, f_b, omega_b, spin, damping):
    """
    Return the GROWING rows of F, (9, 27).

    Parameters
    ----------
    lat, height, v, c, spin : see ``error_dynamics.inertial_rows``
    f_b, omega_b : (3,) readings by body axis, m/s^2 and rad/s
    damping : c1, c2 of a damped vertical channel, zero without: the height error acts with c1 on
        the rate of height and with c2 on that of vertical velocity

    """
    c_e, c_n, c_u = c[0:3], c[3:6], c[6:9]
    x, y, z = f_b
    f_n = [row[0] * x + row[1] * y + row[2] * z for row in (c_e, c_n, c_u)]
    rows = inertial_rows(lat, height, v, c, f_n, spin)
    f = np.array((
        *(row + NONE for row in rows[0:3]),
        *(row + (*by, 0.0, 0.0, 0.0, *turned, 0.0, 0.0, 0.0) for row, (by, turned) in zip(
            rows[3:6], (_by_reading(axes, f_b) for axes in (c_e, c_n, c_u)))),
        *(row + (0.0, 0.0, 0.0, *by, 0.0, 0.0, 0.0, *turned) for row, (by, turned) in zip(
            rows[6:9], (_by_reading(axes, omega_b) for axes in (c_e, c_n, c_u))))))
    f[2, 2] -= damping[0]
    f[5, 2] -= damping[1]
    return f


def _by_reading(row, reading):
    """Return a row of C times diag(reading), and the same row times the matrix (reading x)."""
    p, q, r = row
    x, y, z = reading
    return (p * x, q * y, r * z), (q * z - r * y, r * x - p * z, p * y - q * x)


def grown(p, n, noise):
    """
    Return the covariance after a step, (1 + N) (P + Q/2) (1 + N)' + Q/2.

    The result is exactly symmetric if P is.  n: ``change`` of the coefficients; noise (27,):
    diagonal of Q, the variance that white noise adds in a step.
    """
    half = 0.5 * noise
    p = p.copy()
    p.reshape(-1)[DIAGONAL] += half
    moved = product(n, p)
    square, both = moved[:, :GROWING], product(moved, n.T)
    p[:GROWING, :GROWING] += (square + square.T) + 0.5 * (both + both.T)
    p[:GROWING, GROWING:] += moved[:, GROWING:]
    p[GROWING:, :GROWING] = p[:GROWING, GROWING:].T
    p.reshape(-1)[DIAGONAL] += half
    return p


class FreeCovariance:
    """
    Propagates the error covariance of an InertialNavigator, from its readings and solution.

    Parameters
    ----------
    variances : (27,) initial variances; those of attitude belong to the inertial attitude error
    densities : (27,) white-noise densities, variance per s
    errors : (9,) given initial errors; that of attitude is the inertial attitude error
    fixed : functions (input, specific force) -> error of the accelerometers and of the gyros, or
        None
    spin : rotation rate of the Earth, rad/s
    held : whether height and vertical velocity come from the truth
    damping : see ``coefficients``
    dt_s : sampling period, s
    show : function of this object, called at the start and after each step, or None

    Attributes
    ----------
    p : (27, 27) covariance; replaced at each step, never changed in place
    mean : (9,) error that is the same in every run; also replaced, never changed in place
    t_ns, solution : instant of the covariance; lat, lon, height, v_n, q_nb at that instant
    show : as given
    shown : the last result of ``show``

    """

    def __init__(self, variances, densities, errors, fixed, spin, held, damping, dt_s, show=None):
        self._variances = np.maximum(variances, KNOWN * KNOWN)
        self._errors, self._fixed = np.array(errors, dtype=float), fixed
        self._densities = np.array(densities, dtype=float)
        self._spin, self._held, self._damping = spin, held, damping
        self._step_s = min(STEP_S, 0.5 / damping[0]) if damping[0] else STEP_S
        self._every = max(1, int(self._step_s / dt_s + 1e-6))
        self.show = show
        self.p = self.mean = self.t_ns = self.solution = self.shown = None

    def begin(self, t_ns, solution):
        """Begin at the start of a navigator; solution: lat, lon, height, v_n, q_nb."""
        p, mean = np.diag(self._variances), self._errors.copy()
        # Convert to the error phi of the level attitude: the computed n turns with the position.
        a, b, c = turn_by_position(solution[0], solution[2])
        turn = np.eye(SIZE)
        turn[6, 1], turn[7, 0], turn[8, 0] = -a, -b, -c
        mean = applied(turn[:GROWING, :GROWING], mean)
        p = product(product(turn, p), turn.T)
        self._keep(t_ns, 0.5 * (p + p.T), mean, solution)
        self._last_ns = t_ns

    def _keep(self, t_ns, p, mean, solution):
        self.p, self.mean, self.t_ns, self.solution = self._level(p), mean, t_ns, solution
        if self._held:
            mean[list(UP)] = 0.0
        self._readings, self._turned = [], 0.0
        if self.show is not None:
            self.shown = self.show(self)

    def _level(self, p):
        """Zero the vertical rows if the vertical channel follows the truth, as the ESKF does."""
        if self._held:
            for k in UP:
                p[k, :] = p[:, k] = 0.0
                p[k, k] = KNOWN[k] * KNOWN[k]
        return p

    def take(self, t_ns, omega, f, navigator):
        """Process the reading with which a navigator has advanced to t_ns."""
        dt = (t_ns - self._last_ns) * 1e-9
        self._last_ns = t_ns
        x, y, z = omega
        self._readings.append((*omega, *f, dt))
        self._turned += (abs(x) + abs(y) + abs(z)) * dt
        if len(self._readings) >= self._every or self._turned >= STEP_RAD:
            self._step(t_ns, navigator.solution)

    def take_block(self, t_ns, omega, f, states):
        """Process readings (n,), (n, 3), (n, 3) and their NavStates; the same bits as ``take``."""
        if not len(t_ns):
            return
        dt = np.diff(t_ns, prepend=self._last_ns) * 1e-9
        rows = np.column_stack((omega, f, dt)).tolist()
        turns = (abs(omega[:, 0]) + abs(omega[:, 1]) + abs(omega[:, 2])) * dt
        first = 0
        while first < len(t_ns):
            stop = min(len(t_ns), first + self._every - len(self._readings))
            turned = np.add.accumulate(np.concatenate([[self._turned], turns[first:stop]]))[1:]
            over = np.flatnonzero(turned >= STEP_RAD)
            if len(over):
                stop = first + int(over[0]) + 1
            self._readings += rows[first:stop]
            self._turned = float(turned[stop - first - 1])
            first = stop
            if len(over) or len(self._readings) >= self._every:
                self._step(int(t_ns[first - 1]), states.one(first - 1))
        self._last_ns = int(t_ns[-1])

    def _step(self, t_ns, solution):
        lat, _, height, v, q_nb = solution
        _, _, _, v_start, q_start = self.solution
        time_s = (t_ns - self.t_ns) * 1e-9
        per_s = 1.0 / time_s
        rows = np.array(self._readings)
        x, y, z, a, b, c = np.add.accumulate(rows[:, :6] * rows[:, 6:])[-1].tolist()
        c_nb = dcm_of(middle_attitude(q_start, q_nb))
        middle = (0.5 * (v_start[0] + v[0]), 0.5 * (v_start[1] + v[1]),
                  0.5 * (v_start[2] + v[2]))
        force, rate = (a * per_s, b * per_s, c * per_s), (x * per_s, y * per_s, z * per_s)
        f = coefficients(lat, height, middle, c_nb, force, rate, self._spin, self._damping)
        # If the IMU period exceeds the step length, split the interval into several steps.
        parts = max(1, int(time_s / self._step_s + 0.5))
        dt = time_s / parts
        n, noise, p, mean = change(f, dt), self._densities * dt, self.p, self.mean
        driven = self._driven(f, c_nb, force, rate, dt)
        for _ in range(parts):
            p = self._level(grown(p, n, noise))
            mean = mean + applied(n[:, :GROWING], mean) + driven
        self._keep(t_ns, p, mean, solution)

    def _driven(self, f, c_nb, force, rate, dt):
        """Return the nine errors (9,) that the fixed instrument errors add in a step."""
        u = np.zeros(GROWING)
        c = np.array(c_nb).reshape(3, 3)
        for rows, fixed, value in zip((V, PHI), self._fixed, (force, rate)):
            if fixed is not None:
                u[rows] = applied(c, fixed(value, force))
        return dt * (u + (0.5 * dt) * applied(f[:, :GROWING], u))
