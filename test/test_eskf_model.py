"""Every Jacobian of the aided navigator against finite differences of the equations themselves."""

import math

from ins_sim.core.aiding.filters import eskf_model
from ins_sim.core.attitude import matrix, quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.aiding.corrected_strapdown import CorrectedStrapdown
from ins_sim.core.navigation.errors import position_error
import numpy as np
import pytest

SPIN = ellipsoid.ROTATION_RATE
LAT, LON, HEIGHT = math.radians(55.0), math.radians(37.0), 500.0
STEP_S, STEPS = 0.01, 10
# what is moved, so far that the difference is not rounding and so little that it is linear
SIZES = np.array([10.0] * 3 + [0.1] * 3 + [1e-4] * 3 + [1e-3] * 3 + [1e-5] * 3)
# Bounds of a row beside a tenth of the entry, for the effect of the change: rounding, and of V_U
# the change of gravity with latitude and the square of height, which F leaves out.
FLOORS = np.array([2e-7] * 3 + [1e-11, 1e-11, 2e-8] + [1e-13] * 3 + [2e-8] * 2)
# a step of ten is the grain of what is of second order in time
GRAIN = 1.2 / 10


def start(velocity, q_nb, change=np.zeros(15)):
    """Return a strapdown with errors added at its start."""
    ins = CorrectedStrapdown(0, (0.0,) * 3, (0.0,) * 3, STEP_S,
                             (LAT, LON, HEIGHT, velocity, q_nb), SPIN, False)
    ins.correct(-change[0:3], -change[3:6], tuple((-change[6:9]).tolist()))
    # the error of a bias is estimate less truth
    ins.add_biases(gyro=change[12:15].tolist(), accelerometer=change[9:12].tolist())
    return ins


def fly(ins, omega, force):
    """
    Advance over STEPS; return the integral of the velocity in b, m, and the mean force in n.

    An increment is resolved in b at the start of its step.
    """
    path, mean = np.zeros(2), np.zeros(3)
    for k in range(1, STEPS + 1):
        before = ins.v_b
        mean += np.array(quaternion.rotate(ins.q_nb, force)) / STEPS
        ins.advance(k * 10_000_000, omega, force, ())
        path += 0.5 * STEP_S * (np.array(before[:2]) + ins.v_b[:2])
    return path, mean


def difference(one, other):
    """Return dp, dV, phi of a solution less another."""
    a, b = one.solution, other.solution
    turned = quaternion.logarithm(quaternion.multiply(a[4], quaternion.conjugate(b[4])))
    return np.concatenate([position_error(*a[:3], *b[:3]), np.subtract(a[3], b[3]), turned])


CASES = {'cruise': ((150.0, 130.0, 0.0), 0.3, (0.0, 0.0, 0.001)),
         'climbing turn': ((-180.0, 60.0, 12.0), 2.1, (0.01, 0.02, 0.02))}


@pytest.mark.parametrize('velocity, yaw, omega', CASES.values(), ids=CASES)
def test_transition_is_the_derivative_of_the_strapdown(velocity, yaw, omega):
    """
    Columns of exp(F dt), eta included, against central differences over ten steps.

    A wrong sign of any term would be twice its part of the entry; see FLOORS and GRAIN.
    """
    q_nb = quaternion.multiply(quaternion.exponential((0.0, 0.0, yaw)),
                               quaternion.exponential((0.02, -0.05, 0.0)))
    force = (0.4, -0.6, 9.9)
    nominal = start(velocity, q_nb)
    v_start, q_start = nominal.v, nominal.q_nb
    _, mean = fly(nominal, omega, force)
    dt = STEP_S * STEPS
    q_mid = quaternion.normalise(tuple(0.5 * (a + b) for a, b in zip(q_start, nominal.q_nb)))
    v_mid = tuple(0.5 * (a + b) for a, b in zip(v_start, nominal.v))
    f = eskf_model.dynamics(LAT, HEIGHT, v_mid, matrix.matrix(q_mid), mean, SPIN)
    phi = eskf_model.transition(f, dt)
    worst = 0.0
    for k, size in enumerate(SIZES):
        change = np.zeros(15)
        change[k] = size
        plus, minus = start(velocity, q_nb, change), start(velocity, q_nb, -change)
        ways = [fly(ins, omega, force)[0] for ins in (plus, minus)]
        measured = np.concatenate([
            (difference(plus, nominal) - difference(minus, nominal)) / (2.0 * size),
            (ways[0] - ways[1]) / (2.0 * size)])
        expected = np.concatenate([phi[0:9, k], phi[eskf_model.ETA, k]])
        identity = np.eye(17)[k, [*range(9), 15, 16]]
        apart, part = np.abs(measured - expected) * size, np.abs(expected - identity) * size
        bound = GRAIN * part + FLOORS
        assert (apart <= bound).all(), (k, apart, part)
        worst = max(worst, (apart / bound).max())
    print(f'largest deviation, in parts of its bound: {worst:.3f}')


def test_meter_matrix_is_the_derivative_of_its_prediction():
    """H of mean, mu, kx, kz against central differences; bound: rounding over the step."""
    mean, mu, kx, kz, t = np.array((201.0, -7.0)), 0.006, 0.01, -0.03, 10.0
    _, h = eskf_model.meter_matrix(mean, mu, kx, kz, t)

    def read(x):
        return eskf_model.meter_matrix(mean + x[:2] / t, mu + x[2], kx + x[3], kz + x[4], t)[0]

    columns = [15, 16, eskf_model.MU, eskf_model.KX, eskf_model.KZ]
    for k, column in enumerate(columns):
        x = np.zeros(5)
        x[k] = 1e-4
        measured = (read(x) - read(-x)) / 2e-4
        np.testing.assert_allclose(measured, h[:, column], rtol=1e-7, atol=1e-6)
    assert np.count_nonzero(h.any(axis=0)) == len(columns)


def test_gnss_matrix_is_the_derivative_of_the_antenna():
    """H of the antenna's position and velocity against differences of attitude and rate."""
    q_nb = quaternion.exponential((0.1, -0.2, 0.7))
    lever, omega = np.array((2.0, -1.0, 0.5)), np.array((0.1, -0.2, 0.3))
    h = eskf_model.gnss_matrix(matrix.matrix(q_nb), lever, omega)

    def antenna(phi, bias):
        q = quaternion.multiply(quaternion.exponential(tuple(phi)), q_nb)
        # a gyro bias estimated too large makes the rate too small
        rate = omega - bias
        return np.concatenate([quaternion.rotate(q, tuple(lever)),
                               quaternion.rotate(q, tuple(np.cross(rate, lever)))])

    for k in range(3):
        x = np.zeros(3)
        x[k] = 1e-5
        for columns, one, other in ((eskf_model.PHI, antenna(x, 0 * x), antenna(-x, 0 * x)),
                                    (eskf_model.BG, antenna(0 * x, x), antenna(0 * x, -x))):
            np.testing.assert_allclose((one - other) / 2e-5, h[:, columns][:, k], atol=1e-9)
    np.testing.assert_array_equal(h[0:3, eskf_model.P], np.eye(3))
    np.testing.assert_array_equal(h[3:6, eskf_model.V], np.eye(3))
