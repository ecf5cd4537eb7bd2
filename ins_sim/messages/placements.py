"""
Frames that each node publishes on TF, and the mounting of the sensors on the vehicle.

Frames have their default names here. Fixed transforms are (parent, child, pose) of /tf_static.
"""

import math

from ins_sim.core.attitude import quaternion
from . import topics
from .transforms import AT_PARENT

MAP, BASE = topics.TRUTH_ODOMETRY.frames
ODOM, _ = topics.INS_ODOMETRY.frames
# {tf.source: (parent, child) on /tf} of the generator, the strapdown and the aided navigator.
TRUTH_MOVES = {'truth': (MAP, BASE)}
INS_MOVES = {'ins': (ODOM, BASE), 'aided': (ODOM, BASE)}
AIDED_MOVES = {'aided': (MAP, ODOM)}
# The free INS starts in the coordinates of map and drifts in them: map -> odom is constant.
INS_FIXED = {'ins': (MAP, ODOM, AT_PARENT)}


def imu_mounting(settings):
    """Return the fixed transforms of the IMU, which coincides with base_link."""
    return BASE, topics.IMU_RAW.frames[0], AT_PARENT


def gnss_mounting(settings):
    """Return the fixed transforms of the GNSS antenna (lever arm) of GnssSettings."""
    return BASE, topics.GNSS_FIX.frames[0], (*settings.lever_arm_m, *quaternion.IDENTITY)


def meter_mounting(settings):
    """
    Return the fixed transforms of the velocity meter of VelocityMeterSettings.

    The mounting error is part of the true pose.
    """
    yaw = math.radians(settings.antennas.mounting_yaw_arcmin / 60.0)
    return BASE, topics.METER_VELOCITY.frames[0], (0.0, 0.0, 0.0, *quaternion.exponential(
        (0.0, 0.0, yaw)))
