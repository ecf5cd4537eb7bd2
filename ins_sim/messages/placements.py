"""
Which frames a node places on TF, and where the instruments sit on the vehicle.

Frames stand here by their default names; what is fixed is (parent, child, pose) of /tf_static.
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
# The free INS begins in the coordinates of map, and drifts in them: its odom stands still there.
INS_FIXED = {'ins': (MAP, ODOM, AT_PARENT)}


def imu_mounting(settings):
    """Return what stands fixed of the IMU, which coincides with base_link."""
    return BASE, topics.IMU_RAW.frames[0], AT_PARENT


def gnss_mounting(settings):
    """Return what stands fixed of the antenna, its lever arm; settings: GnssSettings."""
    return BASE, topics.GNSS_FIX.frames[0], (*settings.lever_arm_m, *quaternion.IDENTITY)


def meter_mounting(settings):
    """
    Return what stands fixed of the velocity meter; settings: VelocityMeterSettings.

    Its mounting error is part of the true pose.
    """
    yaw = math.radians(settings.antennas.mounting_yaw_arcmin / 60.0)
    return BASE, topics.METER_VELOCITY.frames[0], (0.0, 0.0, 0.0, *quaternion.exponential(
        (0.0, 0.0, yaw)))
