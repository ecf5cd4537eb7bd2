"""Instants of IMU samples, from stamps with latency and jitter."""


class SampleClock:
    """
    Converts the stamps of readings to the instants of the samples.

    With imu_time ``stamp`` the stamps are taken as they are. With ``nominal`` the known latency is
    subtracted and the result rounded to the nearest multiple of the period.

    settings: StrapdownSettings; dt_ns: sampling period in motion time.  Raises ValueError if a
    latency is given with ``stamp``.
    """

    def __init__(self, settings, dt_ns):
        self._dt_ns = dt_ns
        self._nominal = settings.imu_time == 'nominal'
        if settings.imu_latency_us and not self._nominal:
            raise ValueError(f'imu_latency_us is {settings.imu_latency_us:g} us with imu_time '
                             'stamp; expected imu_time nominal, because stamp does not '
                             'subtract it')
        self._shift_ns = dt_ns // 2 - round(1000.0 * settings.imu_latency_us)

    def instant(self, stamp_ns):
        """Return the instant of a stamp, ns (an integer or an array of them)."""
        if not self._nominal:
            return stamp_ns
        return (stamp_ns + self._shift_ns) // self._dt_ns * self._dt_ns
