"""Instants of IMU samples from stamps with latency and jitter."""


class SampleClock:
    """
    The instants of readings by their stamps, as StrapdownSettings say.

    imu_time ``stamp``: the stamps themselves; ``nominal``: less the known latency, the nearest
    multiples of the period dt_ns in motion time.  Raises ValueError for a latency with the former.
    """

    def __init__(self, settings, dt_ns):
        self._dt_ns = dt_ns
        self._nominal = settings.imu_time == 'nominal'
        if settings.imu_latency_us and not self._nominal:
            raise ValueError(f'imu_latency_us is {settings.imu_latency_us:g} us with imu_time '
                             'stamp; expected imu_time nominal, which alone takes it off')
        self._shift_ns = dt_ns // 2 - round(1000.0 * settings.imu_latency_us)

    def instant(self, stamp_ns):
        """Return the instant of a stamp, ns (an integer or an array of them)."""
        if not self._nominal:
            return stamp_ns
        return (stamp_ns + self._shift_ns) // self._dt_ns * self._dt_ns
