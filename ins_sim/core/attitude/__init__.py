"""
Attitude: quaternions, matrices, angles, integration of body rates and interpolation.

Start with ``quaternion``. Scalar last (x, y, z, w); floats for single samples, arrays for
histories.
"""
