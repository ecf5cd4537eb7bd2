"""
Magnetometer and barometer: the field and the air around the vehicle, sampled periodically.

A sample is due at each whole multiple of the sensor's period in motion time. Its error is a
function of the seed, the run and the index of the sample (motion time divided by the period).
"""

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.atmosphere import pressure
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.numerics.noise import indexed_noise

NT = 1e-9


class PeriodicSensor:
    """
    Base class of a sensor that uses the first truth sample in each of its periods.

    If that truth sample is repeated, the sensor answers again with the same reading.

    Parameters
    ----------
    rate_hz : rate of the sensor, Hz
    noise : IndexedNoise that gives the noise of sample i
    """

    def __init__(self, rate_hz, noise):
        self._period_ns, self._noise = period_ns(rate_hz), noise
        self._index = self._taken_ns = None

    def due(self, t_ns):
        """Return the noise of the sample taken at motion time t_ns, or None if none is due."""
        index = t_ns // self._period_ns
        if index == self._index and t_ns != self._taken_ns:
            return None
        self._index, self._taken_ns = index, t_ns
        return self._noise.normal(index)


class Magnetometer(PeriodicSensor):
    """
    The magnetometer of ImuSensorSettings.

    Parameters
    ----------
    settings : ImuSensorSettings
    field : function (latitude in rad, longitude in rad, height in m) that returns the magnetic
        field in east, north, up, T
    """

    def __init__(self, settings, field):
        super().__init__(settings.magnetometer.rate_hz,
                         indexed_noise(settings.seed, settings.run, 'magnetometer', 3))
        self._sigma, self._field = settings.magnetometer.noise_nt * NT, field

    @property
    def variance(self):
        """Return the variance of the noise of each axis, T^2."""
        return self._sigma * self._sigma

    def read(self, place, noise):
        """
        Return the measured magnetic field in body axes, T.

        Parameters
        ----------
        place : latitude (rad), longitude (rad), height (m), velocity, q_nb
        noise : three standard normal numbers, as ``due`` returns them
        """
        lat, lon, height, _, q_nb = place
        x, y, z = quaternion.rotate_back(q_nb, self._field(lat, lon, height))
        return (x + self._sigma * noise[0], y + self._sigma * noise[1],
                z + self._sigma * noise[2])


class Barometer(PeriodicSensor):
    """The barometer of ImuSensorSettings, in the standard atmosphere."""

    def __init__(self, settings):
        super().__init__(settings.barometer.rate_hz,
                         indexed_noise(settings.seed, settings.run, 'barometer'))
        self._sigma = settings.barometer.noise_pa

    @property
    def variance(self):
        """Return the variance of the noise, Pa^2."""
        return self._sigma * self._sigma

    def read(self, place, noise):
        """Return the static pressure, Pa, as a tuple; for place and noise see Magnetometer."""
        return (pressure(place[2]) + self._sigma * noise,)
