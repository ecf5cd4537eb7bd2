"""
Matrices of one step of a tuned gyro.

At constant speed the gyro is linear, so a step, exact or RK4, is a set of matrices: the state at
the end and the mean reading over the interval are linear in the state at the start and in the
rates at start, middle and end. For exact steps the rate between these three points is the parabola
through them (``quadratic``) or the straight line from start to end (``linear``)
(docs/theory/tuned_gyro.md).
"""

from dataclasses import replace

import numpy as np

from ins_sim.core.numerics.fixed_order import exponential, product

METHODS = ('exact', 'rk4')
HOLDS = ('quadratic', 'linear')


def exact_matrices(space, dt_s, hold):
    """
    Return the matrix (n + 1, n + 3) of one exact step.

    Rows are the next state and the mean reading; columns are the state at the start and the rates
    at start, middle and end. It is the matrix exponential of the system augmented by the integral
    of the reading and by the derivatives of the rate (Van Loan 1978).

    Parameters
    ----------
    space : StateSpace
    dt_s : step, s
    hold : quadratic or linear
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
    Return the matrix of one RK4 step, and the matrix (4, n + 3) of the readings at its stages.

    The classical Runge-Kutta step of a linear system is linear; it is evaluated column by column.
    Rows and columns are those of `exact_matrices`.
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
    Return the effect of disturbances on one step, (n + 1, 3).

    Rows are the next state and the mean reading. Columns are a moment and a pick-off error, both
    constant over the step, and a jump of the pick-off error at the start of the step.

    Parameters
    ----------
    table : matrix of the step
    space : StateSpace
    dt_s : step, s
    step_map : function (StateSpace) -> matrix of the step, linear in g and d; its three rate
        columns add up to the response to a constant input
    """
    n = len(space.g)
    columns = []
    for g, d in ((space.moment, 0.0j), (space.tilt, space.tilt_reading)):
        start, middle, end = step_map(replace(space, g=g, d=d))[:, n:].T
        columns.append(start + middle + end)
    jump = product(table[:, :n], space.jump[:, None])[:, 0]
    jump[n] += space.jump_reading / dt_s
    return np.column_stack((*columns, jump))
