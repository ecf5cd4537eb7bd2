"""The paper's measurement in a Kalman filter of eight states, one step a window."""

import math

import numpy as np

from ins_sim.core.numerics.units import STANDARD_GRAVITY, UG
from .. import kalman
from .base import FixOutcome
from .fixed_gain import MatrixFilter

# what is known exactly still has a variance, so that the covariance stays positive definite
FLOOR = 1e-6
# the acceleration error in b drifts by Schuler's tilt and the gyros, here a random walk,
# m/s^2/sqrt(s); the offsets of the instrument by what the turns of its axes leave, m/s/sqrt(s)
ACCELERATION_WALK = 4e-5
OFFSET_WALK = 1e-3


class WindowFilter(MatrixFilter):
    """
    States dp (E, N), dV (E, N), dW (forward, left), c (forward, left); spec section 4.

    Over a window: dp += T dV + A2 dW, dV += A1 dW; measured z = B1 dV + B2 dW + c, dV being that
    at the start of the window.  The offset c also stands for the error of the azimuth times the
    velocity.  What is estimated of dp, dV, dW is taken off the strapdown after each window.
    """

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        initial, model, meter = settings.initial, settings.imu_model, settings.meter_model
        speed = max(1.0, math.hypot(*ins.v[:2]))
        tilt = 1e-3 * initial.tilt_sigma_mrad * STANDARD_GRAVITY
        w = math.hypot(tilt, model.accelerometer_bias_sigma_ug * UG)
        cross = math.hypot(1e-3 * initial.azimuth_sigma_mrad,
                           math.radians(meter.mounting_sigma_arcmin / 60.0))
        sigmas = ([initial.position_sigma_m] * 2 + [initial.velocity_sigma_m_s] * 2 + [w] * 2
                  + [speed * meter.scale_x_sigma, speed * cross])
        self.covariance = np.diag(np.maximum(np.array(sigmas), FLOOR) ** 2)
        self._noise = np.array([0.0] * 4 + [ACCELERATION_WALK ** 2] * 2 + [OFFSET_WALK ** 2] * 2)
        self._walk = (model.velocity_random_walk_m_s_sqrt_h / 60.0) ** 2
        self._tilt = tilt
        self._offset = (0.0, 0.0)
        self._propagated, self._turned = False, 0.0

    def step(self, ins, before, u, dt):
        """Sum up the window."""
        super().step(ins, before, u, dt)
        self._turned += ins.rate[2] * dt

    def velocity(self, ins, fix):
        """Update at the start of the window, go to its end, and correct the strapdown there."""
        t = self.mean.time_s
        a1, a2, b1, b2 = self.integrals.matrices
        z = np.subtract(self._residual(fix), self._offset)
        h = np.hstack([np.zeros((2, 2)), b1, b2, np.eye(2)])
        r = np.diag(np.square(fix.sigma))
        s, gain = kalman.innovation(self.covariance, h, r)
        nis = kalman.normalised_square(z, s)
        if kalman.tail(nis, 2) < self._settings.gate_probability:
            self._propagate(t, a1, a2)
            return FixOutcome(tuple(z.tolist()), nis, 2, False,
                              'its innovation is beyond the gate')
        x = gain @ z
        self.covariance = kalman.joseph(self.covariance, h, r, gain)
        self._propagate(t, a1, a2)
        dp = x[:2] + t * x[2:4] + a2 @ x[4:6]
        dv = x[2:4] + a1 @ x[4:6]
        ins.correct(position=(*dp.tolist(), 0.0), velocity=(*dv.tolist(), 0.0))
        ins.add_biases(accelerometer=(*x[4:6].tolist(), 0.0))
        self._offset = tuple((self._offset + x[6:8]).tolist())
        return FixOutcome(tuple(z.tolist()), nis, 2)

    def _propagate(self, t, a1, a2):
        phi = np.eye(8)
        phi[0:2, 2:4] = t * np.eye(2)
        phi[0:2, 4:6] = a2
        phi[2:4, 4:6] = a1
        q = self._noise * t
        # the part of dW that is tilt stands in n, and turns in b
        q[4:6] += (self._tilt * self._turned) ** 2
        self._turned = 0.0
        q[2:4] += self._walk * t
        q[0:2] += self._walk * t ** 3 / 3.0
        self.covariance = phi @ self.covariance @ phi.T + np.diag(q)
        self._propagated = True

    def close(self):
        """Begin a window; without a fix the covariance goes to its end all the same."""
        if not self._propagated and self.mean.time_s:
            a1, a2, _, _ = self.integrals.matrices
            self._propagate(self.mean.time_s, a1, a2)
        self._propagated = False
        super().close()

    @property
    def healthy(self):
        """Return whether the covariance is one."""
        return kalman.is_covariance(self.covariance)

    def sigmas(self):
        """Return the standard deviations of position, velocity and attitude (not estimated)."""
        e, n, ve, vn = np.sqrt(np.diagonal(self.covariance)[:4]).tolist()
        return (e, n, 0.0), (ve, vn, 0.0), (0.0, 0.0, 0.0)
