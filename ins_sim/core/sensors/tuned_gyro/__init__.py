"""
Dynamically tuned gyros: rotor dynamics, their integration and stability, and pairs of gyros.

``rotor`` has the parameters and the equations, ``state_space`` the linear system,
``step_matrices`` its steps and ``rotor_step`` their arithmetic; ``stepping`` is one gyro. ``pair``
combines two gyros into the three axes of an IMU, and ``instrument`` adds their errors.
"""
