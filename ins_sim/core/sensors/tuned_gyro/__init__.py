"""
Dynamically tuned gyros: rotor dynamics, their integration and stability, and pairs of gyros.

``rotor`` has the parameters and the equations of motion, ``state_space`` the linear system,
``step_matrices`` the matrices of one step and ``rotor_step`` their arithmetic; ``stepping`` is one
gyro. ``pair`` combines two gyros into the three axes of an IMU, and ``instrument`` adds errors.
"""
