"""
The study of Sapegin, Romanov, Bugaiov 2016: what the lag of two tuned gyros costs in roll.

The base rocks in roll by 10 deg sin(w t).  Its rates go through two gyros, and the readings into
Poisson's equation and into that of the Euler vector, all by RK4 with one step; half of the peak to
peak of the roll so found over the last whole period is the amplitude (spec/dtg section 3).
"""

from dataclasses import dataclass, replace
import math

import numpy as np

from .gyro_pair import GyroPair
from .orientation import dcm_of, euler_vector, poisson, roll
from .attitude import exponential
from .tuned_gyro import PRESETS, state_space
from .tuned_gyro_step import rk4_matrices

AMPLITUDE_DEG = 10.0
STEP_S = 0.75e-3
SPEED_TABLE_RAD_S = 1.0
# what the paper prints: amplitude in deg by rad/s of the base (230 Hz) and by Hz of the rotor
PAPER_FREQUENCY_TABLE = ((0.5, 10.0), (1.0, 9.92), (2.0, 9.65), (4.0, 8.83), (8.0, 6.8))
PAPER_SPEED_TABLE = ((130.0, 9.98), (143.0, 9.97), (170.0, 9.95), (200.0, 9.93), (250.0, 9.89),
                     (270.0, 9.88), (320.0, 9.83), (337.0, 9.81))
PAPER_LIMITS_HZ = (130.0, 337.0)


@dataclass(frozen=True)
class Cell:
    """
    One cell of a table.

    value: rad/s of the base or Hz of the rotor; poisson_deg, euler_vector_deg: amplitude by each
    algorithm; paper_deg: what the paper prints, or None.
    """

    value: float
    poisson_deg: float
    euler_vector_deg: float
    paper_deg: float | None


def half_peak_to_peak(y):
    """Return half of the range of samples, each vertex from the parabola through 3 points."""
    def highest(v):
        k = min(max(range(len(v)), key=v.__getitem__), len(v) - 2) or 1
        slope, bend = 0.5 * (v[k + 1] - v[k - 1]), v[k + 1] - 2.0 * v[k] + v[k - 1]
        return v[k] - (0.5 * slope * slope / bend if bend < 0.0 else 0.0)
    return 0.5 * (highest(y) + highest([-v for v in y]))


def rocking_amplitudes(pair, rate_rad_s, step_s, method='rk4'):
    """
    Return the amplitudes of roll, deg, recovered by Poisson and by the Euler vector.

    pair: GyroPair at rest, of the step and method; rate_rad_s: w of the base.  The record is 20 s
    or three periods, whichever is longer.
    """
    period = 2.0 * math.pi / rate_rad_s
    steps = math.ceil(max(20.0, 3.0 * period) / step_s)
    first = steps - math.ceil(period / step_s)
    top = math.radians(AMPLITUDE_DEG) * rate_rad_s
    c, theta = dcm_of((0.0, 0.0, 0.0, 1.0)), (0.0, 0.0, 0.0)
    found, staged = ([], []), method == 'rk4'
    u_end = (top, 0.0, 0.0)
    for k in range(steps):
        u_start = u_end
        u_mid = (top * math.cos(rate_rad_s * (k + 0.5) * step_s), 0.0, 0.0)
        u_end = (top * math.cos(rate_rad_s * (k + 1) * step_s), 0.0, 0.0)
        if staged:
            rates = pair.step_stages(u_start, u_mid, u_end)
        else:
            rates = (pair.step(u_start, u_mid, u_end)[0],) * 4
        c, theta = poisson(c, rates, step_s), euler_vector(theta, rates, step_s)
        if k >= first:
            found[0].append(roll(c))
            found[1].append(roll(dcm_of(exponential(theta))))
    return tuple(math.degrees(half_peak_to_peak(y)) for y in found)


def _table(cases, paper, step_s, method, progress):
    cells, printed = [], dict(paper)
    for k, (value, parameters, rate_rad_s) in enumerate(cases):
        pair = GyroPair(parameters, step_s, method=method)
        cells.append(Cell(value, *rocking_amplitudes(pair, rate_rad_s, step_s, method),
                          printed.get(value)))
        if progress:
            progress(k + 1, len(cases))
    return tuple(cells)


def frequency_table(parameters=PRESETS['paper'], rates_rad_s=None, step_s=STEP_S, method='rk4',
                    progress=None):
    """
    Return a Cell for each rate of the base, by default those of the paper.

    progress: function of (cells done, cells in all).  Raises ValueError for an unstable gyro.
    """
    rates_rad_s = rates_rad_s or [w for w, _ in PAPER_FREQUENCY_TABLE]
    cases = [(w, parameters, w) for w in rates_rad_s]
    return _table(cases, PAPER_FREQUENCY_TABLE, step_s, method, progress)


def at_speed(parameters, speed_hz):
    """Return the parameters with read-out and hinges made for another speed."""
    return replace(parameters, speed_hz=speed_hz, hinge_stiffness_n_m_rad=None)


def speed_table(parameters=PRESETS['paper'], speeds_hz=None, step_s=STEP_S, method='rk4',
                progress=None):
    """Return a Cell for each speed of the rotor, tuned there, the base rocking at 1 rad/s."""
    speeds_hz = speeds_hz or [hz for hz, _ in PAPER_SPEED_TABLE]
    cases = [(hz, at_speed(parameters, hz), SPEED_TABLE_RAD_S) for hz in speeds_hz]
    return _table(cases, PAPER_SPEED_TABLE, step_s, method, progress)


def rk4_radius(parameters, speed_hz, step_s):
    """Return the spectral radius of the matrix of one RK4 step at a speed, tuned there."""
    space = state_space(at_speed(parameters, speed_hz))
    n = len(space.g)
    return float(np.abs(np.linalg.eigvals(rk4_matrices(space, step_s)[0][:n, :n])).max())


def stability_limits(parameters=PRESETS['paper'], step_s=STEP_S, low_hz=20.0, high_hz=2000.0,
                     resolution_hz=1.0, tolerance_hz=1e-6):
    """
    Return the lowest and the highest speed about the nominal one at which RK4 decays, Hz.

    Walks from the nominal speed by resolution_hz and bisects; None on a side where no limit lies
    between low_hz and high_hz.  Raises ValueError where the nominal speed itself is unstable.
    """
    def decays(hz):
        return rk4_radius(parameters, hz, step_s) < 1.0

    start = parameters.speed_hz
    if not decays(start):
        raise ValueError(f'speed_hz is {start:g}, at which RK4 with {1e3 * step_s:g} ms grows; '
                         'expected a speed between the limits')
    limits = []
    for stride, end in ((-resolution_hz, low_hz), (resolution_hz, high_hz)):
        inside, outside = start, start + stride
        while decays(outside) and min(start, end) <= outside <= max(start, end):
            inside, outside = outside, outside + stride
        if decays(outside):
            limits.append(None)
            continue
        while abs(outside - inside) > tolerance_hz:
            middle = 0.5 * (inside + outside)
            inside, outside = (middle, outside) if decays(middle) else (inside, middle)
        limits.append(inside)
    return tuple(limits)
