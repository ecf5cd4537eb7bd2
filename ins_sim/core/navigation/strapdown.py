"""The strapdown: position, velocity and attitude from increments."""

import copy
import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.integration import ALGORITHMS
from ins_sim.core.earth import frames
from . import mechanization


class Strapdown:
    """
    Position, velocity and attitude, advanced from increment to increment.

    All state is replaced, never changed, so that a copy is a snapshot and costs as little as one.

    Parameters
    ----------
    t_ns : instant of the start
    place : latitude (rad), longitude (rad), height (m), v_n (m/s) and q_nb at the start
    spin : rotation rate of the Earth, rad/s
    channel : vertical channel, as of ``mechanization.advance``
    damping : c1, c2, c3 of the channel DAMPED
    orientation : attitude algorithm, one of ``integration.KINDS``

    Attributes
    ----------
    t_ns : instant of the solution
    lat, lon, height, v : position (rad, rad, m) and v_n (m/s) then; to set them leaves the
        attitude relative to the inertial frame as it is
    q_ib : attitude relative to the inertial frame then

    """

    def __init__(self, t_ns, place, spin, channel=mechanization.FREE, damping=(),
                 orientation='quaternion'):
        self.t_ns = self._start_ns = t_ns
        self.spin, self._channel, self._damping = spin, channel, damping
        _, self._turn, self._state_of, self._quaternion_of = ALGORITHMS[orientation]
        self._vertical_bias = 0.0
        self.lat, self.lon, self.height, self.v, q_nb = place
        self.set_attitude(q_nb)

    def copy(self):
        """Return a snapshot."""
        return copy.copy(self)

    def set_attitude(self, q_nb):
        """Replace the attitude by another one relative to n."""
        q_ib = frames.inertial_attitude(self.lat, self.lon + self.spin * self.elapsed_s, q_nb)
        self._orientation = self._state_of(q_ib)
        self.q_ib = self._quaternion_of(self._orientation)

    def advance(self, t_ns, phi, delta_v, reference=()):
        """
        Advance to t_ns.

        phi: rotation vector of the interval, rad; delta_v: its velocity increment in b at its
        start, m/s; reference: height, m, and vertical velocity, m/s, at its end for the channel
        FROM_TRUTH, height for DAMPED.
        """
        last_ns, start_ns = self.t_ns, self._start_ns
        dt = (t_ns - last_ns) * 1e-9
        middle_s = 0.5 * (last_ns - start_ns + t_ns - start_ns) * 1e-9
        if self._damping:
            reference = (*reference, *self._damping, self._vertical_bias)
        (self.lat, self.lon, self.height), self.v, self._vertical_bias = mechanization.advance(
            self.q_ib, (self.lat, self.lon, self.height), self.v, delta_v, dt, self.spin,
            self.spin * middle_s, self._channel, reference)
        self._orientation = self._turn(self._orientation, phi, dt)
        self.q_ib = self._quaternion_of(self._orientation)
        self.t_ns = t_ns

    @property
    def elapsed_s(self):
        """Return the time since the start, s."""
        return (self.t_ns - self._start_ns) * 1e-9

    def attitude(self):
        """Return q_nb."""
        elapsed_s = (self.t_ns - self._start_ns) * 1e-9
        q_in = frames.level_frame(self.lat, self.lon + self.spin * elapsed_s)
        return quaternion.multiply(quaternion.conjugate(q_in), self.q_ib)

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb."""
        return self.lat, self.lon, self.height, self.v, self.attitude()


def runs_away(solution):
    """Return whether a solution has left what the strapdown's formulas hold for."""
    lat, _, height, v, _ = solution
    return not (abs(lat) < 0.4999 * math.pi and -1e5 < height < 1e6 and math.hypot(*v) < 1e5)
