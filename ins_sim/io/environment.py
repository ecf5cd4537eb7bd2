"""imu/mag and imu/pressure: from the truth to messages, live and offline alike."""

import math

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.sensors.environment import Barometer, Magnetometer
from ins_sim.messages import topics
from .magnetic_field import magnetic_field


def environment_topics(settings):
    """
    Return the Topics of the sensors that ImuSensorSettings switch on.

    Raises ValueError where the model of the magnetic field is asked for and missing.
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
    The magnetometer and the barometer of ImuSensorSettings.

    topics: {Topic: the same with its frame and the variance of its sensor}.  Raises ValueError as
    ``environment_topics``.
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
        """Forget which samples have been taken."""
        settings = self._settings
        for topic in environment_topics(settings):
            self._sensors[topic] = Barometer(settings) if topic is topics.IMU_PRESSURE else \
                Magnetometer(settings, magnetic_field(settings.magnetometer.year))

    def read(self, t_ns, r_m, q_mb, v_b):
        """
        Return [(Topic, run of its message)] of the sensors that are due.

        t_ns: motion time; r_m, q_mb, v_b: pose and velocity of the truth, as of truth/odometry.
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
