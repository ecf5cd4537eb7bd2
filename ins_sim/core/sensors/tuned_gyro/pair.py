"""
Two dynamically tuned gyros: four channels for three axes.

Gyro 1 spins along body z: its case (spin, y_c, z_c) is body (z, x, y), so that it senses x and y.
Gyro 2 spins along body y: its case is body (y, z, x), so that it senses z and x.  Both triads are
right-handed.  Arrangement ``paper``: channels x1, y1, z2, x2.  Arrangement ``turned``: each pair
of pick-offs is turned by +45 deg about its spin axis, so that a channel reads (y_c + z_c) / sqrt 2
or (z_c - y_c) / sqrt 2.  Least squares gives the body rates with the covariance diag(1/2, 1, 1)
of one channel's variance either way; the residual is one number, the parity, of one channel's
standard deviation.  ``paper`` sees faults of x1 and x2 in it, ``turned`` those of any channel.
"""

import math

import numpy as np

from .rotor import TunedGyroParameters
from .stepping import TunedGyro

ARRANGEMENTS = ('paper', 'turned')
CHANNELS = ('gyro_1_y', 'gyro_1_z', 'gyro_2_y', 'gyro_2_z')
# variance of body x, y, z relative to that of a channel
COVARIANCE_FACTORS = (0.5, 1.0, 1.0)
_R = math.sqrt(0.5)


def channel_axes(arrangement):
    """Return the unit vectors (4, 3) of the channels in body axes."""
    case = np.zeros((4, 3))
    case[range(4), (0, 1, 2, 0)] = 1.0
    if arrangement == 'paper':
        return case
    return _R * np.array((case[0] + case[1], case[1] - case[0],
                          case[2] + case[3], case[3] - case[2]))


def combine_paper(y):
    """Return the body rates and the parity of the channels x1, y1, z2, x2."""
    a, b, c, d = y
    return (0.5 * (a + d), b, c), _R * (a - d)


def combine_turned(y):
    """Return the body rates and the parity of the four turned channels."""
    a, b, c, d = y
    x1, x2 = a - b, c + d
    return (0.5 * _R * (x1 + x2), _R * (a + b), _R * (c - d)), 0.5 * (x1 - x2)


class GyroPair:
    """
    Two gyros, their combination and an injectable fault.

    parameters: TunedGyroParameters of both, or a pair of them; dt_s: step; arrangement: paper or
    turned; options: method, hold, on_unstable of TunedGyro.  state: of both gyros, can be kept
    and set back; a fault is no part of it.
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
        self.combine = combine_turned if self._turned else combine_paper
        self._faults = None

    @property
    def state(self):
        """The states of both gyros."""
        return self.gyros[0].state, self.gyros[1].state

    @state.setter
    def state(self, state):
        self.gyros[0].state, self.gyros[1].state = state

    def inject(self, channel, bias_rad_s=0.0, scale=1.0):
        """Let a channel, by name or index, read scale times its rate plus bias, rad/s."""
        if channel in CHANNELS:
            channel = CHANNELS.index(channel)
        if channel not in range(4):
            raise ValueError(f'channel is {channel!r}; expected 0 to 3 or one of '
                             + ', '.join(CHANNELS))
        if not (math.isfinite(bias_rad_s) and math.isfinite(scale)):
            raise ValueError(f'bias_rad_s is {bias_rad_s:g} and scale is {scale:g}; expected '
                             'finite numbers')
        faults = list(self._faults or ((0.0, 1.0),) * 4)
        faults[channel] = (bias_rad_s, scale)
        self._faults = tuple(faults)

    def clear_faults(self):
        """Let every channel read what it should."""
        self._faults = None

    @staticmethod
    def spins(w):
        """Return the components of a body vector along both spin axes."""
        return w[2], w[1]

    def into_cases(self, w):
        """Return the components y + j z of a body vector in both cases, in two complex numbers."""
        x, y, z = w
        if self._turned:
            return complex(_R * (x + y), _R * (y - x)), complex(_R * (z + x), _R * (x - z))
        return complex(x, y), complex(z, x)

    def settle(self, w):
        """Take the state of gyros that have long turned at the constant body rate w, rad/s."""
        for gyro, u in zip(self.gyros, self.into_cases(w)):
            gyro.settle(u)

    def _out(self, a, b):
        """Return the four channels of two complex readings."""
        y = a.real, a.imag, b.real, b.imag
        if self._faults is None:
            return y
        return tuple([bias + scale * v for v, (bias, scale) in zip(y, self._faults)])

    def instant(self, w):
        """Return the four channels of perfect gyros that turn at the body rate w, rad/s."""
        return self._out(*self.into_cases(w))

    def channels(self, w_start, w_mid, w_end, disturbances=None):
        """
        Advance by dt; body rates omega_ib_b, rad/s; return the mean of the four channels.

        disturbances: (moment, tilt, jump) of either gyro, as TunedGyro.step_disturbed takes them.
        """
        (a0, b0), (am, bm) = self.into_cases(w_start), self.into_cases(w_mid)
        a1, b1 = self.into_cases(w_end)
        first, second = self.gyros
        if disturbances is None:
            return self._out(first.step(a0, am, a1), second.step(b0, bm, b1))
        one, two = disturbances
        return self._out(first.step_disturbed(a0, am, a1, *one),
                         second.step_disturbed(b0, bm, b1, *two))

    def step(self, w_start, w_mid, w_end):
        """Advance by dt; return the mean body rates (x, y, z), rad/s, and the parity, rad/s."""
        return self.combine(self.channels(w_start, w_mid, w_end))

    def step_stages(self, w_start, w_mid, w_end):
        """Advance by dt with RK4; return the body rates at its four stages, rad/s."""
        (a0, b0), (am, bm) = self.into_cases(w_start), self.into_cases(w_mid)
        a1, b1 = self.into_cases(w_end)
        first, second = self.gyros
        return [self.combine(self._out(a, b))[0] for a, b in
                zip(first.step_stages(a0, am, a1), second.step_stages(b0, bm, b1))]

    def advance(self, w):
        """Return rates (n, 3) and parity (n,) of n steps; w (n, 3 instants, 3 axes), rad/s."""
        omega, parity = zip(*(self.step(*row) for row in np.asarray(w, dtype=float).tolist()))
        return np.array(omega), np.array(parity)

    def response(self, omega):
        """
        Return the frequency response (n, 3, 3) from body rates to combined rates, no fault.

        omega (n,): rad/s, either sign.  It is the same in both arrangements, the rotor being
        isotropic.
        """
        (d1, c1), (d2, c2) = (gyro.space.axis_responses(omega) for gyro in self.gyros)
        zero = 0.0 * d1
        rows = ((0.5 * (d1 + d2), -0.5 * c1, 0.5 * c2), (c1, d1, zero), (-c2, zero, d2))
        return np.moveaxis(np.array(rows), (0, 1), (-2, -1))
