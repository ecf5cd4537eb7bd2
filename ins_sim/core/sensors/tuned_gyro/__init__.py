"""
Dynamically tuned gyros: rotor dynamics, their integration and stability, and pairs of gyros.

Start with ``rotor`` (equations and parameters), then ``stepping``; ``pair`` combines two gyros
into
the three axes of an IMU.
"""
