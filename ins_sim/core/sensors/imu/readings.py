"""Readings of an IMU: from the lists of single samples to records of arrays."""

import numpy as np

from ins_sim.core.timeseries.histories import ImuSamples


def components(vectors):
    """Return the columns of (n, m) as m contiguous arrays."""
    return tuple(np.ascontiguousarray(vectors.T))


def samples_of(readings):
    """Return the ImuSamples of (t_ns, omega, f, parity or None), as pushes of an IMU return."""
    if readings:
        return ImuSamples.of_readings([r[0] for r in readings], [r[1:] for r in readings])
    return ImuSamples(np.empty(0, dtype=np.int64), np.empty((0, 3)), np.empty((0, 3)))


def joined(parts):
    """Return parts of ImuSamples, any of which may be empty or None, as one."""
    parts = [part for part in parts if part is not None and len(part)]
    return ImuSamples.concatenate(parts) if parts else samples_of([])
