"""A start at rest, of a recorded IMU and of a live one: mounting, standstill, given state."""

from .field import setting, settings_class, SettingsGroup
from .place import HIGHEST_M


@settings_class
class MountingAngles(SettingsGroup):
    """How the IMU sits in the vehicle: the rotation from base_link to the frame of the IMU."""

    source: str = setting('auto', 'tf: /tf_static; given: rpy_deg; level: the shortest '
                          'turn that brings the mean specific force of the stationary interval '
                          'up, after it the yaw of rpy_deg; auto: given where rpy_deg is not '
                          'zero, else tf where it is there',
                          choices=('auto', 'tf', 'given', 'level'))
    rpy_deg: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'roll, pitch, yaw about the fixed axes '
                                         'x, y, z (URDF)', 'deg', -360.0, 360.0, size=3)


@settings_class
class GivenState(SettingsGroup):
    """A state; the values serve only where their source is "given"."""

    roll_deg: float = setting(0.0, 'right side down', 'deg', -180.0, 180.0)
    pitch_deg: float = setting(0.0, 'nose up', 'deg', -90.0, 90.0)
    heading_deg: float = setting(0.0, 'clockwise from true north', 'deg', -360.0, 360.0)
    velocity_m_s: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'East, North, Up', 'm/s', -1e4,
                                              1e4, size=3)
    latitude_deg: float = setting(0.0, 'geodetic latitude', 'deg', -89.9, 89.9)
    longitude_deg: float = setting(0.0, 'longitude', 'deg', -180.0, 180.0)
    height_m: float = setting(0.0, 'height above the WGS-84 ellipsoid', 'm', -500.0, HIGHEST_M)


@settings_class
class AlignmentSettings(SettingsGroup):
    """
    The search for a stationary interval and what is taken from it.

    The limits of a standstill are wide: engines may run.  They hold for the standard deviation
    within a window, mean of the three axes, and for what a window mean may differ from the
    mean of the interval.
    """

    window_s: float = setting(1.0, 'length of the windows whose variance is tested', 's', 0.01,
                              600.0)
    shortest_s: float = setting(5.0, 'shortest stationary interval', 's', 0.1, 1e5)
    longest_s: float = setting(60.0, 'length of it that is used, from its start', 's', 0.1, 1e5)
    force_sd_m_s2: float = setting(0.15, 'limit of a standstill, specific force', 'm/s^2', 0.0,
                                   100.0)
    rate_sd_rad_s: float = setting(0.03, 'limit of a standstill, angular rate', 'rad/s', 0.0,
                                   10.0)
    rate_rad_s: float = setting(0.1, 'limit of a standstill, mean angular rate', 'rad/s', 0.0,
                                10.0)
    gravity_m_s2: float = setting(2.0, 'what the mean specific force at rest may differ from '
                                  'gravity by; 1e3 navigates whatever it is', 'm/s^2', 0.0, 1e3)
    speed_m_s: float = setting(0.3, 'limit of a standstill, speed of the reference', 'm/s', 0.0,
                               100.0)
    heading_sigma_deg: float = setting(2.0, 'worst standard error with which gyrocompassing is '
                                       'trusted; the mean rate must agree with that of the '
                                       'Earth to the same measure', 'deg', 0.0, 90.0)
    gyro_bias_sigma_deg_h: float = setting(
        10.0, 'standard deviation of the bias of the gyros, which a gyrocompass takes for a part '
        'of the rate of the Earth: it turns the heading by bias / (15.04 cos(latitude)) rad. '
        '10 is assumed where nothing is known; navigation-grade gyros have 0.01', 'deg/h',
        0.0, 1e5)
    gyro_bias: str = setting('auto', 'subtract: the mean rate less the rate of the Earth, from '
                             'the stationary interval, is taken off every sample; keep; auto: '
                             'subtract after an alignment that could not gyrocompass',
                             choices=('auto', 'subtract', 'keep'))
    course_distance_m: float = setting(20.0, 'way the reference must have gone for its course',
                                       'm', 0.1, 1e5)
    course_search_s: float = setting(300.0, 'time within which it must have gone it', 's', 1.0,
                                     1e5)
