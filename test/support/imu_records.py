"""An IMU at rest in arrays."""

import ins_sim
import numpy as np


def record_at_rest(count=3000, **changed):
    """Return the ImuRecord of a sensor at rest, with some arrays changed."""
    arrays = {'t_ns': 10_000_000 * np.arange(count),
              'omega': np.tile([0.0, 5.16e-5, 5.16e-5], (count, 1)),
              'f': np.tile([0.0, 0.0, 9.806], (count, 1)), **changed}
    return ins_sim.ImuRecord(**arrays)
