"""The strapdown: position, velocity and attitude, integrated from increments."""

import math

from ins_sim.core.attitude import integration, quaternion
from ins_sim.core.earth import frames
from . import mechanization
from .placed import Placed
from .vertical_channel import FREE, NO_DAMPING


class Strapdown(Placed):
    """
    Integrate position, velocity and attitude, one IMU increment at a time.

    Parameters
    ----------
    t_ns : instant of the start
    place : latitude (rad), longitude (rad), height (m), v_n (m/s) and q_nb at the start
    spin : rotation rate of the Earth, rad/s
    channel : vertical channel, see ``mechanization.advance``
    damping : c1, c2, c3 of the channel DAMPED
    orientation : attitude algorithm, one of ``integration.KINDS``
    gravity : terms of the gravity formula, one of ``ellipsoid.GRAVITY_TERMS``

    Attributes
    ----------
    t_ns : instant of the solution
    place : position and velocity at that instant, ``mechanization.PLACE``
    orientation : state of the attitude algorithm at that instant
    q_ib : attitude relative to the inertial frame at that instant

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
        """Replace the attitude, given relative to n."""
        q_ib = frames.inertial_attitude(self.lat, self.lon + self.spin * self.elapsed_s, q_nb)
        self.orientation = self._state_of(q_ib)
        self.q_ib = integration.quaternion_of_state(self.orientation)

    def advance(self, t_ns, phi, delta_v, height=0.0, v_u=0.0):
        """
        Advance the solution to t_ns.

        Parameters
        ----------
        t_ns : end of the interval
        phi : (3,) rotation vector of the interval, rad
        delta_v : (3,) velocity increment, resolved in b at the start of the interval, m/s
        height, v_u : reference height (m) and vertical velocity (m/s) at the end of the interval;
            FROM_TRUTH uses both, DAMPED the height, FREE neither

        """
        dt = (t_ns - self.t_ns) * 1e-9
        self.place = mechanization.advance(
            self.place, self.q_ib, delta_v, dt, self.spin, self.spin * self.elapsed_s,
            self.channel, (height, v_u, *self.damping), self.gravity)
        self.orientation = integration.turned(self.orientation, phi, dt)
        self.q_ib = integration.quaternion_of_state(self.orientation)
        self.t_ns = t_ns

    def resume(self, t_ns, orientation, place):
        """Continue from the state at which a compiled loop over samples has ended."""
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
    Return q_nb from an inertial attitude and a position, floats or arrays.

    Parameters
    ----------
    lat, lon : position, rad
    q_ib : inertial attitude
    earth_angle : angle of the rotation from i to e, zero at the start of the run, rad

    """
    return quaternion.multiply(quaternion.conjugate(frames.level_frame(lat, lon + earth_angle)),
                               q_ib)


def runs_away(solution):
    """Return whether a solution has diverged so far that the equations no longer apply."""
    lat, _, height, (x, y, z), _ = solution
    return not (abs(lat) < 0.4999 * math.pi and -1e5 < height < 1e6
                and x * x + y * y + z * z < 1e10)
