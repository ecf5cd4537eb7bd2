"""
Magnetometer and barometer: what surrounds the vehicle, read at whole periods of motion time.

Every error is a function of seed, run and the index of the sample, its motion time over the
period.
"""

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.atmosphere import pressure
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.numerics.noise import indexed_noise

NT = 1e-9


class PeriodicSensor:
    """
    A sensor that takes the first sample of the truth in each of its periods.

    A sample that is repeated is answered again.

    rate_hz: of the sensor; noise: IndexedNoise of its samples.
    """

    def __init__(self, rate_hz, noise):
        self._period_ns, self._noise = period_ns(rate_hz), noise
        self._index = self._taken_ns = None

    def due(self, t_ns):
        """Return the noise of the sample at motion time t_ns, or None where there is none."""
        index = t_ns // self._period_ns
        if index == self._index and t_ns != self._taken_ns:
            return None
        self._index, self._taken_ns = index, t_ns
        return self._noise.normal(index)


class Magnetometer(PeriodicSensor):
    """
    The magnetometer of ImuSensorSettings.

    field: function (lat rad, lon rad, height m) -> field in East, North, Up, T.
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
        """Return the field in b, T; place: lat, lon, height, v_n, q_nb; noise: of ``due``."""
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
        """Return the static pressure, Pa, as a tuple; arguments as of ``Magnetometer.read``."""
        return (pressure(place[2]) + self._sigma * noise,)
