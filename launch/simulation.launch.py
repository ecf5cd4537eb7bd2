"""
Start the motion generator, the IMU and the strapdown; end when the run ends.

Example: ros2 launch ins_sim simulation.launch.py motion:=racetrack imu:=imu_tactical_mems \\
             rate_hz:=200.0 use_sim_time:=true prefix:=uav1
With aided:=true velocity meter, GNSS and aided navigator run too; with motion:=guided_flight
besides, the aided solution steers the vehicle.  With record:=DIR a recorder writes their topics
into a bag, and nothing is lost, for the generator waits for all of them (lock-step).

Parameters come from, a later one wins: the defaults of the nodes, motion, imu, the files of
params_file in their order, the other arguments.
"""

from ins_sim.launching import actions


def generate_launch_description():
    """Return the launch description."""
    return actions.simulation(__file__)
