"""An IMU at rest: as a record, and as the messages of a bag."""

import ins_sim
import numpy as np
from support.recordings import imu_messages


def record_at_rest(count=3000, **changed):
    """Return the ImuRecord of a sensor at rest, with some arrays replaced."""
    arrays = {'t_ns': 10_000_000 * np.arange(count),
              'omega': np.tile([0.0, 5.16e-5, 5.16e-5], (count, 1)),
              'f': np.tile([0.0, 0.0, 9.806], (count, 1)), **changed}
    return ins_sim.ImuRecord(**arrays)


IMU_ONLY = dict(t_ns=np.arange(1000) * 20_000_000, omega=np.zeros((1000, 3)),
                f=np.tile([0.0, 0.0, 9.8], (1000, 1)))


def resting(count=1000, **changes):
    """Return IMU messages of a sensor at rest."""
    values = {name: x[:count] for name, x in IMU_ONLY.items()}
    return imu_messages(**{**values, **changes})
