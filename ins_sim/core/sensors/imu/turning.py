"""The limit of the turn rate that an IMU can measure: half a turn in one sampling interval."""

import math

import numpy as np

from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.streams.faults import half_turn_sentence

# Number of instants at which the turn rate of a motion is checked beforehand.
LOOKS = 4096
# Length of the check in a node, which does not know how long it will run, s.
NODE_S = 60.0


def check_turning(settings, motion, start_s, span_s):
    """
    Raise ValueError if a motion turns by half a turn or more within one IMU interval.

    The rotation vector of an interval describes the shorter way round, so the reading would show a
    different rate. Output ``integrated`` has no such limit. The motion is checked at LOOKS equally
    spaced instants.

    Parameters
    ----------
    settings : ImuSensorSettings
    motion : Motion
    start_s : motion time of the first instant, s
    span_s : length of the span to check, s
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
