"""The covariance of a strapdown according to its settings, and the published part of it."""

import math
from typing import NamedTuple

import numpy as np

from ins_sim.core.attitude.matrix import attitude_matrix, skew
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.navigation.error_dynamics import GROWING, turn_by_position
from ins_sim.core.navigation.free_covariance import BG, FreeCovariance
from ins_sim.core.navigation.vertical_channel import damping
from ins_sim.core.numerics.fixed_order import product
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.error_sigmas import fixed_errors, triad_sigmas

# Even for sensors without noise, IMU messages may state variances up to these, (rad/s)^2 and
# (m/s^2)^2.
ALMOST_EXACT = 1e-11, 1e-9


def sigmas_of(settings):
    """Return the TriadSigmas of gyros and accelerometers of StrapdownSettings."""
    dt_s = period_ns(settings.rate_hz) * 1e-9
    return (triad_sigmas(settings.gyro.errors, dt_s, 'gyro.errors'),
            triad_sigmas(settings.accelerometer.errors, dt_s, 'accelerometer.errors'))


class StartSigmas(NamedTuple):
    """
    Standard deviations at the start.

    Attributes
    ----------
    position, velocity : of each axis, m and m/s
    tilt, azimuth : of each tilt and of the azimuth, rad
    gyro_bias : of each axis, rad/s, or None to use the settings

    """

    position: float
    velocity: float
    tilt: float
    azimuth: float
    gyro_bias: float | None = None


def initial_sigmas(initial):
    """Return the StartSigmas from the settings of the initial state."""
    return StartSigmas(initial.position_sigma_m, initial.velocity_sigma_m_s,
                       1e-3 * initial.tilt_sigma_mrad, 1e-3 * initial.azimuth_sigma_mrad)


def free_covariance(settings, show=None, start=None, dt_s=None):
    """
    Return the FreeCovariance of StrapdownSettings, from initial errors and instrument errors.

    Parameters
    ----------
    settings : StrapdownSettings
    show : see FreeCovariance
    start : StartSigmas, by default from the settings
    dt_s : sampling period, s, by default from rate_hz

    Raises
    ------
    ValueError : if the instrument parameters are invalid

    """
    initial, channel = settings.initial, settings.vertical.channel
    gyro, accelerometer = sigmas_of(settings)
    start = start or initial_sigmas(initial)
    position, velocity, tilt, azimuth, bias = start
    gyro_bias = gyro.bias if bias is None else (bias * bias,) * 3
    errors = (*initial.position_error_m, *initial.velocity_error_m_s,
              *map(math.radians, initial.attitude_error_deg))
    sigmas = (position,) * 3 + (velocity,) * 3 + (tilt, tilt, azimuth)
    variances = (*np.square(sigmas).tolist(), *accelerometer.bias, *gyro_bias,
                 *accelerometer.scale, *gyro.scale, *accelerometer.misalignment,
                 *gyro.misalignment)
    densities = ((0.0,) * 3 + accelerometer.white + gyro.white + accelerometer.walk + gyro.walk
                 + (0.0,) * 12)
    return FreeCovariance(
        variances, densities, errors,
        (fixed_errors(settings.accelerometer.errors), fixed_errors(settings.gyro.errors)),
        ellipsoid.rotation_rate(settings.earth.rotation), channel == 'truth',
        damping(settings.vertical.time_constant_s)[:2] if channel == 'damped' else (0.0, 0.0),
        dt_s or period_ns(settings.rate_hz) * 1e-9, show)


def disagreement(settings, stated):
    """
    Return how the noise of an IMU differs from that in StrapdownSettings, or ''.

    stated: variances of a sample by axis that the messages of the IMU state, (rad/s)^2 and
    (m/s^2)^2. They disagree if the standard deviations differ by a factor of two or more.
    """
    for unit, name, said, known, least in zip(('rad/s', 'm/s^2'), ('gyro', 'accelerometer'),
                                              stated, sigmas_of(settings), ALMOST_EXACT):
        for axis, one, other in zip('xyz', said, known.sample):
            if max(one, other) > least and not 0.25 * one <= other <= 4.0 * one:
                return (f'imu/data_raw states a noise of {math.sqrt(max(0.0, one)):.3g} {unit} '
                        f'per sample on axis {axis}, and {name}.errors of strapdown have '
                        f'{math.sqrt(other):.3g} {unit}; expected the values of this IMU: '
                        'otherwise the covariances of ins/* are wrong')
    return ''


class PublishedCovariance(NamedTuple):
    """
    The published part of a FreeCovariance, tuples of floats; valid from t_ns until the next one.

    All but ``rate`` include the square of the error that is the same in every run.

    Attributes
    ----------
    t_ns : instant from which it is valid, ns
    pose : (36,) covariance of position (m) and attitude (rad) about the axes of map, row by row
    velocity : (9,) covariance of the velocity that is published in b, resolved in n, (m/s)^2
    rate : (9,) covariance of the angular velocity in b, (rad/s)^2
    place : (9,) covariance of the position in east, north, up, m^2

    """

    t_ns: int
    pose: tuple
    velocity: tuple
    rate: tuple
    place: tuple


def published_covariance(settings, frame=None, start=None, dt_s=None):
    """
    Return a FreeCovariance of StrapdownSettings whose ``shown`` is a PublishedCovariance.

    frame: MapFrame, by default that of the datum; other arguments: see ``free_covariance``.
    """
    frame = frame or MapFrame(settings.datum, settings.earth.rotation)
    gyro, _ = sigmas_of(settings)
    sample = np.diag(gyro.sample)

    def show(free):
        lat, lon, height, v, _ = free.solution
        p = free.p[:GROWING, :GROWING] + np.multiply.outer(free.mean, free.mean)
        turn = np.eye(GROWING)
        turn[6, 1], turn[7, 0], turn[8, 0] = turn_by_position(lat, height)
        c = attitude_matrix(frame.q_mn(lat, lon))
        pose = np.zeros((6, GROWING))
        pose[:3] = product(c, turn[:3])
        pose[3:] = product(c, turn[6:])
        # An attitude error phi changes the velocity in b by v x phi.
        velocity = np.concatenate([np.zeros((3, 3)), np.eye(3), skew(v)], axis=1)
        return PublishedCovariance(free.t_ns, _carried(pose, p), _carried(velocity, p),
                                   tuple((free.p[BG, BG] + sample).ravel().tolist()),
                                   tuple(p[:3, :3].ravel().tolist()))

    return free_covariance(settings, show, start, dt_s)


def _carried(a, p):
    """Return A P A', symmetric, row by row."""
    found = product(product(a, p), a.T)
    return tuple((0.5 * (found + found.T)).ravel().tolist())
