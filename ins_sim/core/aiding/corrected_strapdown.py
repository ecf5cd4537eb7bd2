"""The strapdown that can be corrected: an explicit carry, copied to step back in time."""

import copy

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.integration import turn
from ins_sim.core.earth import ellipsoid, frames
from ins_sim.core.earth.rates import rate_on_earth
from ins_sim.core.navigation import mechanization

ZERO = (0.0, 0.0, 0.0)


class CorrectedStrapdown:
    """
    The inertial solution between corrections.

    t_ns, omega, f: the sample at the start, rad/s and m/s^2; place: (lat, lon, height, v_n, q_nb)
    then; spin: rate of the Earth, rad/s; integrated: whether readings are plain integrals.  All
    values are replaced, never changed, so that a shallow copy is a snapshot.

    q_nb, v_b: attitude and velocity in b at t_ns; rate: last reading of the gyros less its bias;
    gyro_bias, accelerometer_bias: what is taken off the readings, rad/s and m/s^2, in b.
    """

    def __init__(self, t_ns, omega, f, dt, place, spin, integrated):
        self.t_ns = self._start_ns = t_ns
        self.spin, self._integrated = spin, integrated
        self.gyro_bias = self.accelerometer_bias = ZERO
        self.lat, self.lon, self.height, self.v, q_nb = place
        self.rate = omega
        self._alpha, self._nu = tuple(w * dt for w in omega), tuple(a * dt for a in f)
        self._set_attitude(q_nb)

    def copy(self):
        """Return a snapshot."""
        return copy.copy(self)

    def _turned(self):
        return self.spin * ((self.t_ns - self._start_ns) * 1e-9)

    def _set_attitude(self, q_nb):
        self.q_nb = q_nb
        self._q_ib = frames.inertial_attitude(self.lat, self.lon + self._turned(), q_nb)
        self.v_b = quaternion.rotate_back(q_nb, self.v)

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb."""
        return self.lat, self.lon, self.height, self.v, self.q_nb

    @property
    def rate_to_earth(self):
        """Return the rate of b relative to the Earth, in b, rad/s."""
        return rate_on_earth(self.lat, self.q_nb, self.rate, self.spin)

    def advance(self, t_ns, omega, f, vertical):
        """
        Take the reading of the interval that ends at t_ns; return its velocity increment, m/s.

        omega, f: rad/s and m/s^2; vertical: (height, V_U) then, or () for the free channel.  The
        increment is in b at the start of the interval, biases taken off.
        """
        dt = (t_ns - self.t_ns) * 1e-9
        (bx, by, bz), (ax, ay, az) = self.gyro_bias, self.accelerometer_bias
        self.rate = x, y, z = omega[0] - bx, omega[1] - by, omega[2] - bz
        alpha = (x * dt, y * dt, z * dt)
        nu = ((f[0] - ax) * dt, (f[1] - ay) * dt, (f[2] - az) * dt)
        phi, u = alpha, nu
        if self._integrated:
            phi, u = mechanization.two_sample_increments(alpha, nu, self._alpha, self._nu)
        since_ns = self.t_ns - self._start_ns + t_ns - self._start_ns
        turned = self.spin * (0.5 * since_ns * 1e-9)
        channel = mechanization.FROM_TRUTH if vertical else mechanization.FREE
        self.lat, self.lon, self.height, self.v, _ = mechanization.step(
            self._q_ib, self.lat, self.lon, self.height, self.v, u, dt, self.spin, turned,
            channel, vertical)
        self._q_ib = turn(self._q_ib, phi)
        self._alpha, self._nu, self.t_ns = alpha, nu, t_ns
        q_in = frames.level_frame(self.lat, self.lon + self._turned())
        self.q_nb = quaternion.multiply(quaternion.conjugate(q_in), self._q_ib)
        self.v_b = quaternion.rotate_back(self.q_nb, self.v)
        return u

    def correct(self, position=ZERO, velocity=ZERO, turned=ZERO):
        """
        Take off estimated errors, solution less truth, East, North, Up.

        position m; velocity m/s; turned: rotation vector of the attitude, q_nb = exp(turned)
        q_nb_true, rad.
        """
        self.lat, self.lon, self.height = ellipsoid.moved(
            self.lat, self.lon, self.height, (-position[0], -position[1], -position[2]))
        self.v = (self.v[0] - velocity[0], self.v[1] - velocity[1], self.v[2] - velocity[2])
        back = quaternion.exponential((-turned[0], -turned[1], -turned[2]))
        self._set_attitude(quaternion.normalise(quaternion.multiply(back, self.q_nb)))

    def add_biases(self, gyro=ZERO, accelerometer=ZERO):
        """Take more off the readings from now on, rad/s and m/s^2 in b."""
        self.gyro_bias = tuple(a + b for a, b in zip(self.gyro_bias, gyro))
        self.accelerometer_bias = tuple(a + b for a, b in zip(self.accelerometer_bias,
                                                              accelerometer))
