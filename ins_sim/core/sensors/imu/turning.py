"""The fastest turn that the readings of an IMU can tell: half a turn an interval."""

import math

import numpy as np

from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.streams.faults import half_turn_sentence

# Instants at which a motion is looked at before it is sensed.
LOOKS = 4096
# Of a node, which does not know how long it will be driven, s.
NODE_S = 60.0


def check_turning(settings, motion, start_s, span_s):
    """
    Raise ValueError where a motion turns by half a turn or more in an interval of the IMU.

    settings: ImuSensorSettings.  The rotation vector of an interval is that of the shorter way
    round, so that the reading would be of another rate; an integral of the rate has no such
    limit.  The motion is looked at LOOKS times from start_s, s of motion time, on.
    """
    if settings.output == 'integrated':
        return
    dt_s = period_ns(settings.rate_hz) * 1e-9
    t_ns = np.round((start_s + span_s * np.arange(LOOKS) / LOOKS) * 1e9).astype(np.int64)
    omega = motion.at(t_ns).omega_ib_b
    rate = length(omega)
    k = int(np.argmax(rate))
    if rate[k] * dt_s >= math.pi:
        raise ValueError(half_turn_sentence('the motion', t_ns[k], rate[k], dt_s))
