"""The error-state Kalman filter of the aided navigator; its model stands in model."""

import numpy as np

from ins_sim.core.attitude import matrix, quaternion
from ins_sim.core.attitude.interpolation import middle
from ins_sim.core.navigation.errors import position_error
from ins_sim.core.numerics.units import DEG, DEG_H, SQRT_H, UG
from . import eskf_model as model
from .. import kalman
from .base import FixOutcome, FreeFilter

# what is known exactly still has a variance, so that the covariance stays positive definite: m,
# m/s, rad, m/s^2, rad/s, m, rad and parts
FLOOR = np.array([1e-3] * 3 + [1e-5] * 3 + [1e-8] * 3 + [1e-9] * 3 + [1e-12] * 3 + [1e-9] * 2
                 + [1e-9, 1e-9, 1e-9])
GATE = 'its innovation is beyond the gate'
# how long a turn lasts, and what is shorter than one, s
TURN_S, SMOOTHING_S = 50.0, 10.0


class ErrorStateFilter(FreeFilter):
    """
    Twenty states; every fix is taken off the strapdown at once, so that the state is zero.

    The residual of the velocity meter is the mean over its window of the velocity in b, which is
    exact whatever the vehicle does in it: eta carries the errors of the window (spec section 4).
    """

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        initial, imu, meter = settings.initial, settings.imu_model, settings.meter_model
        self._altimeter = settings.vertical.channel == 'altimeter'
        self._held = (settings.vertical.height_sigma_m ** 2,
                      settings.vertical.velocity_sigma_m_s ** 2)
        tilt = 1e-3 * initial.tilt_sigma_mrad
        sigmas = ([initial.position_sigma_m] * 2 + [settings.vertical.height_sigma_m]
                  + [initial.velocity_sigma_m_s] * 2 + [settings.vertical.velocity_sigma_m_s]
                  + [tilt, tilt, 1e-3 * initial.azimuth_sigma_mrad]
                  + [imu.accelerometer_bias_sigma_ug * UG] * 3
                  + [imu.gyro_bias_sigma_deg_h * DEG_H] * 3 + [0.0, 0.0]
                  + [meter.mounting_sigma_arcmin * DEG / 60.0, meter.scale_x_sigma,
                     meter.scale_z_sigma])
        self.covariance = np.diag(np.maximum(sigmas, FLOOR) ** 2)
        walks = ([0.0] * 3 + [imu.velocity_random_walk_m_s_sqrt_h / SQRT_H] * 3
                 + [imu.angle_random_walk_deg_sqrt_h * DEG / SQRT_H] * 3
                 + [imu.accelerometer_bias_walk_ug_sqrt_h * UG / SQRT_H] * 3
                 + [imu.gyro_bias_walk_deg_h_sqrt_h * DEG_H / SQRT_H] * 3 + [0.0] * 5)
        self._density = np.square(walks)
        self._gyro_scale = (1e-6 * imu.gyro_scale_sigma_ppm) ** 2
        self._turning = (0.0, 0.0, 0.0)
        self._spin = ins.spin
        self._begin(ins)

    def _begin(self, ins):
        """Begin a step of the covariance."""
        self._start = (ins.q_nb, ins.v)
        self._steps, self._time_s, self._force = 0, 0.0, (0.0, 0.0, 0.0)

    def step(self, ins, before, u, dt):
        """Sum the force; every covariance_every steps propagate the covariance."""
        super().step(ins, before, u, dt)
        f = self._force
        self._force = (f[0] + u[0], f[1] + u[1], f[2] + u[2])
        self._time_s += dt
        self._steps += 1
        if self._steps >= self._settings.covariance_every:
            self._propagate(ins)

    def _propagate(self, ins):
        if not self._steps:
            return
        q_start, v_start = self._start
        dt = self._time_s
        q_mid = middle(q_start, ins.q_nb)
        f_n = quaternion.rotate(q_mid, tuple(x / dt for x in self._force))
        v = tuple(0.5 * (a + b) for a, b in zip(v_start, ins.v))
        c = matrix.matrix(q_mid)
        phi = model.transition(model.dynamics(ins.lat, ins.height, v, c, f_n, self._spin), dt)
        half = np.diag(0.5 * dt * (self._density + self._of_turns(ins, dt)))
        p = phi @ (self.covariance + half) @ phi.T + half
        if self._altimeter:
            for k, variance in zip(model.DOWN, self._held):
                p[k, :] = p[:, k] = 0.0
                p[k, k] = variance
        self.covariance = 0.5 * (p + p.T)
        self._begin(ins)

    def _of_turns(self, ins, dt):
        """
        Return the density of what scale factors and axes of the gyros add to the tilt, (20,).

        They are constant, and no states: white noise that after TURN_S at a rate is as large.
        The rate is smoothed, as a weave takes back what it adds.  The azimuth is left out, for
        its sigma is large beside that, and a turn back takes it back.
        """
        density = np.zeros(model.SIZE)
        if self._gyro_scale:
            turned = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(self._start[0]),
                                                              ins.q_nb))
            part = min(1.0, dt / SMOOTHING_S)
            self._turning = tuple(w + part * (x / dt - w) for w, x in zip(self._turning, turned))
            density[model.TILT] = self._gyro_scale * TURN_S * sum(w * w for w in self._turning)
        return density

    def velocity(self, ins, fix):
        """Update with a fix whose window ends now; forget the window's eta."""
        self._propagate(ins)
        read, h = model.meter_matrix(self.mean.value, *self.estimates, self.mean.time_s)
        return self._update(ins, read - fix.velocity, h, np.diag(np.square(fix.sigma)))

    def gnss(self, ins, fix, rate, lever):
        """
        Update with a GNSS fix of now or at most one step ago.

        rate: of b relative to the Earth, in b, rad/s; lever: of the antenna in b, m.
        """
        self._propagate(ins)
        c = matrix.matrix(ins.q_nb)
        ago = (ins.t_ns - fix.t_ns) * 1e-9
        east, north, up = position_error(ins.lat, ins.lon, ins.height, fix.lat, fix.lon,
                                         fix.height)
        arm, speed = c @ lever, c @ np.cross(rate, lever)
        z = np.concatenate([(east, north, up) + arm - ago * np.array(ins.v),
                            np.array(ins.v) + speed - fix.v_n])
        h = model.gnss_matrix(c, np.array(lever), np.array(rate))
        r = np.square((*fix.position_sigma, *fix.velocity_sigma))
        if self._altimeter:
            level = [0, 1, 3, 4]
            z, h, r = z[level], h[level], r[level]
        return self._update(ins, z, h, np.diag(r))

    def _update(self, ins, z, h, r):
        s, gain = kalman.innovation(self.covariance, h, r)
        nis = kalman.normalised_square(z, s)
        innovation = tuple(z.tolist())
        if kalman.tail(nis, len(z)) < self._settings.gate_probability:
            return FixOutcome(innovation, nis, len(z), False, GATE)
        self.covariance = kalman.joseph(self.covariance, h, r, gain)
        self._correct(ins, (gain @ z).tolist())
        return FixOutcome(innovation, nis, len(z))

    def _correct(self, ins, x):
        """Take the estimated errors off; what eta was is seen in the mean velocity no more."""
        ins.correct(x[0:3], x[3:6], x[6:9])
        ins.add_biases(gyro=tuple(-b for b in x[12:15]), accelerometer=tuple(-b for b in x[9:12]))
        self.estimates = tuple(a - b for a, b in zip(self.estimates, x[17:20]))
        self.mean.shift(x[15], x[16])
        self._begin(ins)

    def close(self):
        """Begin a window: eta is zero, and independent of all."""
        super().close()
        p = self.covariance.copy()
        p[model.ETA, :] = p[:, model.ETA] = 0.0
        p[15, 15] = p[16, 16] = FLOOR[15] ** 2
        self.covariance = p

    @property
    def healthy(self):
        """Return whether the covariance is one."""
        return kalman.is_covariance(self.covariance)

    def sigmas(self):
        """Return the standard deviations of position, velocity and attitude, ENU."""
        s = np.sqrt(np.diagonal(self.covariance)).tolist()
        return tuple(s[0:3]), tuple(s[3:6]), tuple(s[6:9])

    def estimate_sigmas(self):
        """Return the standard deviations of mu, kx, kz."""
        return tuple(np.sqrt(np.diagonal(self.covariance)[17:20]).tolist())
