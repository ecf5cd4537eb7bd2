"""
Coarse self-alignment at a standstill: level from gravity, heading from the rate of the Earth.

TRIAD with two vectors that are known in the local level frame n (Black, AIAA Journal 2, 1964;
Groves, 2nd ed., section 5.6): the specific force at rest, which points up, and the rate of the
Earth, whose cross product with up points east.

Errors: an accelerometer bias b tilts the attitude by b / g. A gyro bias b along east turns the
heading by b / (Omega cos(lat)). A tilt about north turns the heading by tan(lat) times the tilt.
"""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.attitude import matrix, quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.elementary import sincos
from ins_sim.core.numerics.fixed_order import dot, length
from ins_sim.core.numerics.units import DEG_PER_HOUR

# Largest tilt at a standstill that is accepted without asking, deg.
UPRIGHT_DEG = 45.0
TILTED = ('a vehicle rarely stands like this. Is the IMU mounted rotated? Then set '
          'mounting.rpy_deg, or mounting.source level. Or does the IMU measure gravity instead of '
          'specific force, which points up at rest?')


@dataclass(frozen=True)
class Gyrocompass:
    """
    Result of a gyrocompass alignment.

    Attributes
    ----------
    q_nb : attitude, or None if the mean rate is parallel to up
    sigma : standard error of the heading due to the gyro noise and the gyro bias, rad
    noise_sigma : part of sigma due to the gyro noise alone, rad
    excess : length of the mean rate minus the rate of the Earth, rad/s
    excess_up : component of the mean rate along up minus that of the Earth rate, rad/s. Both
        excesses show the part of the gyro bias that is observable at a standstill.
    bias_sigma : assumed standard deviation of the gyro bias, rad/s

    """

    q_nb: tuple
    sigma: float
    noise_sigma: float
    excess: float
    excess_up: float
    bias_sigma: float

    def describe(self):
        """Return a phrase with the standard error, its contributions and the rate excess."""
        return (f'standard error {math.degrees(self.sigma):.3g} deg, from noise of '
                f'{math.degrees(self.noise_sigma):.3g} deg and a gyro bias of '
                f'{self.bias_sigma * DEG_PER_HOUR:.3g} deg/h (alignment.gyro_bias_sigma_deg_h); '
                f'mean rate minus rate of the Earth {self.excess * DEG_PER_HOUR:+.3g} deg/h')


def gyrocompass(still, lat, bias_sigma=0.0):
    """
    Find the attitude at a standstill by gyrocompassing.

    The gyro bias along east turns the heading and cannot be observed at a standstill; its assumed
    standard deviation therefore enters the standard error.

    Parameters
    ----------
    still : Standstill, with the mean specific force and the mean rate
    lat : latitude, rad
    bias_sigma : standard deviation of the gyro bias, rad/s

    Returns
    -------
    Gyrocompass

    """
    up = still.force / length(still.force)
    east = np.cross(still.rate, up)
    level = length(east)
    spin_level, spin_up = _spin(lat)
    q_nb, sigma, noise = None, math.inf, math.inf
    if level > 0.0:
        east /= level
        q_nb = _attitude(east, up)
        noise = length(still.rate_error * east) / spin_level
        by_bias = bias_sigma / spin_level
        sigma = math.sqrt(noise * noise + by_bias * by_bias)
    return Gyrocompass(q_nb, sigma, noise, length(still.rate) - ellipsoid.ROTATION_RATE,
                       dot(still.rate, up) - spin_up, bias_sigma)


def _spin(lat, rate=ellipsoid.ROTATION_RATE):
    """Return the components of the rate of the Earth along north and up, rad/s."""
    s, c = sincos(lat)
    return rate * c, rate * s


def is_trusted(compass, still, lat, sigma):
    """
    Return whether the heading of a Gyrocompass is reliable to within sigma, rad.

    Two conditions must hold. The standard error must not exceed sigma. The gyro bias visible in
    ``excess`` and ``excess_up``, minus three standard errors of the rate, must be too small to
    turn the heading by more than sigma.
    """
    allowed = sigma * _spin(lat)[0] + 3.0 * length(still.rate_error)
    return compass.sigma <= sigma and max(abs(compass.excess), abs(compass.excess_up)) <= allowed


def trusted_gyrocompass(still, lat, limits):
    """
    Return the Gyrocompass of a Standstill, or None and the reason if it is not reliable.

    lat: latitude, rad; limits: AlignmentSettings.
    """
    compass = gyrocompass(still, lat, limits.gyro_bias_sigma_deg_h / DEG_PER_HOUR)
    if is_trusted(compass, still, lat, math.radians(limits.heading_sigma_deg)):
        return compass, ''
    return None, ('the gyros are too coarse to measure the rotation of the Earth '
                  f'({compass.describe()}; expected at most {limits.heading_sigma_deg:g} deg)')


def level_attitude(force, heading):
    """
    Return q_nb from a mean specific force at rest and a heading.

    Parameters
    ----------
    force : (3,) mean specific force in b, m/s^2
    heading : clockwise from north, rad

    Raises
    ------
    ValueError : if the forward axis is within about 1 deg of the vertical, where heading is
        undefined

    """
    up = force / length(force)
    forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
    size = length(forward)
    if size < 0.02:
        raise ValueError('the forward axis is within 1 deg of the vertical, so that it has no '
                         'heading; expected another mounting (mounting.source, '
                         'mounting.rpy_deg)')
    forward /= size
    right = np.cross(forward, up)
    s, c = sincos(heading)
    return _attitude(s * forward + c * right, up)


def _attitude(east, up):
    """Return q_nb from the unit vectors east and up, both resolved in b."""
    return matrix.quaternion_of((*east.tolist(), *np.cross(up, east).tolist(),
                                 *up.tolist()))


def gyro_bias(still, q_nb, lat, spin):
    """Return the mean rate of a Standstill minus that of the Earth (spin, rad/s), (3,) rad/s."""
    earth_b = quaternion.rotate_back(q_nb, (0.0, *_spin(lat, spin)))
    return still.rate - np.array(earth_b)


def bias_sentence(bias):
    """Return the sentence that reports a gyro bias (3,), rad/s, subtracted from the readings."""
    text = ', '.join(f'{b * DEG_PER_HOUR:.4g}' for b in bias)
    return f'gyro bias at standstill subtracted: {text} deg/h in base_link'
