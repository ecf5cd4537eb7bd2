"""Guided motions for the tests, and a command that excites all their dynamics."""

import math

import numpy as np

from ins_sim.core.motion.guided.motion import GuidedMotion
from ins_sim.settings.catalogue import build
from ins_sim.settings.guidance import GuidedSettings
from ins_sim.settings.place import Earth
from ins_sim.settings.route import FlownRouteSettings
from ..flown import POINTS

PERIOD_NS = 10_000_000


def guided(route=None, **more):
    """
    Return a GuidedMotion on the route of ``flown``.

    route: settings of the route; more: settings of the guided motion.
    """
    return GuidedMotion(build(FlownRouteSettings, {**POINTS, **(route or {})}),
                        build(GuidedSettings, more), Earth())


def stirring(t):
    """Return a bank command, rad, at time t in s: a slow wave with a jump every five seconds."""
    return 0.08 * math.cos(0.35 * t) + 0.05 * (1, -1, -1, 1)[int(t / 5.0) % 4]


def fly(motion, seconds, command=stirring):
    """Apply a command to a motion for some seconds; return the motion."""
    for k in range(round(seconds * 1e9) // motion.period_ns):
        motion.command(motion.known_ns, command(k * motion.period_ns * 1e-9))
    return motion


def instants(seconds, step_ns=PERIOD_NS):
    """Return motion times from 0 to the given number of seconds, int64 ns."""
    return np.arange(0, round(seconds * 1e9) + 1, step_ns, dtype=np.int64)
