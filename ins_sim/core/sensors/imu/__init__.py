"""The IMU: ideal increments with channel delays, errors of the triads, sampling."""
