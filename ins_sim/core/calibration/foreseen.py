"""The standard deviations of delays that a bench motion would give, computed without readings."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.timeseries.histories import ImuSamples
from .bench_record import BenchRecord, FEWEST
from .channel_fit import fit_channel
from .channel_sums import channel_sums
from .delays import noise_of
from .separability import unobservable


@dataclass(frozen=True)
class ForeseenDelays:
    """Standard deviations of delays by axis, s, and why one is not observable, or ''."""

    sigmas: tuple
    refused: tuple

    @property
    def worst(self):
        """The largest standard deviation of an observable delay, s, or None."""
        shown = [s for s, why in zip(self.sigmas, self.refused) if not why]
        return max(shown, default=None)


def planned_record(name, motion, datum, earth, white, rate_hz, start_s, duration_s):
    """
    Return the BenchRecord of a planned motion, without readings.

    Parameters
    ----------
    name : used in messages
    motion : Motion
    datum, earth : settings of the position of the bench
    white : (3,) angle random walk, rad/sqrt(s)
    rate_hz : sampling rate, Hz
    start_s, duration_s : motion time of the start, and length, s; ValueError if too short
    """
    dt_ns = round(1e9 / rate_hz)
    count = int(duration_s * 1e9 / dt_ns)
    if count < FEWEST:
        raise ValueError(f'{name}: {duration_s:g} s at {rate_hz:g} Hz are {count} readings; '
                         f'expected at least {FEWEST}')
    t_ns = round(start_s * 1e9) + dt_ns * np.arange(1, count + 1, dtype=np.int64)
    nothing = np.zeros((count, 3))
    return BenchRecord(name, ImuSamples(t_ns, nothing, nothing), dt_ns, motion, datum, earth,
                       white=white)


def foresee(records):
    """Return the ForeseenDelays for planned BenchRecords."""
    sigmas, refused = [], []
    for axis in range(3):
        sums = [channel_sums(record, axis, 0) for record in records]
        fit = fit_channel(sums, noise_of(records, axis))
        sigmas.append(fit.delay_sigma)
        refused.append(unobservable(axis, fit, max(s.most for s in sums),
                                    records[0].dt_ns * 1e-9))
    return ForeseenDelays(tuple(sigmas), tuple(refused))
