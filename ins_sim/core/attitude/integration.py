"""
Orientation from body rates by three algorithms: Poisson's equation, Euler vector, quaternion.

Each algorithm advances the orientation by one rotation vector. The quaternion algorithm is exact
for a rotation about a fixed axis; the other two integrate their differential equation by one step
of RK4 (docs/theory/tuned_gyro.md, Orientation).
"""

import math

from ins_sim.core.numerics import elementary
from . import quaternion
from .matrix import dcm_of, quaternion_of
from .quaternion import shorter

KINDS = ('poisson', 'euler_vector', 'quaternion')


def poisson_row(row, rates, dt):
    """Return a row of C after one RK4 step of C' = C [w x], that is row' = row x w."""
    (w1, w2, w3, w4), (x, y, z), half = rates, row, 0.5 * dt
    a, b, c = quaternion.cross(row, w1)
    d, e, f = quaternion.cross((x + half * a, y + half * b, z + half * c), w2)
    g, h, i = quaternion.cross((x + half * d, y + half * e, z + half * f), w3)
    j, k, m = quaternion.cross((x + dt * g, y + dt * h, z + dt * i), w4)
    s = dt / 6.0
    return (x + s * (a + 2.0 * (d + g) + j), y + s * (b + 2.0 * (e + h) + k),
            z + s * (c + 2.0 * (f + i) + m))


def step_poisson(c, rates, dt):
    """Return the nine floats of C after one RK4 step of Poisson's equation C' = C [w x]."""
    return (*poisson_row(c[0:3], rates, dt), *poisson_row(c[3:6], rates, dt),
            *poisson_row(c[6:9], rates, dt))


def bortz_factor(d2):
    """Return (1 - (d / 2) cot(d / 2)) / d^2, given d^2; the series below 0.01 errs by 1e-16."""
    if d2 < 0.01:
        return 1.0 / 12.0 + d2 * (1.0 / 720.0 + d2 * (1.0 / 30240.0 + d2 / 1209600.0))
    half = 0.5 * math.sqrt(d2)
    sin, cos = elementary.sincos(half)
    return (1.0 - half * cos / sin) / d2


def bortz_rate(theta, w):
    """
    Return the derivative of the rotation vector theta (rad) at the rate w, rad/s.

    theta' = w + theta x w / 2 + bortz_factor theta x (theta x w) (Bortz 1971;
    docs/theory/tuned_gyro.md, Orientation). Singular at |theta| = 2 pi.
    """
    r = quaternion.cross(theta, w)
    x, y, z = quaternion.cross(theta, r)
    k = bortz_factor(theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2])
    return w[0] + 0.5 * r[0] + k * x, w[1] + 0.5 * r[1] + k * y, w[2] + 0.5 * r[2] + k * z


def step_euler_vector(theta, rates, dt):
    """Return the rotation vector after one RK4 step, |theta| <= pi (dt |w| well below pi)."""
    (w1, w2, w3, w4), (x, y, z), half = rates, theta, 0.5 * dt
    a, b, c = bortz_rate(theta, w1)
    d, e, f = bortz_rate((x + half * a, y + half * b, z + half * c), w2)
    g, h, i = bortz_rate((x + half * d, y + half * e, z + half * f), w3)
    j, k, m = bortz_rate((x + dt * g, y + dt * h, z + dt * i), w4)
    s = dt / 6.0
    return shorter((x + s * (a + 2.0 * (d + g) + j), y + s * (b + 2.0 * (e + h) + k),
                    z + s * (c + 2.0 * (f + i) + m)))


def step_quaternion(q, rates, dt):
    """
    Return the quaternion after one step: exact for a constant rate, otherwise of fourth order.

    The rotation vector of the step is the mean rate by Simpson's rule times dt plus the coning
    term dt^2 / 12 w_start x w_end (Magnus expansion of the parabola through the rates).
    """
    w1, w2, w3, w4 = rates
    c, s, t = quaternion.cross(w1, w4), dt / 6.0, dt * dt / 12.0
    phi = (s * (w1[0] + 2.0 * (w2[0] + w3[0]) + w4[0]) + t * c[0],
           s * (w1[1] + 2.0 * (w2[1] + w3[1]) + w4[1]) + t * c[1],
           s * (w1[2] + 2.0 * (w2[2] + w3[2]) + w4[2]) + t * c[2])
    return turn(q, phi)


def turn(q, phi):
    """Return the unit quaternion q rotated further by the rotation vector phi, rad."""
    return quaternion.normalise(quaternion.multiply(q, quaternion.exponential(phi)))


def _same(q):
    return q


# For each algorithm: its step function, and the function from a quaternion to its state.
ALGORITHMS = {'poisson': (step_poisson, dcm_of),
              'euler_vector': (step_euler_vector, quaternion.logarithm),
              'quaternion': (step_quaternion, _same)}


def turned(state, phi, dt):
    """
    Return the state of an algorithm after a rotation by phi, rad, at a constant rate over dt, s.

    state: nine floats (poisson), three (euler_vector) or four (quaternion, exact for any dt).
    """
    if len(state) == 4:
        return turn(state, phi)
    rate = phi[0] / dt, phi[1] / dt, phi[2] / dt
    if len(state) == 9:
        return step_poisson(state, (rate, rate, rate, rate), dt)
    return step_euler_vector(state, (rate, rate, rate, rate), dt)


def quaternion_of_state(state):
    """Return the unit quaternion from the state of an algorithm."""
    if len(state) == 4:
        return state
    if len(state) == 9:
        return quaternion_of(state)
    return quaternion.exponential(state)


class Orientation:
    """
    The attitude of b, integrated by one of KINDS.

    Parameters
    ----------
    kind : poisson, euler_vector or quaternion
    q : initial q_nb, a unit quaternion

    Attributes
    ----------
    state : nine (poisson), three (euler_vector) or four floats (quaternion), which can be saved
        and restored
    """

    def __init__(self, kind, q=quaternion.IDENTITY):
        if kind not in ALGORITHMS:
            raise ValueError(f'orientation is {kind!r}; expected {", ".join(KINDS)}')
        self._step, state_of = ALGORITHMS[kind]
        self.state = state_of(tuple(q))

    def step(self, rates, dt):
        """Advance by dt, s; rates: four vectors at start, middle, middle and end, rad/s."""
        self.state = self._step(self.state, rates, dt)

    def advance(self, phi, dt):
        """Advance by the rotation vector phi, rad, over an interval dt, s, at constant rate."""
        self.state = turned(self.state, phi, dt)

    @property
    def q(self):
        """The attitude as unit quaternion q_nb."""
        return quaternion_of_state(self.state)

    @property
    def dcm(self):
        """C_nb as nine floats, row by row."""
        state = self.state
        return state if len(state) == 9 else dcm_of(self.q)
