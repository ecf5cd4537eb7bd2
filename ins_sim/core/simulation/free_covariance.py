"""The FreeCovariance of a strapdown, from its settings."""

import math

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.free_covariance import FreeCovariance
from ins_sim.core.navigation.vertical_channel import damping
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.error_sigmas import fixed_errors, triad_sigmas


def sigmas_of(settings):
    """Return the TriadSigmas of gyros and accelerometers of StrapdownSettings."""
    dt_s = period_ns(settings.rate_hz) * 1e-9
    return (triad_sigmas(settings.gyro.errors, dt_s, 'gyro.errors'),
            triad_sigmas(settings.accelerometer.errors, dt_s, 'accelerometer.errors'))


def free_covariance(settings, seen=None):
    """
    Return the FreeCovariance of StrapdownSettings: of its initial errors and its instruments.

    seen: as of FreeCovariance.  Raises ValueError where the figures of the instruments are none.
    """
    initial, channel = settings.initial, settings.vertical.channel
    gyro, accelerometer = sigmas_of(settings)
    tilt, azimuth = 1e-3 * initial.tilt_sigma_mrad, 1e-3 * initial.azimuth_sigma_mrad
    errors = (*initial.position_error_m, *initial.velocity_error_m_s,
              *map(math.radians, initial.attitude_error_deg))
    sigmas = ((initial.position_sigma_m,) * 3 + (initial.velocity_sigma_m_s,) * 3
              + (tilt, tilt, azimuth))
    variances = (*np.square(sigmas).tolist(), *accelerometer.bias, *gyro.bias, *accelerometer.scale, *gyro.scale, *accelerometer.misalignment,
                 *gyro.misalignment)
    densities = ((0.0,) * 3 + accelerometer.white + gyro.white + accelerometer.walk + gyro.walk
                 + (0.0,) * 12)
    return FreeCovariance(
        variances, densities, errors,
        (fixed_errors(settings.accelerometer.errors), fixed_errors(settings.gyro.errors)), ellipsoid.rotation_rate(settings.earth.rotation),
        channel == 'truth',
        damping(settings.vertical.time_constant_s)[:2] if channel == 'damped' else (0.0, 0.0),
        period_ns(settings.rate_hz) * 1e-9, seen)
