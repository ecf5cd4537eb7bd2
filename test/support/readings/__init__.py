"""IMU readings shared by tests: at rest, in motion, on a test bench."""
