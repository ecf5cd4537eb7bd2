"""Recordings for the tests of the command navigate."""

import numpy as np
from support.recordings import imu_messages

IMU_ONLY = dict(t_ns=np.arange(1000) * 20_000_000, omega=np.zeros((1000, 3)),
                f=np.tile([0.0, 0.0, 9.8], (1000, 1)))


def resting(count=1000, **changes):
    """Return IMU messages of a standstill."""
    values = {name: x[:count] for name, x in IMU_ONLY.items()}
    return imu_messages(**{**values, **changes})
