"""A strapdown that can be corrected: biases of the readings and errors of the solution."""

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.integration import turn
from ins_sim.core.earth import ellipsoid, frames
from ins_sim.core.earth.rates import rate_on_earth
from ins_sim.core.navigation import mechanization
from ins_sim.core.navigation.increments import fixed_rate_increments, integrals
from ins_sim.core.navigation.placed import Placed
from ins_sim.core.navigation.strapdown import level_attitude
from ins_sim.core.navigation.vertical_channel import FREE

ZERO = (0.0, 0.0, 0.0)


def take_reading(constants, biases, carry, t_ns, omega, f, height, v_u):
    """
    Advance the corrected strapdown over the interval that ends at t_ns.

    Parameters
    ----------
    constants : tuple of start_ns; rotation rate of the Earth (rad/s); whether the readings are
        plain integrals; vertical channel; gravity terms, one of ``ellipsoid.GRAVITY_TERMS``
    biases : biases of the gyros (rad/s) and of the accelerometers (m/s^2), which are subtracted
    carry : tuple of t_ns; ``mechanization.PLACE``; q_ib; q_nb; velocity in b (m/s); rate (rad/s)
        and integrals of the last interval
    t_ns, omega, f : the reading: its instant, rad/s and m/s^2
    height, v_u : true height (m) and vertical velocity (m/s) at t_ns, for the channel FROM_TRUTH

    Returns
    -------
    carry : as above, at t_ns
    delta_v : velocity increment, resolved in b at the start of the interval, m/s

    """
    start_ns, spin, integrated, channel, gravity = constants
    (bx, by, bz), (ax, ay, az) = biases
    last_ns, place, q_ib, _, _, _, last = carry
    dt = (t_ns - last_ns) * 1e-9
    rate = (omega[0] - bx, omega[1] - by, omega[2] - bz)
    now = integrals(rate, (f[0] - ax, f[1] - ay, f[2] - az), dt)
    phi, delta_v = fixed_rate_increments(integrated, now, last)
    place = mechanization.advance(place, q_ib, delta_v, dt, spin,
                                  spin * ((last_ns - start_ns) * 1e-9), channel,
                                  (height, v_u, 0.0, 0.0, 0.0), gravity)
    q_ib = turn(q_ib, phi)
    q_nb = level_attitude(place[0], place[1], q_ib, spin * ((t_ns - start_ns) * 1e-9))
    v_b = quaternion.rotate_back(q_nb, (place[3], place[4], place[5]))
    return (t_ns, place, q_ib, q_nb, v_b, rate, now), delta_v


class CorrectedStrapdown(Placed):
    """
    The inertial solution between corrections; a copy is a snapshot.

    Parameters
    ----------
    t_ns, omega, f : the sample at the start, rad/s and m/s^2
    dt : length of its interval, s
    place : latitude (rad), longitude (rad), height (m), v_n (m/s), q_nb at that sample
    spin : rotation rate of the Earth, rad/s
    integrated : whether readings are plain integrals
    channel : vertical channel, FREE or FROM_TRUTH
    gravity : gravity terms, one of ``ellipsoid.GRAVITY_TERMS``

    Attributes
    ----------
    constants, carry : see ``take_reading``; the properties are read from them
    gyro_bias, accelerometer_bias : biases subtracted from the readings, in b, rad/s and m/s^2

    """

    def __init__(self, t_ns, omega, f, dt, place, spin, integrated, channel=FREE,
                 gravity=None):
        self.constants = t_ns, spin, integrated, channel, gravity
        self.gyro_bias = self.accelerometer_bias = ZERO
        lat, lon, height, v, q_nb = place
        self._set(t_ns, mechanization.begin(lat, lon, height, v, 0.0), q_nb, omega,
                  integrals(omega, f, dt))

    def _set(self, t_ns, place, q_nb, rate, last):
        q_ib = frames.inertial_attitude(place[0], place[1] + self._earth_angle(t_ns), q_nb)
        self.carry = (t_ns, place, q_ib, q_nb, quaternion.rotate_back(q_nb, place[3:6]), rate,
                      last)

    def _earth_angle(self, t_ns):
        """Return the rotation of the Earth since the start, rad."""
        start_ns, spin = self.constants[:2]
        return spin * ((t_ns - start_ns) * 1e-9)

    @property
    def t_ns(self):
        """Return the instant of the solution."""
        return self.carry[0]

    @property
    def place(self):
        """Return position and velocity, ``mechanization.PLACE``."""
        return self.carry[1]

    @property
    def q_nb(self):
        """Return q_nb as last corrected, or as found at the end of the last interval."""
        return self.carry[3]

    @property
    def v_b(self):
        """Return the velocity in b, m/s."""
        return self.carry[4]

    @property
    def rate(self):
        """Return the last gyro reading minus its bias, rad/s."""
        return self.carry[5]

    @property
    def spin(self):
        """Return the rotation rate of the Earth, rad/s."""
        return self.constants[1]

    @property
    def biases(self):
        """Return the subtracted biases of the gyros (rad/s) and accelerometers (m/s^2)."""
        return self.gyro_bias, self.accelerometer_bias

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb."""
        return *self.place[0:3], self.place[3:6], self.carry[3]

    @property
    def rate_to_earth(self):
        """Return the rate of b relative to the Earth, in b, rad/s."""
        return rate_on_earth(self.lat, self.q_nb, self.rate, self.spin)

    def take(self, t_ns, omega, f, height=0.0, v_u=0.0):
        """
        Process the reading of the interval that ends at t_ns; return its velocity increment.

        Parameters
        ----------
        t_ns : end of the interval
        omega, f : (3,) reading, rad/s and m/s^2
        height, v_u : true height (m) and vertical velocity (m/s) at t_ns, for FROM_TRUTH

        Returns
        -------
        (3,) velocity increment without biases, resolved in b at the start of the interval, m/s

        """
        self.carry, delta_v = take_reading(self.constants, self.biases, self.carry, t_ns, omega,
                                           f, height, v_u)
        return delta_v

    def correct(self, position=ZERO, velocity=ZERO, turned=ZERO):
        """
        Subtract estimated errors (solution minus truth, east, north, up) from the solution.

        Parameters
        ----------
        position, velocity : (3,) m and m/s
        turned : (3,) rotation vector of the attitude error, q_nb = exp(turned) q_nb_true, rad

        """
        t_ns, place, _, q_nb, _, rate, last = self.carry
        lat, lon, height, v_e, v_n, v_u, *rest = place
        lat, lon, height = ellipsoid.moved(lat, lon, height,
                                           (-position[0], -position[1], -position[2]))
        place = mechanization.renewed(
            (lat, lon, height, v_e - velocity[0], v_n - velocity[1], v_u - velocity[2], *rest),
            self._earth_angle(t_ns))
        back = quaternion.exponential((-turned[0], -turned[1], -turned[2]))
        self._set(t_ns, place, quaternion.normalise(quaternion.multiply(back, q_nb)), rate, last)

    def add_biases(self, gyro=ZERO, accelerometer=ZERO):
        """Increase the biases subtracted from the readings, (3,) rad/s and m/s^2 in b."""
        self.gyro_bias = tuple(a + b for a, b in zip(self.gyro_bias, gyro))
        self.accelerometer_bias = tuple(a + b for a, b in zip(self.accelerometer_bias,
                                                              accelerometer))
