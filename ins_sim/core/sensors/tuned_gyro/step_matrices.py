"""
Matrices of one step of a tuned gyro.

At constant speed the gyro is linear, so that a step, exact or RK4, is one set of matrices: the
state at the end and the mean reading of the interval are linear in the state at its start and in
the rates at its start, middle and end.  Exact steps take the rate between these as the parabola
(``quadratic``) or the straight line (``linear``) through them (docs/theory/tuned_gyro.md).
"""

from dataclasses import replace

import numpy as np

from ins_sim.core.numerics.fixed_order import exponential, product

METHODS = ('exact', 'rk4')
HOLDS = ('quadratic', 'linear')


def exact_matrices(space, dt_s, hold):
    """
    Return the map (n + 1, n + 3) of one exact step: next state and mean reading.

    Columns: state at the start, rates at start, middle, end.  Matrix exponential of the system
    augmented by the integral of the reading and by the rate's derivatives (Van Loan 1978).
    """
    n = len(space.g)
    big = np.zeros((n + 4, n + 4), dtype=complex)
    big[:n, :n] = space.f * dt_s
    big[:n, n + 1] = space.g * dt_s
    big[n, :n], big[n, n + 1] = space.c, space.d
    big[n + 1, n + 2] = big[n + 2, n + 3] = 1.0
    power = exponential(big)[:n + 1]
    by_value, by_slope, by_bend = power[:, n + 1], power[:, n + 2], power[:, n + 3]
    if hold == 'linear':
        start, middle, end = by_value - by_slope, 0.0 * by_slope, by_slope
    else:
        start = by_value - 3.0 * by_slope + 4.0 * by_bend
        middle = 4.0 * by_slope - 8.0 * by_bend
        end = 4.0 * by_bend - by_slope
    return np.column_stack((power[:, :n], start, middle, end))


def rk4_matrices(space, dt_s):
    """
    Return the map of one RK4 step and the map (4, n + 3) of the readings at its four stages.

    The classical Runge-Kutta step of a linear system is linear: this is it, column by column.
    """
    n = len(space.g)
    start, middle, end = np.eye(n + 3)[n:]
    state = np.eye(n, n + 3).astype(complex)

    def rates(at, u):
        return product(space.f, at) + product(space.g[:, None], u[None])

    k1 = rates(state, start)
    k2 = rates(at2 := state + 0.5 * dt_s * k1, middle)
    k3 = rates(at3 := state + 0.5 * dt_s * k2, middle)
    k4 = rates(at4 := state + dt_s * k3, end)
    stages = np.concatenate([product(space.c[None], at) + space.d * u for at, u in
                             ((state, start), (at2, middle), (at3, middle), (at4, end))])
    mean = (stages[0] + 2.0 * stages[1] + 2.0 * stages[2] + stages[3]) / 6.0
    return np.vstack((state + dt_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4), mean)), stages


def disturbance_matrix(table, space, dt_s, step_map):
    """
    Return what disturbances add to one step, (n + 1, 3): next state and mean reading.

    Columns: a moment and a pick-off error, constant over the step, and a jump of the latter at its
    start.  table: the map of the step; step_map: function (StateSpace) -> map, linear in g and d,
    whose three rate columns add up to the answer to a constant input.
    """
    n = len(space.g)
    columns = []
    for g, d in ((space.moment, 0.0j), (space.tilt, space.tilt_reading)):
        start, middle, end = step_map(replace(space, g=g, d=d))[:, n:].T
        columns.append(start + middle + end)
    jump = product(table[:, :n], space.jump[:, None])[:, 0]
    jump[n] += space.jump_reading / dt_s
    return np.column_stack((*columns, jump))
