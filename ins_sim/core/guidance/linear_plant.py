"""
Linear model of vehicle and autopilot of a lateral loop, from one control instant to the next.

z is the offset to the right of the leg, v its rate, beta the sideslip, u the command:

    z' = v,  v' = -Z_b beta,  beta' = (u - beta)/tau_b,  u = k1 z_est + k2 v_est
"""

from typing import NamedTuple

import numpy as np

from ins_sim.core.motion.guided.steered import moved_on
from .autopilot import make_autopilot


class LateralLoop(NamedTuple):
    """
    A vehicle that an autopilot keeps on its leg.

    Attributes
    ----------
    speed : V, m/s
    side_force : Z_b, m/s^2 per rad
    lag_s : tau_b, s
    k1 : gain of the offset z, rad/m
    k2 : gain of its rate v, rad/(m/s)
    period_s : time between control instants, s
    latency : in whole periods
    ramps : True if the command changes linearly over a period, False if it jumps
    """

    speed: float
    side_force: float
    lag_s: float
    k1: float
    k2: float
    period_s: float
    latency: int = 0
    ramps: bool = True


def lateral_loop(generator):
    """
    Return the LateralLoop of MotionGeneratorSettings, without wind.

    Return None for an autopilot without gains.
    """
    guided, guidance = generator.motion.guided, generator.guidance
    gains = make_autopilot(guidance).gains()
    if gains is None:
        return None
    return LateralLoop(generator.motion.route.airspeed_m_s, guided.side_force_m_s2_rad,
                       guided.lag_s, *gains, 1.0 / guided.control_rate_hz,
                       round(guidance.latency_s * guided.control_rate_hz))


def after_period(loop):
    """
    Return the matrix (3, 5) from the start to the end of a control period.

    Its columns multiply z, v and beta at the start of the period, the last command and the new
    one. If ``ramps``, the command changes linearly from the last to the new one over the period;
    otherwise the new one acts from the start.
    """
    h = loop.period_s

    def flown(z, v, beta, old, new):
        old = old if loop.ramps else new
        return moved_on(loop.side_force, loop.lag_s, (z, v, beta, old, (new - old) / h), h)[:3]

    return np.array([flown(*unit) for unit in np.eye(5).tolist()]).T
