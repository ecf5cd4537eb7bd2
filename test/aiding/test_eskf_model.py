"""
Every matrix of the linear error models of the aiding filters is compared with finite differences.

The differences are between flights with and without an added error. The tests run for all filters
of the table that name states; a new filter of the table is checked without a change here. Errors
are added with the filter's own ``correct``, so that its signs are checked too.
"""

import math

from ins_sim.core.aiding.corrected_strapdown import CorrectedStrapdown
from ins_sim.core.aiding.filters import eskf_model
from ins_sim.core.aiding.filters.base import AidingFilter
from ins_sim.core.aiding.filters.eskf import ErrorStateFilter
from ins_sim.core.aiding.navigator import filter_class
from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.errors import position_error
from ins_sim.core.timeseries.fixes import GnssFix, VelocityFix
from ins_sim.settings.aided_navigator import AidedNavigatorSettings, FILTERS
from ins_sim.settings.catalogue import build
import numpy as np
import pytest

LAT, LON, HEIGHT = math.radians(55.0), math.radians(37.0), 500.0
STEP_S, STEPS = 0.01, 10
TIME_S = STEP_S * STEPS
FORCE = (0.4, -0.6, 9.9)
LEVER = (2.0, -1.0, 0.5)
CASES = {'cruise': ((150.0, 130.0, 0.0), 0.3, (0.0, 0.0, 0.001)),
         'climbing turn': ((-180.0, 60.0, 12.0), 2.1, (0.01, 0.02, 0.02))}
LINEAR = [name for name in FILTERS if filter_class(name).states]
# Errors that are added: large enough for rounding, small enough for linearity.
SIZES = {'position': 10.0, 'velocity': 0.1, 'attitude': 1e-4, 'accelerometer_bias': 1e-3,
         'acceleration': 1e-3, 'gyro_bias': 1e-5}
OWN_SIZE = 1e-4
# Absolute bounds in addition to a relative one, for the effect of the added error: rounding, and
# for the vertical velocity the change of gravity with latitude and with the square of height,
# which the model neglects. For the mean velocity: third order in time, over the window length.
FLOORS = {'position': 2e-7, 'velocity': 1e-11, 'velocity_u': 2e-8, 'attitude': 1e-13,
          'accelerometer_bias': 1e-15, 'acceleration': 1e-15, 'gyro_bias': 1e-17}
MEAN_FLOOR = 2e-8 / TIME_S
# Terms of second order in time are summed over ten steps, so that they are accurate to a tenth.
GRAIN = 1.2 / STEPS
# The strapdown resolves an increment in the axes at the start of a step: error of rate x step.
STEP_GRAIN = 1e-3


class Flight:
    """A filter of a class on a short flight; ``settings.filter`` does not matter to a filter."""

    def __init__(self, cls, case):
        velocity, yaw, self._omega = case
        q_nb = quaternion.multiply(quaternion.exponential((0.0, 0.0, yaw)),
                                   quaternion.exponential((0.02, -0.05, 0.0)))
        self.ins = CorrectedStrapdown(0, (0.0,) * 3, (0.0,) * 3, STEP_S,
                                      (LAT, LON, HEIGHT, velocity, q_nb),
                                      ellipsoid.ROTATION_RATE, False)
        # The covariance is not propagated while the flight lasts.
        settings = build(AidedNavigatorSettings, {'vertical.channel': 'free',
                                                  'covariance_every': 10 * STEPS})
        self.filter = cls(settings, self.ins)
        self.filter.estimates = (0.006, 0.01, -0.03)

    def with_error(self, k, size):
        """Return a copy with an error of state k."""
        other = object.__new__(Flight)
        other._omega, other.ins, other.filter = self._omega, self.ins.copy(), self.filter.copy()
        x = [0.0] * len(self.filter.states)
        x[k] = -size
        other.filter.correct(other.ins, x)
        return other

    def fly(self):
        """Advance over STEPS samples."""
        for k in range(1, STEPS + 1):
            before = self.ins.q_nb, self.ins.v_b, self.ins.v
            u = self.ins.take(k * 10_000_000, self._omega, FORCE)
            self.filter.step(self.ins, before, u, STEP_S)
        return self

    def velocity(self):
        """Return innovation and matrix of a fix of the velocity meter."""
        return self.filter.velocity_model(self.ins, VelocityFix(
            0, round(1e9 * TIME_S), STEPS, (201.0, -7.0), (1.0, 1.0)))

    def gnss(self, nominal):
        """Return innovation and matrix of a GNSS fix; a gyro bias changes the rate as well."""
        ins = nominal.ins
        rate = np.subtract(ins.rate_to_earth, np.subtract(self.ins.gyro_bias, ins.gyro_bias))
        return self.filter.gnss_model(self.ins, GnssFix(
            ins.t_ns, ins.lat, ins.lon, ins.height, ins.v, (1.0,) * 3, (1.0,) * 3),
            tuple(rate.tolist()), LEVER)


def errors(one, other):
    """Return the errors of one strapdown relative to another, by the name of the state."""
    a, b = one.solution, other.solution
    found = {'position_enu': position_error(*a[:3], *b[:3]),
             'velocity_enu': np.subtract(a[3], b[3]),
             'attitude_enu': quaternion.logarithm(
                 quaternion.multiply(a[4], quaternion.conjugate(b[4]))),
             'gyro_bias_xyz': np.subtract(one.gyro_bias, other.gyro_bias)}
    bias = np.subtract(one.accelerometer_bias, other.accelerometer_bias)
    found['accelerometer_bias_xyz'], found['acceleration_xyz'] = bias, -bias
    return {name[:-3] + axis: value for name, values in found.items()
            for axis, value in zip(name[-3:], values)}


def size_of(state):
    """Return the size of the error to add to a state."""
    return SIZES.get(state.rpartition('_')[0], OWN_SIZE)


def check_transition(cls, case):
    """Compare each column of the transition matrix with central differences; return the worst."""
    start = Flight(cls, case)
    nominal = start.with_error(0, 0.0).fly()
    phi, states, worst = nominal.filter.transition(nominal.ins), cls.states, 0.0
    assert phi.shape == (len(states),) * 2
    for k, size in enumerate(map(size_of, states)):
        plus, minus = (start.with_error(k, s).fly() for s in (size, -size))
        up, down = (errors(flight.ins, nominal.ins) for flight in (plus, minus))
        for row, state in enumerate(states):
            if state not in up:
                continue
            part = abs(phi[row, k] - (row == k)) * size
            floor = FLOORS.get(state, FLOORS.get(state.rpartition('_')[0]))
            bound = GRAIN * part + floor + cls.neglected * TIME_S * size
            apart = abs(0.5 * (up[state] - down[state]) - phi[row, k] * size)
            assert apart <= bound, (state, states[k], apart, part)
            worst = max(worst, apart / bound)
        # The rows of the filter's own states are checked through their effect on the innovation.
        _, h = nominal.velocity()
        expected, of_now = h[:, k], 0.0
        if cls.observed_at == 'end':
            expected, of_now = (h @ phi)[:, k], h[:, k]
        grain = GRAIN if cls.observed_at == 'end' else STEP_GRAIN
        apart = np.abs(0.5 * (plus.velocity()[0] - minus.velocity()[0]) - expected * size)
        bound = (grain * np.abs(expected - of_now) * size + MEAN_FLOOR
                 + cls.neglected * TIME_S * size)
        assert (apart <= bound).all(), ('innovation', states[k], apart, expected * size)
        worst = max(worst, (apart / bound).max())
    return worst


def check_present(cls, case, model):
    """Compare a matrix of the present errors with central differences; return it."""
    nominal = Flight(cls, case).fly()
    z, h = model(nominal, nominal)
    assert h.shape == (len(z), len(cls.states))
    for k, size in enumerate(map(size_of, cls.states)):
        up, down = (model(nominal.with_error(k, s), nominal)[0] for s in (size, -size))
        # Rounding of 6e6 m relative to the change, and the curvature of the Earth over 10 m.
        np.testing.assert_allclose((up - down) / (2.0 * size), h[:, k], rtol=1e-6,
                                   atol=1e-9 + 1e-11 / size, err_msg=cls.states[k])
    return h


def velocity_model(flight, nominal):
    """Return innovation and matrix of the velocity meter."""
    return flight.velocity()


@pytest.mark.parametrize('case', CASES.values(), ids=CASES)
@pytest.mark.parametrize('name', LINEAR)
def test_transition_is_the_derivative_of_the_strapdown(name, case):
    """The transition over ten samples agrees with differences; a wrong sign would show (GRAIN)."""
    worst = check_transition(filter_class(name), case)
    print(f'{name}: largest deviation, in parts of its bound: {worst:.3f}')


@pytest.mark.parametrize('case', CASES.values(), ids=CASES)
@pytest.mark.parametrize('name', [n for n in LINEAR if filter_class(n).observed_at == 'end'])
def test_velocity_matrix_is_the_derivative_of_the_innovation(name, case):
    """
    The matrix of the velocity meter agrees with differences with respect to present errors.

    Errors at the start of the window are covered by the test above.
    """
    check_present(filter_class(name), case, velocity_model)


@pytest.mark.parametrize('case', CASES.values(), ids=CASES)
@pytest.mark.parametrize('name', [n for n in LINEAR if FILTERS[n].takes_gnss])
def test_gnss_matrix_is_the_derivative_of_the_innovation(name, case):
    """Position and velocity of the antenna agree with differences, including its lever arm."""
    check_present(filter_class(name), case, Flight.gnss)


def test_every_filter_with_a_covariance_is_checked():
    """A filter that reports standard deviations names its states, so that it is checked."""
    weighing = [name for name in FILTERS
                if filter_class(name).sigmas is not AidingFilter.sigmas]
    assert weighing == LINEAR and {'window_kf', 'eskf'} <= set(LINEAR)


def test_the_eskf_observes_what_it_should():
    """The meter depends on five states; GNSS on position, velocity, attitude and gyro bias."""
    case = CASES['climbing turn']
    for model, observed in (
            (velocity_model, ('eta_x', 'eta_y', 'mounting', 'scale_x', 'scale_z')),
            (Flight.gnss, [s for s in eskf_model.STATES if s.startswith(
                ('position', 'velocity', 'attitude', 'gyro_bias'))])):
        h = check_present(ErrorStateFilter, case, model)
        assert [s for s, column in zip(eskf_model.STATES, h.T) if column.any()] == list(observed)


class WrongTransition(ErrorStateFilter):
    """The sign of one coupling, attitude to velocity, is wrong."""

    def transition(self, ins):
        """Return a wrong matrix."""
        phi = super().transition(ins)
        phi[eskf_model.V, eskf_model.PHI] *= -1.0
        return phi


class WrongMean(ErrorStateFilter):
    """The sign of the effect of a velocity error on the mean velocity is wrong."""

    def transition(self, ins):
        """Return a wrong matrix."""
        phi = super().transition(ins)
        phi[eskf_model.ETA, eskf_model.V] *= -1.0
        return phi


class WrongMeter(ErrorStateFilter):
    """The mounting error has the wrong sign."""

    def velocity_model(self, ins, fix):
        """Return a wrong matrix."""
        z, h = super().velocity_model(ins, fix)
        h[:, eskf_model.MU] *= -1.0
        return z, h


class WrongAntenna(ErrorStateFilter):
    """The lever arm is left out of the matrix."""

    def gnss_model(self, ins, fix, rate, lever):
        """Return a wrong matrix."""
        z, h = super().gnss_model(ins, fix, rate, lever)
        h[0:3, eskf_model.PHI] = 0.0
        return z, h


@pytest.mark.parametrize('cls, check, more', [
    (WrongTransition, check_transition, ()), (WrongMean, check_transition, ()),
    (WrongMeter, check_present, (velocity_model,)), (WrongAntenna, check_present, (Flight.gnss,))])
def test_a_wrong_matrix_is_found(cls, check, more):
    """The check of a matrix fails if one entry of this matrix is wrong."""
    with pytest.raises(AssertionError):
        check(cls, CASES['climbing turn'], *more)
