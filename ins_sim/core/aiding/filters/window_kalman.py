"""Kalman filter of eight states with one step per window of the velocity meter."""

import math

import numpy as np

from ins_sim.core.numerics.fixed_order import applied, product
from ins_sim.core.numerics.units import STANDARD_GRAVITY, UG
from .. import kalman
from .base import FixOutcome
from .fixed_gain import MatrixFilter

# Smallest initial standard deviation: quantities that are known exactly get it too, so that the
# covariance stays positive definite.
FLOOR = 1e-6
# The acceleration error in b changes with the tilt (Schuler oscillation, gyro drift). It is
# modelled as a random walk, m/s^2/sqrt(s). So is the offset of the velocity meter, which changes
# when its axes turn, m/s/sqrt(s).
ACCELERATION_WALK = 4e-5
OFFSET_WALK = 1e-3


class WindowFilter(MatrixFilter):
    """
    The measurement of Ivanov (2015), made exact while turning, in a Kalman filter.

    States: position error dp and velocity error dV (East, North), acceleration error dW and
    offset c of the velocity meter (forward, left). Over a window of length T,
    dp += T dV + A2 dW and dV += A1 dW; measured is z = B1 dV + B2 dW + c with dV at the start of
    the window (docs/theory/aided_navigation.md). The offset c also contains the azimuth
    error times the velocity. The strapdown is corrected after each window.
    """

    needs = ('integrals', 'turned')
    states = ('position_e', 'position_n', 'velocity_e', 'velocity_n',
              'acceleration_x', 'acceleration_y', 'offset_x', 'offset_y')
    observed_at = 'start'
    # Coriolis acceleration and rotation of the level axes are neglected:
    # 2 x 7.3e-5 + V tan(lat) / R.
    neglected = 3e-4

    def __init__(self, settings, ins):
        super().__init__(settings, ins)
        initial, model, meter = settings.initial, settings.imu_model, settings.meter_model
        speed = max(1.0, _root_sum(*ins.v[:2]))
        tilt = 1e-3 * initial.tilt_sigma_mrad * STANDARD_GRAVITY
        w = _root_sum(tilt, model.accelerometer_bias_sigma_ug * UG)
        cross = _root_sum(1e-3 * initial.azimuth_sigma_mrad,
                          math.radians(meter.mounting_sigma_arcmin / 60.0))
        sigmas = ([initial.position_sigma_m] * 2 + [initial.velocity_sigma_m_s] * 2 + [w] * 2
                  + [speed * meter.scale_x_sigma, speed * cross])
        self.covariance = np.diag(np.square(np.maximum(sigmas, FLOOR)))
        self._noise = np.square([0.0] * 4 + [ACCELERATION_WALK] * 2 + [OFFSET_WALK] * 2)
        walk = model.velocity_random_walk_m_s_sqrt_h / 60.0
        self._walk = walk * walk
        self._tilt = tilt
        self._offset = (0.0, 0.0)
        self._propagated = False

    def velocity_model(self, ins, fix):
        """Return the innovation, and its derivative by the errors at the start of the window."""
        _, _, b1, b2 = self.matrices
        return (np.subtract(self.residual(fix), self._offset),
                np.hstack([np.zeros((2, 2)), b1, b2, np.eye(2)]))

    def update_velocity(self, ins, fix):
        """Estimate the errors at the start of the window; correct the strapdown at its end."""
        t = self.mean.time_s
        a1, a2, _, _ = self.matrices
        z, h = self.velocity_model(ins, fix)
        r = np.diag(np.square(fix.sigma))
        s, gain = kalman.innovation(self.covariance, h, r)
        nis = kalman.normalised_square(z, s)
        if kalman.chi_square_tail(nis, 2) < self.settings.gate_probability:
            self._propagate(ins)
            return FixOutcome(tuple(z.tolist()), nis, 2, False,
                              'its innovation is beyond the gate')
        x = applied(gain, z)
        self.covariance = kalman.joseph(self.covariance, h, r, gain)
        self._propagate(ins)
        dp = x[:2] + t * x[2:4] + applied(a2, x[4:6])
        dv = x[2:4] + applied(a1, x[4:6])
        self.correct(ins, np.concatenate([dp, dv, x[4:8]]))
        return FixOutcome(tuple(z.tolist()), nis, 2)

    def correct(self, ins, x):
        """Correct position, velocity, acceleration and the offset of the velocity meter."""
        x = np.asarray(x)
        ins.correct(position=(*x[0:2].tolist(), 0.0), velocity=(*x[2:4].tolist(), 0.0))
        ins.add_biases(accelerometer=(*x[4:6].tolist(), 0.0))
        self._offset = tuple((self._offset + x[6:8]).tolist())

    def transition(self, ins):
        """Return the transition matrix from the start of the window to the present."""
        a1, a2, _, _ = self.matrices
        phi = np.eye(8)
        phi[0:2, 2:4] = self.mean.time_s * np.eye(2)
        phi[0:2, 4:6] = a2
        phi[2:4, 4:6] = a1
        return phi

    def _propagate(self, ins):
        t, phi = self.mean.time_s, self.transition(ins)
        q = self._noise * t
        # The part of dW that is due to tilt is constant in n and therefore turns in b.
        turned = self._tilt * self.window.turned
        q[4:6] += turned * turned
        self.clear('turned')
        q[2:4] += self._walk * t
        q[0:2] += self._walk * (t * t * t) / 3.0
        self.covariance = product(product(phi, self.covariance), phi.T) + np.diag(q)
        self._propagated = True

    def begin_window(self, ins):
        """Propagate the covariance over the last window if there was no fix, and clear it."""
        if not self._propagated and self.mean.time_s:
            self._propagate(ins)
        self._propagated = False
        super().begin_window(ins)

    @property
    def healthy(self):
        """Return whether the covariance is positive definite."""
        return kalman.is_covariance(self.covariance)

    def sigmas(self):
        """Return standard deviations; 0 for quantities not estimated (vertical, attitude)."""
        e, n, ve, vn = np.sqrt(np.diagonal(self.covariance)[:4]).tolist()
        return (e, n, 0.0), (ve, vn, 0.0), (0.0, 0.0, 0.0)


def _root_sum(a, b):
    """Return the square root of the sum of the squares of two floats."""
    return math.sqrt(a * a + b * b)
