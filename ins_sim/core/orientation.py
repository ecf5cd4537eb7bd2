"""
Orientation from body rates by three algorithms: Poisson, Euler (rotation) vector, quaternion.

Each takes the rates (rad/s, of b relative to the reference, in b) at the four stages of RK4:
start, middle, middle, end of the step; give the reading four times where there is only a mean.
"""

import math

from . import attitude

KINDS = ('poisson', 'euler_vector', 'quaternion')


def dcm_of(q):
    """Return C_nb as nine floats, row by row, of a unit quaternion q_nb."""
    x, y, z, w = q
    return (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
            2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
            2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))


def quaternion_of(c):
    """Return the unit quaternion of nine floats C_nb, row by row (Shepperd 1978)."""
    trace = c[0] + c[4] + c[8]
    squares = (1.0 + 2.0 * c[0] - trace, 1.0 + 2.0 * c[4] - trace, 1.0 + 2.0 * c[8] - trace,
               1.0 + trace)
    k = squares.index(max(squares))
    if k == 0:
        q = (squares[0], c[1] + c[3], c[2] + c[6], c[7] - c[5])
    elif k == 1:
        q = (c[1] + c[3], squares[1], c[5] + c[7], c[2] - c[6])
    elif k == 2:
        q = (c[2] + c[6], c[5] + c[7], squares[2], c[3] - c[1])
    else:
        q = (c[7] - c[5], c[2] - c[6], c[3] - c[1], squares[3])
    norm = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm


def poisson_row(row, rates, dt):
    """Return a row of C after one RK4 step of C' = C [w x], that is row' = row x w."""
    (w1, w2, w3, w4), (x, y, z), half = rates, row, 0.5 * dt
    a, b, c = attitude.cross(row, w1)
    d, e, f = attitude.cross((x + half * a, y + half * b, z + half * c), w2)
    g, h, i = attitude.cross((x + half * d, y + half * e, z + half * f), w3)
    j, k, m = attitude.cross((x + dt * g, y + dt * h, z + dt * i), w4)
    s = dt / 6.0
    return (x + s * (a + 2.0 * (d + g) + j), y + s * (b + 2.0 * (e + h) + k),
            z + s * (c + 2.0 * (f + i) + m))


def poisson(c, rates, dt):
    """Return the nine floats of C after one RK4 step of Poisson's equation C' = C [w x]."""
    return (poisson_row(c[0:3], rates, dt) + poisson_row(c[3:6], rates, dt)
            + poisson_row(c[6:9], rates, dt))


def bortz_factor(d2):
    """Return (1 - (d / 2) cot(d / 2)) / d^2 of d^2; the series below 0.01 is good to 1e-16."""
    if d2 < 0.01:
        return 1.0 / 12.0 + d2 * (1.0 / 720.0 + d2 * (1.0 / 30240.0 + d2 / 1209600.0))
    half = 0.5 * math.sqrt(d2)
    return (1.0 - half * math.cos(half) / math.sin(half)) / d2


def bortz_rate(theta, w):
    """
    Return the derivative of the rotation vector theta, rad/s.

    theta' = w + theta x w / 2 + bortz_factor theta x (theta x w) (Bortz 1971; spec/dtg equation
    (3)).  Singular at |theta| = 2 pi.
    """
    r = attitude.cross(theta, w)
    x, y, z = attitude.cross(theta, r)
    k = bortz_factor(theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2])
    return w[0] + 0.5 * r[0] + k * x, w[1] + 0.5 * r[1] + k * y, w[2] + 0.5 * r[2] + k * z


def shorter(theta):
    """Return the same rotation by at most pi: theta (1 - 2 pi / d) where d > pi."""
    x, y, z = theta
    d2 = x * x + y * y + z * z
    if d2 <= math.pi * math.pi:
        return theta
    s = 1.0 - 2.0 * math.pi / math.sqrt(d2)
    return x * s, y * s, z * s


def euler_vector(theta, rates, dt):
    """Return the rotation vector after one RK4 step, at most pi long (dt |w| well below pi)."""
    (w1, w2, w3, w4), (x, y, z), half = rates, theta, 0.5 * dt
    a, b, c = bortz_rate(theta, w1)
    d, e, f = bortz_rate((x + half * a, y + half * b, z + half * c), w2)
    g, h, i = bortz_rate((x + half * d, y + half * e, z + half * f), w3)
    j, k, m = bortz_rate((x + dt * g, y + dt * h, z + dt * i), w4)
    s = dt / 6.0
    return shorter((x + s * (a + 2.0 * (d + g) + j), y + s * (b + 2.0 * (e + h) + k),
                    z + s * (c + 2.0 * (f + i) + m)))


def quaternion(q, rates, dt):
    """
    Return the quaternion after one step, exact for a constant rate, of fourth order otherwise.

    Rotation vector of the step: Simpson's mean and the coning dt^2 / 12 w_start x w_end (Magnus
    expansion of the parabola through the rates).
    """
    w1, w2, w3, w4 = rates
    c, s, t = attitude.cross(w1, w4), dt / 6.0, dt * dt / 12.0
    phi = (s * (w1[0] + 2.0 * (w2[0] + w3[0]) + w4[0]) + t * c[0],
           s * (w1[1] + 2.0 * (w2[1] + w3[1]) + w4[1]) + t * c[1],
           s * (w1[2] + 2.0 * (w2[2] + w3[2]) + w4[2]) + t * c[2])
    return turn(q, phi)


def turn(q, phi):
    """Return the unit quaternion q after the rotation vector phi, rad: exact."""
    return attitude.normalise(attitude.multiply(q, attitude.exponential(phi)))


def _same(q):
    return q


# kind: (step, state of a quaternion, quaternion of a state)
_ALGORITHMS = {'poisson': (poisson, dcm_of, quaternion_of),
               'euler_vector': (euler_vector, attitude.logarithm, attitude.exponential),
               'quaternion': (quaternion, _same, _same)}


class Orientation:
    """
    The attitude of b by one of KINDS.

    kind: poisson, euler_vector or quaternion; q: the initial q_nb, unit.  state: nine, three or
    four floats that can be kept and set back.
    """

    def __init__(self, kind, q=attitude.IDENTITY):
        if kind not in _ALGORITHMS:
            raise ValueError(f'orientation is {kind!r}; expected {", ".join(KINDS)}')
        self._step, to_state, self._to_quaternion = _ALGORITHMS[kind]
        self.state = to_state(tuple(q))

    def step(self, rates, dt):
        """Advance by dt, s; rates: four vectors at start, middle, middle, end, rad/s."""
        self.state = self._step(self.state, rates, dt)

    def advance(self, phi, dt):
        """Advance by the rotation vector phi, rad, of an interval dt, s, at its constant rate."""
        if self._step is quaternion:
            self.state = turn(self.state, phi)
        else:
            rate = (phi[0] / dt, phi[1] / dt, phi[2] / dt)
            self.state = self._step(self.state, (rate,) * 4, dt)

    @property
    def q(self):
        """The attitude as unit quaternion q_nb."""
        return self._to_quaternion(self.state)

    @property
    def dcm(self):
        """C_nb as nine floats, row by row."""
        state = self.state
        return state if len(state) == 9 else dcm_of(self._to_quaternion(state))


def roll(c):
    """Return gamma of C_nb = Rz Ry(-theta) Rx(gamma), nine floats, rad."""
    return math.atan2(c[7], c[8])
