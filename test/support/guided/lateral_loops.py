"""The lateral guidance loop of the study of the velocity meter, and its reduced simulations."""

import math

import numpy as np

from ins_sim.core.guidance.error_loop import fly_reduced, ReducedCases
from ins_sim.core.guidance.linear_loop import Aiding
from ins_sim.core.guidance.linear_plant import LateralLoop

PERIOD_S = 0.01
MOST = math.radians(8.0)


def loop(latency=0, ramps=True):
    """Return the LateralLoop of the study; latency in periods of 10 ms."""
    return LateralLoop(200.0, 20.0, 0.4, 0.0125, 0.04, PERIOD_S, latency, ramps)


def sliding(cycles, k_v, step=1):
    """Return the conventional Aiding with sliding windows, gain K_v in 1/s."""
    return Aiding('conventional', cycles, step, k_v * step * PERIOD_S)


def block(cycles, gain):
    """Return the conventional Aiding with successive windows that do not overlap."""
    return Aiding('conventional', cycles, cycles, gain)


def paper(cycles, gain):
    """Return the corrected Aiding of Ivanov (2015)."""
    return Aiding('paper_corrected', cycles, cycles, gain)


def flown(aiding, k_z, offset=100.0, duration_s=300.0, engaged_s=0.0, latency=0):
    """Return the ReducedFlights of one case: simulations of the lateral channel alone."""
    cases = ReducedCases(np.array([aiding.gain]), np.array([k_z]), np.array([offset]))
    return fly_reduced(loop(latency), aiding, cases, duration_s, MOST, engaged_s, forward=False)
