"""The stamps of the samples that leave the IMU: latency, jitter and drop-outs."""

from dataclasses import fields, replace

import numpy as np

from ins_sim.settings.catalogue import check_value
from ins_sim.settings.instrument_errors import Sampling

# A stamp moves by less than half a period (five standard deviations), so stamps keep their order.
SIGMAS = 5.0


class Sampler:
    """
    Stamps of the samples that are not dropped.

    Drop-out and jitter of a sample are functions of (seed, run, name, index) and do not depend on
    earlier calls. Raises ValueError for settings out of range.

    Parameters
    ----------
    settings : Sampling
    name : name of the random streams and prefix of the keys in messages
    dt_ns : sampling period, ns
    """

    def __init__(self, settings, seed, run, name, dt_ns):
        for f in fields(Sampling):
            check_value(f'{name}.{f.name}', getattr(settings, f.name), f)
        most_us = dt_ns * 1e-3 / (2.0 * SIGMAS)
        if settings.jitter_us > most_us:
            raise ValueError(f'{name}.jitter_us is {settings.jitter_us:g} us; expected at most '
                             f'{most_us:g} us, a tenth of the sampling period')
        self._dt_ns = dt_ns
        self._latency_ns = round(1000.0 * settings.latency_us)
        self._jitter_ns = 1000.0 * settings.jitter_us
        self._most_ns = (dt_ns - 1) // 2
        self._lost = settings.drop_out_probability
        self.perfect = not (self._latency_ns or self._jitter_ns or self._lost)
        if not self.perfect:
            # Imported only if needed: NumPy's generators would slow down the start of a node.
            from ins_sim.core.numerics.noise import indexed_noise
            self._jitters = indexed_noise(seed, run, f'{name}.jitter')
            self._drop_outs = indexed_noise(seed, run, f'{name}.drop_out')

    def stamp(self, index, t_ns):
        """Return the stamp (ns) of sample index, taken at t_ns, or None if it is dropped."""
        if self.perfect:
            return t_ns
        if self._lost and self._drop_outs.uniform(index) < self._lost:
            return None
        if self._jitter_ns:
            shift = round(self._jitter_ns * self._jitters.normal(index))
            t_ns += max(-self._most_ns, min(self._most_ns, shift))
        return t_ns + self._latency_ns

    def take(self, imu):
        """Return the ImuSamples that are not dropped, with their stamps."""
        if self.perfect or not len(imu):
            return imu
        kept, stamps = np.ones(len(imu), dtype=bool), imu.t_ns.copy()
        for part in consecutive(imu.t_ns // self._dt_ns):
            first, count = int(imu.t_ns[part.start]) // self._dt_ns, part.stop - part.start
            if self._lost:
                kept[part] = self._drop_outs.uniforms(first, count) >= self._lost
            if self._jitter_ns:
                shift = np.rint(self._jitter_ns * self._jitters.normals(first, count))
                stamps[part] += np.clip(shift.astype(np.int64), -self._most_ns, self._most_ns)
        return replace(imu[kept], t_ns=(stamps + self._latency_ns)[kept])


def consecutive(index):
    """Return the slices of an integer array in which each entry is one more than the last."""
    ends = [*(np.flatnonzero(np.diff(index) != 1) + 1).tolist(), len(index)]
    return [slice(start, end) for start, end in zip([0, *ends], ends) if end > start]
