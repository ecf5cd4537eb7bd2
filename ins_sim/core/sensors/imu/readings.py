"""Conversion of IMU readings: from lists of single samples to records of arrays."""

import numpy as np

from ins_sim.core.timeseries.histories import ImuSamples


def components(vectors):
    """Return the columns of (n, m) as m contiguous arrays."""
    return tuple(np.ascontiguousarray(vectors.T))


def samples_of(readings):
    """Return the ImuSamples of readings (t_ns, omega, f, parity or None), as ``push`` returns."""
    if readings:
        return ImuSamples.of_readings([r[0] for r in readings], [r[1:] for r in readings])
    return ImuSamples(np.empty(0, dtype=np.int64), np.empty((0, 3)), np.empty((0, 3)))


def joined(parts):
    """Return several ImuSamples as one; parts that are empty or None are skipped."""
    parts = [part for part in parts if part is not None and len(part)]
    return ImuSamples.concatenate(parts) if parts else samples_of([])
