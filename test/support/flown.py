"""A route for the tests: its settings, its motion, and quantities derived from the truth alone."""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.settings.catalogue import build
from ins_sim.settings.place import Earth
from ins_sim.core.motion.route.motion import RouteMotion
from ins_sim.settings.route import FlownRouteSettings

POINTS = {'points.latitude_deg': (55.0, 56.0, 55.8, 57.0),
          'points.longitude_deg': (37.0, 38.0, 40.0, 41.0)}
WIND = {'wind_m_s': 8.0, 'wind_from_deg': 250.0}
WEAVE = {'weave_deg': 1.0}
GUSTS = {'gust_m_s': 0.5}
ROUGH = {**WIND, **WEAVE, **GUSTS}


def route(*groups, **more):
    """Return the RouteMotion built from groups of settings."""
    values = dict(POINTS)
    for group in groups:
        values.update(group)
    return RouteMotion(build(FlownRouteSettings, {**values, **more}), Earth())


def instants(motion, step_s, first_s=0.0):
    """Return motion times from first_s to the arrival, int64 ns."""
    return np.arange(round(first_s * 1e9), round(motion.end_s * 1e9), round(step_s * 1e9))


def on_legs(motion, t_ns):
    """Return a mask of the instants on legs, not in turns."""
    t, free = t_ns * 1e-9, np.ones(len(t_ns), dtype=bool)
    for start, end in motion.turns:
        free &= (t < start) | (t > end)
    return free


def gust_velocity(motion, t_ns):
    """Return the velocity of the gusts, East, North, Up (n, 3), m/s."""
    if motion.gusts is None:
        return np.zeros((len(t_ns), 3))
    return np.stack([d.derivative().value for d in motion.gusts.displacement(t_ns * 1e-9)], -1)


def air_velocity(motion, truth):
    """Return velocity minus wind and gusts, East, North, Up (n, 3), m/s."""
    return truth.v_n - np.array((*motion.wind, 0.0)) - gust_velocity(motion, truth.t_ns)


def in_body(truth, v_n):
    """Return vectors (n, 3) transformed from navigation axes n to body axes b."""
    return np.stack(quaternion.rotate_back(truth.q_nb.T, v_n.T), axis=-1)
