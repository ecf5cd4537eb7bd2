"""The strapdown: position, velocity and attitude from increments."""

import math

from ins_sim.core.attitude import integration, quaternion
from ins_sim.core.earth import frames
from . import mechanization
from .placed import Placed
from .vertical_channel import FREE, NO_DAMPING


class Strapdown(Placed):
    """
    Position, velocity and attitude, advanced from increment to increment.

    Parameters
    ----------
    t_ns : instant of the start
    place : latitude (rad), longitude (rad), height (m), v_n (m/s) and q_nb at the start
    spin : rotation rate of the Earth, rad/s
    channel : vertical channel, as of ``mechanization.advance``
    damping : c1, c2, c3 of the channel DAMPED
    orientation : attitude algorithm, one of ``integration.KINDS``
    gravity : terms of the formula of gravity, one of ``ellipsoid.GRAVITY_TERMS``

    Attributes
    ----------
    t_ns : instant of the solution
    place : position and velocity then, ``mechanization.PLACE``
    orientation : state of the attitude algorithm then
    q_ib : attitude relative to the inertial frame then

    """

    def __init__(self, t_ns, place, spin, channel=FREE, damping=NO_DAMPING,
                 orientation='quaternion', gravity=None):
        self.t_ns = self.start_ns = t_ns
        self.spin, self.channel, self.damping = spin, channel, damping
        self.gravity = gravity
        _, self._state_of = integration.ALGORITHMS[orientation]
        lat, lon, height, v, q_nb = place
        self.place = mechanization.begin(lat, lon, height, v, 0.0)
        self.set_attitude(q_nb)

    def move(self, lat, lon, height, v):
        """Replace position (rad, rad, m) and v_n (m/s); q_ib stays."""
        self.place = mechanization.renewed((lat, lon, height, *v, *self.place[6:]),
                                           self.spin * self.elapsed_s)

    def set_attitude(self, q_nb):
        """Replace the attitude by another one relative to n."""
        q_ib = frames.inertial_attitude(self.lat, self.lon + self.spin * self.elapsed_s, q_nb)
        self.orientation = self._state_of(q_ib)
        self.q_ib = integration.quaternion_of_state(self.orientation)

    def advance(self, t_ns, phi, delta_v, height=0.0, v_u=0.0):
        """
        Advance to t_ns.

        phi: rotation vector of the interval, rad; delta_v: its velocity increment in b at its
        start, m/s; height, m, v_u, m/s: reference at its end for the channel FROM_TRUTH, of which
        DAMPED takes the height.
        """
        dt = (t_ns - self.t_ns) * 1e-9
        self.place = mechanization.advance(
            self.place, self.q_ib, delta_v, dt, self.spin, self.spin * self.elapsed_s,
            self.channel, (height, v_u, *self.damping), self.gravity)
        self.orientation = integration.turned(self.orientation, phi, dt)
        self.q_ib = integration.quaternion_of_state(self.orientation)
        self.t_ns = t_ns

    def resume(self, t_ns, orientation, place):
        """Take the state that a loop over samples has come to."""
        self.t_ns, self.orientation, self.place = t_ns, orientation, place
        self.q_ib = integration.quaternion_of_state(orientation)

    @property
    def elapsed_s(self):
        """Return the time since the start, s."""
        return (self.t_ns - self.start_ns) * 1e-9

    def attitude(self):
        """Return q_nb."""
        return level_attitude(self.lat, self.lon, self.q_ib, self.spin * self.elapsed_s)

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb."""
        lat, lon, height, *v = self.place[:6]
        return lat, lon, height, tuple(v), self.attitude()


def level_attitude(lat, lon, q_ib, earth_angle):
    """
    Return q_nb of an inertial attitude at a position, floats or arrays.

    earth_angle: rotation of e in i since they coincided, rad.
    """
    return quaternion.multiply(quaternion.conjugate(frames.level_frame(lat, lon + earth_angle)),
                               q_ib)


def runs_away(solution):
    """Return whether a solution has left what the strapdown's formulas hold for."""
    lat, _, height, (x, y, z), _ = solution
    return not (abs(lat) < 0.4999 * math.pi and -1e5 < height < 1e6
                and x * x + y * y + z * z < 1e10)
