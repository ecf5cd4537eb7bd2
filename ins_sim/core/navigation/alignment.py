"""
Coarse self-alignment at a standstill: level from gravity, heading from the rate of the Earth.

TRIAD of two vectors that are known in n (Black, AIAA Journal 2, 1964; Groves, 2nd ed., section
5.6): up, the specific force at rest, and the rate of the Earth, whose cross product with up
points East.  A force bias b tilts by b / g; a rate bias along East turns by it over
Omega cos(lat); a tilt about North turns by tan(lat) times it.
"""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.attitude import matrix, quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.elementary import sincos
from ins_sim.core.numerics.fixed_order import dot, length
from ins_sim.core.numerics.units import DEG_PER_HOUR

# A vehicle that stands is not tilted by more, deg.
UPRIGHT_DEG = 45.0
TILTED = ('no vehicle stands so: is the IMU mounted turned? (mounting.rpy_deg, or mounting.source '
          'level) Or does it measure gravity instead of specific force, which points up at rest?')


@dataclass(frozen=True)
class Gyrocompass:
    """
    A gyrocompassing.

    q_nb, None where the mean rate is parallel to up; sigma: standard error of the heading from
    the noise of the rate and from the bias of the gyros, rad; noise_sigma: that from the noise
    alone; excess: length of the mean rate less that of the Earth, rad/s;
    excess_up: the same of its part along up; both are the bias of the gyros, as far as it can
    be seen; bias_sigma: standard deviation of it that was assumed, rad/s.
    """

    q_nb: tuple
    sigma: float
    noise_sigma: float
    excess: float
    excess_up: float
    bias_sigma: float

    def describe(self):
        """Return what was found, and of what its standard error is made."""
        return (f'standard error {math.degrees(self.sigma):.3g} deg, by noise '
                f'{math.degrees(self.noise_sigma):.3g} deg and by the bias of '
                f'{self.bias_sigma * DEG_PER_HOUR:.3g} deg/h of alignment.gyro_bias_sigma_deg_h; '
                f'mean rate {self.excess * DEG_PER_HOUR:+.3g} deg/h from that of the Earth')


def gyrocompass(still, lat, bias_sigma=0.0):
    """
    Return the Gyrocompass of a Standstill at a latitude, rad.

    bias_sigma: standard deviation of the bias of the gyros, rad/s.  Its part along East turns the
    heading and cannot be seen at a standstill.
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
    """Return the level (North) and upward rate of the Earth, rad/s."""
    s, c = sincos(lat)
    return rate * c, rate * s


def is_trusted(compass, still, lat, sigma):
    """
    Return whether a Gyrocompass can be believed to within sigma, rad.

    Its standard error must not exceed sigma; nor may the bias that shows in length or upward part
    of the mean rate, beyond three standard errors, be one that turns the heading by more.
    """
    allowed = sigma * _spin(lat)[0] + 3.0 * length(still.rate_error)
    return compass.sigma <= sigma and max(abs(compass.excess), abs(compass.excess_up)) <= allowed


def trusted_gyrocompass(still, lat, limits):
    """
    Return the Gyrocompass of a Standstill if it is to be taken, else None, and why not.

    lat: rad; limits: AlignmentSettings.
    """
    compass = gyrocompass(still, lat, limits.gyro_bias_sigma_deg_h / DEG_PER_HOUR)
    if is_trusted(compass, still, lat, math.radians(limits.heading_sigma_deg)):
        return compass, ''
    return None, (f'the gyros are too coarse to see the Earth turn ({compass.describe()}; '
                  f'expected at most {limits.heading_sigma_deg:g} deg)')


def level_attitude(force, heading):
    """
    Return q_nb of a mean specific force (3,) at rest and a heading, clockwise, rad.

    Raises ValueError where the forward axis is vertical, so that it has no heading.
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
    """Return q_nb of the unit vectors East and up in b."""
    return matrix.quaternion_of((*east.tolist(), *np.cross(up, east).tolist(),
                                 *up.tolist()))


def gyro_bias(still, q_nb, lat, spin):
    """Return the mean rate less that of the Earth, (3,) rad/s, of a Standstill; spin: rad/s."""
    earth_b = quaternion.rotate_back(q_nb, (0.0, *_spin(lat, spin)))
    return still.rate - np.array(earth_b)


def bias_sentence(bias):
    """Return the sentence on a gyro bias (3,), rad/s, that is taken off."""
    text = ', '.join(f'{b * DEG_PER_HOUR:.4g}' for b in bias)
    return f'gyro bias of the standstill taken off: {text} deg/h in base_link'
