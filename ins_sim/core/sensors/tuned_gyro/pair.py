"""
Two dynamically tuned gyros: four channels for three axes (Sapegin, Romanov and Bugaiov 2016).

Gyro 1 spins along body z: its case axes (spin, y_c, z_c) are body (z, x, y), so it senses x and y.
Gyro 2 spins along body y: its case axes are body (y, z, x), so it senses z and x. Both triads are
right-handed. In arrangement ``paper`` the channels are x1, y1, z2, x2. In arrangement ``turned``
each pair of pick-offs is turned by +45 deg about its spin axis, so that the channels read
(y_c + z_c) / sqrt 2 and (z_c - y_c) / sqrt 2.

In both arrangements the body rates are the least-squares solution, with covariance
diag(1/2, 1, 1) times the variance of one channel. The residual is a single number, the parity,
with the standard deviation of one channel. With ``paper`` it shows faults of x1 and x2 only, with
``turned`` faults of every channel.
"""

import math

import numpy as np

from .rotor import TunedGyroParameters
from .rotor_step import disturbed_step, rotor_step
from .stepping import TunedGyro

ARRANGEMENTS = ('paper', 'turned')
CHANNELS = ('gyro_1_y', 'gyro_1_z', 'gyro_2_y', 'gyro_2_z')
# Variances of body x, y, z divided by the variance of a channel.
COVARIANCE_FACTORS = (0.5, 1.0, 1.0)
_R = math.sqrt(0.5)


def channel_axes(arrangement):
    """Return the sensitive axes of the channels as unit vectors (4, 3) in body axes."""
    case = np.zeros((4, 3))
    case[range(4), (0, 1, 2, 0)] = 1.0
    if arrangement == 'paper':
        return case
    return _R * np.array((case[0] + case[1], case[1] - case[0],
                          case[2] + case[3], case[3] - case[2]))


def into_cases(turned, w):
    """Return the components y, z of a body vector in the first case, then in the second."""
    x, y, z = w
    if turned:
        return _R * (x + y), _R * (y - x), _R * (z + x), _R * (x - z)
    return x, y, z, x


def spins(w):
    """Return the components of a body vector along both spin axes."""
    return w[2], w[1]


def both_inputs(turned, w_start, w_mid, w_end):
    """Return the inputs u of both rotors (see ``rotor_step``) for body rates at three instants."""
    a, b, c, d = into_cases(turned, w_start)
    e, f, g, h = into_cases(turned, w_mid)
    i, j, k, m = into_cases(turned, w_end)
    return (a, b, e, f, i, j), (c, d, g, h, k, m)


def with_faults(faults, y):
    """Return the four channels y with their faults: (bias, scale) for each channel, or None."""
    if faults is None:
        return y
    (b1, s1), (b2, s2), (b3, s3), (b4, s4) = faults
    y1, y2, y3, y4 = y
    return b1 + s1 * y1, b2 + s2 * y2, b3 + s3 * y3, b4 + s4 * y4


def combine(turned, y):
    """Return the body rates and the parity of the four channels, rad/s."""
    a, b, c, d = y
    if turned:
        x1, x2 = a - b, c + d
        return (0.5 * _R * (x1 + x2), _R * (a + b), _R * (c - d)), 0.5 * (x1 - x2)
    return (0.5 * (a + d), b, c), _R * (a - d)


class GyroPair:
    """
    Two gyros, the combination of their channels, and an injectable fault.

    Parameters
    ----------
    parameters : TunedGyroParameters of both gyros, or a pair of them
    dt_s : step, s
    arrangement : paper or turned
    options : method, hold and on_unstable of TunedGyro

    Attributes
    ----------
    state : states of both gyros, which can be saved and set back; a fault is not part of it
    faults : (bias, scale) of each channel, or None
    """

    def __init__(self, parameters, dt_s, arrangement='paper', **options):
        if arrangement not in ARRANGEMENTS:
            raise ValueError(f'arrangement is {arrangement!r}; expected paper or turned')
        if isinstance(parameters, TunedGyroParameters):
            parameters = (parameters, parameters)
        if len(parameters) != 2:
            raise ValueError(f'parameters of {len(parameters)} gyros are given; expected 2')
        self.gyros = tuple(TunedGyro(p, dt_s, **options) for p in parameters)
        self.arrangement = arrangement
        self._turned = arrangement == 'turned'
        self.faults = None

    @property
    def state(self):
        """The states of both gyros."""
        return self.gyros[0].state, self.gyros[1].state

    @state.setter
    def state(self, state):
        self.gyros[0].state, self.gyros[1].state = state

    def inject(self, channel, bias_rad_s=0.0, scale=1.0):
        """
        Inject a fault: the channel reads its rate times scale, plus a bias.

        Parameters
        ----------
        channel : index 0 to 3, or one of CHANNELS
        bias_rad_s : rad/s
        scale : 1 for none, 0 for a dead channel
        """
        if channel in CHANNELS:
            channel = CHANNELS.index(channel)
        if channel not in range(4):
            raise ValueError(f'channel is {channel!r}; expected 0 to 3 or one of '
                             + ', '.join(CHANNELS))
        if not (math.isfinite(bias_rad_s) and math.isfinite(scale)):
            raise ValueError(f'bias_rad_s is {bias_rad_s:g} and scale is {scale:g}; expected '
                             'finite numbers')
        faults = list(self.faults or ((0.0, 1.0),) * 4)
        faults[channel] = (bias_rad_s, scale)
        self.faults = tuple(faults)

    def clear_faults(self):
        """Remove the injected faults from all channels."""
        self.faults = None

    def into_cases(self, w):
        """Return the result of the function ``into_cases`` for this arrangement."""
        return into_cases(self._turned, w)

    def combine(self, y):
        """Return the body rates and the parity of the four channels, rad/s."""
        return combine(self._turned, y)

    def settle(self, w):
        """Set both gyros to the steady state at the constant body rate w, rad/s."""
        y1, z1, y2, z2 = self.into_cases(w)
        self.gyros[0].settle(complex(y1, z1))
        self.gyros[1].settle(complex(y2, z2))

    def instant(self, w):
        """Return the four channels of perfect gyros at the body rate w, rad/s."""
        return with_faults(self.faults, self.into_cases(w))

    def channels(self, w_start, w_mid, w_end, disturbances=None):
        """
        Advance by dt and return the mean rates of the four channels, rad/s.

        Parameters
        ----------
        w_start, w_mid, w_end : body rates omega_ib_b at start, middle and end, rad/s
        disturbances : moment, tilt and jump for each gyro, six floats each, see ``rotor_step``
        """
        first, second = self.gyros
        one, two = both_inputs(self._turned, w_start, w_mid, w_end)
        if disturbances is None:
            first.state, (a, b) = rotor_step(first.gains, first.state, one)
            second.state, (c, d) = rotor_step(second.gains, second.state, two)
        else:
            first.state, (a, b) = disturbed_step(first.gains, first.added, first.state, one,
                                                 disturbances[0])
            second.state, (c, d) = disturbed_step(second.gains, second.added, second.state, two,
                                                  disturbances[1])
        return with_faults(self.faults, (a, b, c, d))

    def step(self, w_start, w_mid, w_end):
        """Advance by dt; return the mean body rates (x, y, z) and the parity, rad/s."""
        return self.combine(self.channels(w_start, w_mid, w_end))

    def run(self, w_start, w_mid, w_end, disturbances=(None, None)):
        """
        Return the mean rates of the four channels, without faults, over n steps; (n,) each.

        Parameters
        ----------
        w_start, w_mid, w_end : body rates, three columns (n,) each, rad/s
        disturbances : (n, 6) or None for each gyro, see ``channels``
        """
        inputs = both_inputs(self._turned, w_start, w_mid, w_end)
        first, second = (gyro.run(np.column_stack(u), d)
                         for gyro, u, d in zip(self.gyros, inputs, disturbances))
        return first[:, 0], first[:, 1], second[:, 0], second[:, 1]

    def advance(self, w):
        """Return rates (n, 3) and parity (n,) of n steps; w (n, 3 instants, 3 axes), rad/s."""
        nodes = np.moveaxis(np.asarray(w, dtype=float), 0, -1)
        omega, parity = self.combine(with_faults(self.faults, self.run(*nodes)))
        return np.column_stack(omega), parity

    def response(self, omega):
        """
        Return the frequency response (n, 3, 3) from body rates to combined rates, without faults.

        It is the same in both arrangements, because the rotor is isotropic.

        Parameters
        ----------
        omega : (n,) frequencies, rad/s, either sign
        """
        (d1, c1), (d2, c2) = (gyro.space.axis_responses(omega) for gyro in self.gyros)
        zero = 0.0 * d1
        rows = ((0.5 * (d1 + d2), -0.5 * c1, 0.5 * c2), (c1, d1, zero), (-c2, zero, d2))
        return np.moveaxis(np.array(rows), (0, 1), (-2, -1))
