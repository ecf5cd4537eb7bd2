"""
Start the motion generator, the IMU and the strapdown; end when the run ends.

Example: ros2 launch ins_sim simulation.launch.py motion:=racetrack imu:=imu_tactical_mems \
             rate_hz:=200.0 use_sim_time:=true prefix:=uav1

With aided:=true velocity meter, GNSS and aided navigator run too; with motion:=guided_flight in
addition, the aided solution steers the vehicle. With record:=DIR a recorder writes the topics into
a bag; the generator then waits for all nodes (lock-step), so that nothing is lost.

Precedence of parameters, later ones override earlier ones: defaults of the nodes, motion, imu, the
files of params_file in their order, the other arguments.
"""

from ins_sim.launching import actions


def generate_launch_description():
    """Return the launch description."""
    return actions.simulation(__file__)
