"""
Play a bag into the strapdown, or into the IMU and the strapdown; end when the bag ends.

Example: ros2 launch ins_sim replay.launch.py bag:=DIR source:=truth imu:=imu_tactical_mems
"""

from ins_sim.launching import actions


def generate_launch_description():
    """Return the launch description."""
    return actions.replay(__file__)
