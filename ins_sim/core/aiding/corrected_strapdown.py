"""The strapdown that can be corrected: biases taken off the readings, errors off the solution."""

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.rates import rate_on_earth
from ins_sim.core.navigation.increments import fixed_rate_increments, integrals
from ins_sim.core.navigation.strapdown import Strapdown
from ins_sim.core.navigation.vertical_channel import FREE

ZERO = (0.0, 0.0, 0.0)


class CorrectedStrapdown(Strapdown):
    """
    The inertial solution between corrections; a copy is a snapshot.

    Parameters
    ----------
    t_ns, omega, f : the sample at the start, rad/s and m/s^2
    dt : length of its interval, s
    place : latitude, longitude, height, v_n, q_nb then
    spin : rotation rate of the Earth, rad/s
    integrated : whether readings are plain integrals
    channel : vertical channel, FREE or FROM_TRUTH

    Attributes
    ----------
    q_nb, v_b : attitude, and velocity in b, at t_ns
    rate : last reading of the gyros less its bias
    gyro_bias, accelerometer_bias : what is taken off the readings, rad/s and m/s^2, in b

    """

    def __init__(self, t_ns, omega, f, dt, place, spin, integrated, channel=FREE):
        super().__init__(t_ns, place, spin, channel)
        self._integrated = integrated
        self.gyro_bias = self.accelerometer_bias = ZERO
        self.rate, self._last = omega, integrals(omega, f, dt)

    def set_attitude(self, q_nb):
        """Replace the attitude by another one relative to n."""
        super().set_attitude(q_nb)
        self._keep(q_nb)

    def _keep(self, q_nb):
        self.q_nb, self.v_b = q_nb, quaternion.rotate_back(q_nb, self.v)

    def attitude(self):
        """Return q_nb, as it was set or found at the end of the last interval."""
        return self.q_nb

    @property
    def rate_to_earth(self):
        """Return the rate of b relative to the Earth, in b, rad/s."""
        return rate_on_earth(self.lat, self.q_nb, self.rate, self.spin)

    def take(self, t_ns, omega, f, reference):
        """
        Take the reading of the interval that ends at t_ns; return its velocity increment, m/s.

        omega, f: rad/s and m/s^2; reference: as of ``Strapdown.advance``.  The increment is in b
        at the start of the interval, biases taken off.
        """
        (bx, by, bz), (ax, ay, az) = self.gyro_bias, self.accelerometer_bias
        self.rate = rate = omega[0] - bx, omega[1] - by, omega[2] - bz
        now = integrals(rate, (f[0] - ax, f[1] - ay, f[2] - az), (t_ns - self.t_ns) * 1e-9)
        phi, u = fixed_rate_increments(self._integrated, now, self._last)
        self._last = now
        self.advance(t_ns, phi, u, *reference)
        self._keep(super().attitude())
        return u

    def correct(self, position=ZERO, velocity=ZERO, turned=ZERO):
        """
        Take off estimated errors, solution less truth, East, North, Up.

        position m; velocity m/s; turned: rotation vector of the attitude, q_nb = exp(turned)
        q_nb_true, rad.
        """
        v = self.v
        self.move(*ellipsoid.moved(self.lat, self.lon, self.height,
                                   (-position[0], -position[1], -position[2])),
                  (v[0] - velocity[0], v[1] - velocity[1], v[2] - velocity[2]))
        back = quaternion.exponential((-turned[0], -turned[1], -turned[2]))
        self.set_attitude(quaternion.normalise(quaternion.multiply(back, self.q_nb)))

    def add_biases(self, gyro=ZERO, accelerometer=ZERO):
        """Take more off the readings from now on, rad/s and m/s^2 in b."""
        self.gyro_bias = tuple(a + b for a, b in zip(self.gyro_bias, gyro))
        self.accelerometer_bias = tuple(a + b for a, b in zip(self.accelerometer_bias,
                                                              accelerometer))
