"""
Sensors: they read a motion, or streamed truth, and produce readings with errors.

One folder for the IMU, one for the dynamically tuned gyro, one for the correlation velocity meter;
``gnss`` is a single file. ``sensor`` is the interface. A sensor does not know how its readings are
used.
"""
