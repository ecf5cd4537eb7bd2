"""Settings, flights and readings shared by the tests of the velocity meter."""

from dataclasses import astuple
import math

import numpy as np

from ins_sim.settings.catalogue import build
from ins_sim.core.timeseries.fixes import VALID
from ins_sim.settings.velocity_meter import VelocityMeterSettings
from ins_sim.core.sensors.velocity_meter.pulses import SignalWindows

DT_NS = 10_000_000
# An instrument without errors.
PERFECT = {'surrogate.sigma_x_m_s': 0.0, 'surrogate.sigma_z_m_s': 0.0, 'surrogate.slip_x': 0.0,
           'surrogate.slip_z_m_s': 0.0, 'surrogate.bias_x_m_s': 0.0}


def meter_settings(values=None, **more):
    """Return VelocityMeterSettings of {dotted name: value}; double underscores are dots."""
    values = {'attack_angle': 'none', **(values or {}),
              **{k.replace('__', '.'): v for k, v in more.items()}}
    return build(VelocityMeterSettings, values)


def body(speed, beta, alpha=0.0):
    """Return the velocity in body axes FLU for sideslip beta and angle of attack alpha, rad."""
    return (speed * math.cos(beta) * math.cos(alpha), -speed * math.sin(beta),
            -speed * math.cos(beta) * math.sin(alpha))


def flight(cycles, v_b=(250.0, 0.0, 0.0), first=0):
    """Return t_ns, v_b, height of a steady flight over a number of cycles."""
    t_ns = np.arange(first, first + cycles + 1) * DT_NS
    return t_ns, np.tile(np.array(v_b), (cycles + 1, 1)), np.full(cycles + 1, 500.0)


def errors(settings, windows, beta=0.0, speed=250.0):
    """
    Return the errors of V_x1, V_z1 and V_z1 from delays in mode signal, (n, 3), of the valid
    windows.

    Also return the fraction of windows that are valid.
    """
    made, v = SignalWindows(settings), (speed * math.cos(beta), 0.0, speed * math.sin(beta))
    found, index = [], 0
    for _ in range(windows):
        total = None
        for _ in range(settings.window.cycles):
            index += 1
            total = made.add(total, index, v, v)
        one = made.read(total, index, 0.0)
        if one.status == VALID:
            found.append((one.v_x - v[0], one.v_z - v[2], one.v_z_delays - v[2]))
    return np.array(found), len(found) / windows


def same(a, b):
    """Return whether two lists of fixes are equal to the bit, NaN included."""
    return repr([astuple(fix) for fix in a]) == repr([astuple(fix) for fix in b])
