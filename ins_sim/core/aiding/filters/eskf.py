"""The error-state Kalman filter of the aided navigator; its linear model is `eskf_model`."""

import numpy as np

from ins_sim.core.attitude import matrix, quaternion
from ins_sim.core.attitude.interpolation import middle_attitude
from ins_sim.core.navigation.error_dynamics import change
from ins_sim.core.navigation.errors import position_error
from ins_sim.core.numerics.fixed_order import applied
from ins_sim.core.numerics.units import DEG, DEG_H, SQRT_H, UG
from . import eskf_model as model
from .. import kalman
from .base import AidingFilter, FixOutcome

# Smallest standard deviations: quantities that are known exactly get them too, so that the
# covariance stays positive definite (m, m/s, rad, m/s^2, rad/s, m; mounting rad, scale errors).
FLOOR = np.array([1e-3] * 3 + [1e-5] * 3 + [1e-8] * 3 + [1e-9] * 3 + [1e-12] * 3 + [1e-9] * 2
                 + [1e-9, 1e-9, 1e-9])
# The diagonal in a matrix stored row by row.
DIAGONAL = slice(None, None, model.SIZE + 1)
GATE = 'its innovation is beyond the gate'
# Duration of a typical turn, and time constant of the smoothing of the rate, s.
TURN_S, SMOOTHING_S = 50.0, 10.0


class ErrorStateFilter(AidingFilter):
    """
    Error-state Kalman filter with twenty states (docs/theory/aided_navigation.md).

    The strapdown is corrected after every fix, so that the estimated error state is zero between
    fixes. The measurement of the velocity meter is compared with the mean over its window of the
    fixes. The measurement of the velocity meter is compared with the mean, over its window, of
    the velocity in b, which is exact for any motion within the window; the state eta holds the
    """

    needs = ('force',)
    states = model.STATES

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        initial, imu, meter = settings.initial, settings.imu_model, settings.meter_model
        self._altimeter = settings.vertical.channel == 'altimeter'
        self._held = np.square((settings.vertical.height_sigma_m,
                                settings.vertical.velocity_sigma_m_s)).tolist()
        tilt = 1e-3 * initial.tilt_sigma_mrad
        sigmas = ([initial.position_sigma_m] * 2 + [settings.vertical.height_sigma_m]
                  + [initial.velocity_sigma_m_s] * 2 + [settings.vertical.velocity_sigma_m_s]
                  + [tilt, tilt, 1e-3 * initial.azimuth_sigma_mrad]
                  + [imu.accelerometer_bias_sigma_ug * UG] * 3
                  + [imu.gyro_bias_sigma_deg_h * DEG_H] * 3 + [0.0, 0.0]
                  + [meter.mounting_sigma_arcmin * DEG / 60.0, meter.scale_x_sigma,
                     meter.scale_z_sigma])
        self.covariance = np.diag(np.square(np.maximum(sigmas, FLOOR)))
        walks = ([0.0] * 3 + [imu.velocity_random_walk_m_s_sqrt_h / SQRT_H] * 3
                 + [imu.angle_random_walk_deg_sqrt_h * DEG / SQRT_H] * 3
                 + [imu.accelerometer_bias_walk_ug_sqrt_h * UG / SQRT_H] * 3
                 + [imu.gyro_bias_walk_deg_h_sqrt_h * DEG_H / SQRT_H] * 3 + [0.0] * 5)
        self._density = np.square(walks)
        # States that are known exactly at the start and stay so. Position and attitude do not.
        exact = [not s and not w for s, w in zip(sigmas[model.BA.start:], walks[model.BA.start:])]
        self.given = (*(model.STATES[k] for k in model.DOWN if self._altimeter),
                      *(name for name, known in zip(model.STATES[model.BA.start:], exact)
                        if known))
        self._every = settings.covariance_every
        scale = 1e-6 * imu.gyro_scale_sigma_ppm
        self._gyro_scale = scale * scale
        self._turning = (0.0, 0.0, 0.0)
        self._spin = ins.spin
        self._begin(ins)

    def _begin(self, ins):
        """Begin an interval of the covariance propagation."""
        self._start = (ins.q_nb, ins.v)
        self.clear('force')

    def samples_left(self):
        """Return how many samples remain until the covariance is propagated."""
        return self._every - self.sums[-1][0]

    def pause(self, ins):
        """Propagate the covariance over the samples since the last propagation."""
        steps, dt, _ = self.window.force
        if not steps:
            return
        half = self._density.copy()
        half[model.TILT] += self._of_turns(ins, dt)
        half *= 0.5 * dt
        p = self.covariance.copy()
        p.reshape(-1)[DIAGONAL] += half
        p = model.propagated(p, self._change(ins))
        p.reshape(-1)[DIAGONAL] += half
        if self._altimeter:
            for k, variance in zip(model.DOWN, self._held):
                p[k, :] = p[:, k] = 0.0
                p[k, k] = variance
        self.covariance = 0.5 * (p + p.T)
        self._begin(ins)

    def transition(self, ins):
        """Return the transition matrix over the samples since the last propagation, (20, 20)."""
        return model.transition(self._change(ins))

    def _change(self, ins):
        q_start, v_start = self._start
        _, dt, (f_x, f_y, f_z) = self.window.force
        q_mid = middle_attitude(q_start, ins.q_nb)
        f_n = quaternion.rotate(q_mid, (f_x / dt, f_y / dt, f_z / dt))
        v = tuple(0.5 * (a + b) for a, b in zip(v_start, ins.v))
        return change(model.dynamics(ins.lat, ins.height, v, matrix.dcm_of(q_mid), f_n,
                                     self._spin), dt)

    def _of_turns(self, ins, dt):
        """
        Return the tilt noise density that represents gyro scale factor and misalignment errors.

        These errors are constant, but they are not states of the filter. They are replaced by
        white noise of the tilt that has the same effect after a turn of TURN_S at the present
        rate. The rate is smoothed, because the errors of a weave cancel. The azimuth gets no such
        noise: its standard deviation is large in comparison, and the error of a turn cancels in
        the turn back.
        """
        if not self._gyro_scale:
            return 0.0
        turned = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(self._start[0]),
                                                          ins.q_nb))
        part = min(1.0, dt / SMOOTHING_S)
        x, y, z = self._turning = tuple(w + part * (angle / dt - w)
                                        for w, angle in zip(self._turning, turned))
        return self._gyro_scale * TURN_S * (x * x + y * y + z * z)

    def velocity_model(self, ins, fix):
        """Return the innovation of the velocity meter and its matrix."""
        read, h = model.meter_matrix(self.mean.value, *self.estimates, self.mean.time_s)
        return read - fix.velocity, h

    def update_velocity(self, ins, fix):
        """Update with a fix whose window ends now."""
        self.pause(ins)
        return self._update(ins, *self.velocity_model(ins, fix), np.square(fix.sigma))

    def update_gnss(self, ins, fix, rate, lever):
        """Update with a GNSS fix; with an altimeter its vertical components are not used."""
        self.pause(ins)
        z, h = self.gnss_model(ins, fix, rate, lever)
        variances = np.square((*fix.position_sigma, *fix.velocity_sigma))
        if self._altimeter:
            level = [0, 1, 3, 4]
            z, h, variances = z[level], h[level], variances[level]
        return self._update(ins, z, h, variances)

    def gnss_model(self, ins, fix, rate, lever):
        """Return the innovation of the antenna's position and velocity, and its matrix."""
        c = matrix.attitude_matrix(ins.q_nb)
        ago = (ins.t_ns - fix.t_ns) * 1e-9
        east, north, up = position_error(ins.lat, ins.lon, ins.height, fix.lat, fix.lon,
                                         fix.height)
        arm, speed = applied(c, lever), applied(c, quaternion.cross(rate, lever))
        z = np.concatenate([(east, north, up) + arm - ago * np.array(ins.v),
                            np.array(ins.v) + speed - fix.v_n])
        return z, model.gnss_matrix(c, np.array(lever), np.array(rate))

    def _update(self, ins, z, h, variances):
        r = np.diag(variances)
        s, gain = kalman.innovation(self.covariance, h, r)
        nis = kalman.normalised_square(z, s)
        innovation = tuple(z.tolist())
        if kalman.chi_square_tail(nis, len(z)) < self.settings.gate_probability:
            return FixOutcome(innovation, nis, len(z), False, GATE)
        self.covariance = kalman.joseph(self.covariance, h, r, gain)
        self.correct(ins, applied(gain, z).tolist())
        return FixOutcome(innovation, nis, len(z))

    def correct(self, ins, x):
        """Apply the estimated errors as corrections; that of eta shifts the mean velocity."""
        ins.correct(x[0:3], x[3:6], x[6:9])
        ins.add_biases(gyro=tuple(-b for b in x[12:15]), accelerometer=tuple(-b for b in x[9:12]))
        self.estimates = tuple(a - b for a, b in zip(self.estimates, x[17:20]))
        time_s, (forward, left) = self.mean
        self.replace('mean', (time_s, (forward - x[15], left - x[16])))
        self._begin(ins)

    def begin_window(self, ins):
        """Clear the window: eta becomes zero and uncorrelated with the other states."""
        super().begin_window(ins)
        p = self.covariance.copy()
        p[model.ETA, :] = p[:, model.ETA] = 0.0
        p[15, 15] = p[16, 16] = FLOOR[15] * FLOOR[15]
        self.covariance = p

    @property
    def healthy(self):
        """Return whether the covariance is positive definite."""
        return kalman.is_covariance(self.covariance)

    def sigmas(self):
        """Return the standard deviations of position, velocity and attitude, east, north, up."""
        s = np.sqrt(np.diagonal(self.covariance)).tolist()
        return tuple(s[0:3]), tuple(s[3:6]), tuple(s[6:9])

    def estimate_sigmas(self):
        """Return the standard deviations of the velocity meter's mounting and scale errors."""
        return tuple(np.sqrt(np.diagonal(self.covariance)[17:20]).tolist())
