"""The IMU: ideal increments of late channels, errors of the triads, sampling."""
