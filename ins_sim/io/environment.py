"""Simulate imu/mag and imu/pressure from the truth, both live and offline."""

import math

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.sensors.environment import Barometer, Magnetometer
from ins_sim.messages import topics
from .magnetic_field import magnetic_field


def environment_topics(settings):
    """
    Return the Topics of the sensors that are enabled in ImuSensorSettings.

    Raises ValueError if the magnetometer is enabled and its field model is not installed.
    """
    found = ()
    if settings.magnetometer.publish:
        magnetic_field(settings.magnetometer.year)
        found += (topics.IMU_MAG,)
    if settings.barometer.publish:
        found += (topics.IMU_PRESSURE,)
    return found


class EnvironmentSensors:
    """
    Magnetometer and barometer of ImuSensorSettings.

    The attribute topics maps each Topic to the same Topic with frame and variance of its sensor.
    Raises ValueError as ``environment_topics``.
    """

    def __init__(self, settings):
        self._settings = settings
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._sensors, self.topics = {}, {}
        self.reset()
        for topic, sensor in self._sensors.items():
            self.topics[topic] = topics.with_variance(topic, sensor.variance).named(
                settings.frames.names())

    def reset(self):
        """Forget which samples were taken."""
        settings = self._settings
        for topic in environment_topics(settings):
            self._sensors[topic] = Barometer(settings) if topic is topics.IMU_PRESSURE else \
                Magnetometer(settings, magnetic_field(settings.magnetometer.year))

    def read(self, t_ns, r_m, q_mb, v_b):
        """
        Return [(Topic, values of its message)] of the sensors that have a sample at t_ns.

        t_ns is motion time; r_m, q_mb, v_b are true pose and velocity as in truth/odometry.
        """
        found, place = [], None
        for topic, sensor in self._sensors.items():
            noise = sensor.due(t_ns)
            if noise is not None:
                if place is None:
                    place = self._frame.geodetic_one(r_m, q_mb, v_b)
                run = sensor.read(place, noise)
                if all(map(math.isfinite, run)):
                    found.append((topic, run))
        return found
