"""Readings of an IMU that tests share: at rest, in motion, on a bench."""
