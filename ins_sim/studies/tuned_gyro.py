"""
The study of Sapegin, Romanov and Bugaiov (2016): error of the roll due to the lag of tuned gyros.

The base rocks in roll by 10 deg sin(w t). Two gyros measure its rates, and their readings are
integrated by Poisson's equation and by that of the Euler vector; gyros and equations use RK4 with
the same step. The amplitude is half the peak-to-peak value of the computed roll over the last
whole period (docs/theory/tuned_gyro.md). The conditions and printed values of the paper's tables
are in config/dtg_study_frequency.yaml and dtg_study_speed.yaml.
"""

from dataclasses import dataclass, replace
import math

import numpy as np

from ins_sim.core.attitude.angles import roll_of_matrix
from ins_sim.core.attitude.integration import step_euler_vector, step_poisson
from ins_sim.core.attitude.matrix import dcm_of
from ins_sim.core.attitude.quaternion import exponential
from ins_sim.core.numerics import compilation, elementary
from ins_sim.core.numerics.fixed_order import magnitude
from ins_sim.core.sensors.tuned_gyro.pair import both_inputs, combine, GyroPair
from ins_sim.core.sensors.tuned_gyro.rotor import PRESETS
from ins_sim.core.sensors.tuned_gyro.rotor_step import rotor_stages, rotor_step
from ins_sim.core.sensors.tuned_gyro.stability import bisect_condition, rk4_amplification
from ins_sim.core.sensors.tuned_gyro.state_space import state_space


@dataclass(frozen=True)
class Cell:
    """
    One cell of a table.

    Attributes
    ----------
    value : angular frequency of the base, rad/s, or speed of the rotor, Hz
    poisson_deg, euler_vector_deg : amplitude by each algorithm, deg
    paper_deg : printed value, deg, or None
    """

    value: float
    poisson_deg: float
    euler_vector_deg: float
    paper_deg: float | None


def half_peak_to_peak(y):
    """Return half the range of samples, with each extremum from the parabola through 3 points."""
    def highest(v):
        k = min(max(range(len(v)), key=v.__getitem__), len(v) - 2) or 1
        slope, bend = 0.5 * (v[k + 1] - v[k - 1]), v[k + 1] - 2.0 * v[k] + v[k - 1]
        return v[k] - (0.5 * slope * slope / bend if bend < 0.0 else 0.0)
    return 0.5 * (highest(y) + highest([-v for v in y]))


def rocking_amplitudes(pair, amplitude_deg, rate_rad_s, step_s, method='rk4'):
    """
    Return the amplitudes of roll, deg, computed by Poisson's equation and by the Euler vector.

    The record is 20 s or three periods, whichever is longer.

    Parameters
    ----------
    pair : GyroPair at rest
    amplitude_deg : amplitude of the base, deg
    rate_rad_s : angular frequency of the base, rad/s
    step_s, method : length of a step, s, and method of the pair
    """
    period = 2.0 * math.pi / rate_rad_s
    steps = math.ceil(max(20.0, 3.0 * period) / step_s)
    first = steps - math.ceil(period / step_s)
    top = math.radians(amplitude_deg) * rate_rad_s
    one, two = pair.gyros
    stages = (one.stages, two.stages) if method == 'rk4' else None
    rolls = np.empty((steps - first, 2))
    compilation.run(rock, steps, (steps, first, top, rate_rad_s, step_s,
                                  pair.arrangement == 'turned', one.gains, two.gains, stages,
                                  one.state, two.state), rolls)
    return tuple(math.degrees(half_peak_to_peak(y)) for y in rolls.T.tolist())


def rock(steps, first, top, rate_rad_s, step_s, turned, gains_1, gains_2, stages, x_1, x_2, out):
    """
    Advance a rocking base by a number of steps and write the computed roll.

    Parameters
    ----------
    steps : number of steps
    first : number of the first step whose roll is written
    top : amplitude of the rate of the base, rad/s
    rate_rad_s : angular frequency of the base, rad/s
    step_s : length of a step, s
    turned : whether the arrangement of the gyros is turned
    gains_1, gains_2 : constants of both rotors, see ``rotor_step``
    stages : constants of both for ``rotor_stages``, or None to use the mean rate of a step
    x_1, x_2 : states of both rotors, see ``rotor_step``
    out : (steps - first, 2), written by flat index: roll by Poisson and by the Euler vector, rad
    """
    c, theta, u_end = dcm_of((0.0, 0.0, 0.0, 1.0)), (0.0, 0.0, 0.0), (top, 0.0, 0.0)
    for k in range(steps):
        u_start = u_end
        u_mid = (top * elementary.cos(rate_rad_s * (k + 0.5) * step_s), 0.0, 0.0)
        u_end = (top * elementary.cos(rate_rad_s * (k + 1) * step_s), 0.0, 0.0)
        inputs_1, inputs_2 = both_inputs(turned, u_start, u_mid, u_end)
        rates = _rates(turned, gains_1, gains_2, stages, x_1, x_2, inputs_1, inputs_2)
        x_1, _ = rotor_step(gains_1, x_1, inputs_1)
        x_2, _ = rotor_step(gains_2, x_2, inputs_2)
        c, theta = step_poisson(c, rates, step_s), step_euler_vector(theta, rates, step_s)
        if k >= first:
            i = 2 * (k - first)
            out[i] = roll_of_matrix(c)
            out[i + 1] = roll_of_matrix(dcm_of(exponential(theta)))


def _rates(turned, gains_1, gains_2, stages, x_1, x_2, inputs_1, inputs_2):
    """Return the body rates at the stages of a step; without stages four times the mean."""
    if stages is None:
        _, (a, b) = rotor_step(gains_1, x_1, inputs_1)
        _, (c, d) = rotor_step(gains_2, x_2, inputs_2)
        mean, _ = combine(turned, (a, b, c, d))
        return mean, mean, mean, mean
    a, b, c, d = rotor_stages(stages[0], x_1, inputs_1)
    e, f, g, h = rotor_stages(stages[1], x_2, inputs_2)
    return (combine(turned, (a[0], a[1], e[0], e[1]))[0],
            combine(turned, (b[0], b[1], f[0], f[1]))[0],
            combine(turned, (c[0], c[1], g[0], g[1]))[0],
            combine(turned, (d[0], d[1], h[0], h[1]))[0])


def gyro_at(settings, speed_hz=None):
    """Return the TunedGyroParameters of TunedGyroStudySettings, tuned at a speed or at its own."""
    return at_speed(PRESETS[settings.preset], speed_hz or settings.rotor_speed_hz)


def at_speed(parameters, speed_hz):
    """Return the parameters with read-out and hinges designed for another speed."""
    return replace(parameters, speed_hz=speed_hz, hinge_stiffness_n_m_rad=None)


def study_table(settings, progress=None):
    """
    Return a Cell for each value of TunedGyroStudySettings, with the printed one.

    progress: called after each cell. Raises ValueError for an unstable gyro.
    """
    paper = settings.paper_deg or (None,) * len(settings.values)
    return _cells(settings, settings.values, paper, progress)


def study_curve(settings, progress=None):
    """Return a Cell for each of the curve_values, as ``study_table`` does for the values."""
    return _cells(settings, settings.curve_values, (None,) * len(settings.curve_values), progress)


def _cells(settings, values, paper, progress):
    step_s, method, cells = 1e-3 * settings.step_ms, settings.method, []
    for value, printed in zip(values, paper):
        if settings.sweep == 'base_rate':
            gyro, rate_rad_s = gyro_at(settings), value
        else:
            gyro, rate_rad_s = gyro_at(settings, value), settings.base_rate_rad_s
        pair = GyroPair(gyro, step_s, method=method)
        cells.append(Cell(value, *rocking_amplitudes(pair, settings.amplitude_deg, rate_rad_s,
                                                     step_s, method), printed))
        if progress:
            progress()
    return tuple(cells)


def rk4_radius(parameters, speed_hz, step_s):
    """Return the spectral radius of the matrix of one RK4 step at a speed, tuned at this speed."""
    roots = state_space(at_speed(parameters, speed_hz)).roots
    return max(magnitude(rk4_amplification(root * step_s)) for root in roots)


def stability_limits(parameters, step_s, low_hz=20.0, high_hz=2000.0, resolution_hz=1.0):
    """
    Return the lowest and the highest speed about the nominal one at which RK4 decays, Hz.

    The speed is changed from the nominal one by resolution_hz until RK4 grows, and the limit is
    found by bisection in that interval; None on a side without a limit between low_hz and high_hz.
    Raises ValueError if RK4 grows at the nominal speed.
    """
    def decays(hz):
        return rk4_radius(parameters, hz, step_s) < 1.0

    start = parameters.speed_hz
    if not decays(start):
        raise ValueError(f'speed_hz is {start:g} Hz, at which RK4 with a step of '
                         f'{1e3 * step_s:g} ms is unstable; expected a stable speed')
    limits = []
    for stride, end in ((-resolution_hz, low_hz), (resolution_hz, high_hz)):
        inside, outside = start, start + stride
        while decays(outside) and min(start, end) <= outside <= max(start, end):
            inside, outside = outside, outside + stride
        limits.append(None if decays(outside) else bisect_condition(decays, inside, outside))
    return tuple(limits)
