"""Predicted drift and position error of a run, by linear theory."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.rates import rate_of_n
from ins_sim.core.motion.motion import check_length
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.numerics.garbage_collection import paused_in_blocks
from ins_sim.core.timeseries.collecting import Collected
from ins_sim.core.timeseries.histories import History
from .drift import (_nanoseconds, _to_n, BLOCK, channel_drift, delay_response, delayed,
                    exact_pair, LateAttitudeError, mean_drift, PairAttitudeError, STEP_S,
                    SUBSAMPLES, two_axis_resonances)
from .error_model import ErrorModel
from .late_turns import is_long, late_force, late_turns, LateTurns


@dataclass(frozen=True, eq=False)
class PredictedErrors(History):
    """
    Predicted errors.

    Attributes
    ----------
    t_s : (n,) times since the start, s
    attitude : (n, 3) attitude errors, rad
    position : (n, 3) position errors, m

    """

    t_s: np.ndarray
    attitude: np.ndarray
    position: np.ndarray

    def __len__(self):
        return len(self.t_s)


@dataclass(frozen=True)
class Prediction:
    """
    Prediction of a run by linear theory.

    Attributes
    ----------
    drift : (3,) mean drift, east, north, up, rad/s
    t_s : (n,) time since the start
    position, attitude : (n, 3) error histories, m and rad
    largest : (3,) largest magnitude of the position error, m
    resonances : list of (name, rate of psi in rad/s, drift there (3,) in rad/s)
    turned : largest attitude error, rad
    drift_bound, position_bound : bounds of the effects that linear theory leaves out, rad/s and m

    """

    drift: np.ndarray
    t_s: np.ndarray
    attitude: np.ndarray
    position: np.ndarray
    largest: np.ndarray
    resonances: list
    turned: float
    drift_bound: float
    position_bound: float


def predict(settings, motion, collect=Collected) -> Prediction:
    """
    Predict drift and errors of a run by linear theory.

    Parameters
    ----------
    settings : SimulationSettings
    motion : Motion, that of settings.motion_generator
    collect : see ``core.simulation.inertial.simulate``; with None, t_s, attitude and position of
        the Prediction are None

    Raises
    ------
    ValueError : if the run has no finite length
    NoPrediction : for rotors that are unstable with the exact method, which is always used here

    """
    check_length(settings.motion_generator, motion)
    run = _FineRun(settings, motion)
    store, largest = None if collect is None else collect(), np.zeros(3)
    turned = far = bound = 0.0
    for block in run.blocks():
        largest = np.maximum(largest, np.abs(block.position).max(axis=0))
        turned = max(turned, _longest(block.attitude))
        far = max(far, _longest(block.position))
        bound = max(bound, run.second_order(turned, far))
        if store is not None:
            store.append(block)
    errors = PredictedErrors(None, None, None) if store is None else store.history()
    return Prediction(run.drift(), errors.t_s, errors.attitude, errors.position, largest,
                      two_axis_resonances(settings.motion_generator.motion, run.tau), turned,
                      run.drift_bound(turned), bound)


def _along_parallels(position, lat):
    """
    Convert position errors (n, 3) in the tangent plane to those that a simulation measures.

    These are east along the parallel and north along the meridian at latitudes (n,)
    (``navigation.errors.position_error``). The conversion is to second order: a great circle that
    starts eastwards leaves the parallel by d^2 tan(lat) / 2R.
    """
    s, c = elementary.sincos(lat)
    per_r = s / c / ellipsoid.MEAN_RADIUS
    east, north = position[:, 0], position[:, 1]
    return np.stack([east * (1.0 + north * per_r), north - 0.5 * east * east * per_r,
                     position[:, 2]], axis=-1)


def _longest(vectors):
    """Return the largest length among vectors (n, 3)."""
    return float(length(vectors).max())


class _FineRun:
    """The errors on a fine time grid over the run, block by block."""

    def __init__(self, settings, motion):
        generator, nav = settings.motion_generator, settings.strapdown
        self._motion, self._gyro = motion, settings.imu_sensor.gyro
        self._tau_ns = self._gyro.delay_us.in_ns()
        self._tau_f_ns = settings.imu_sensor.accelerometer.delay_us.in_ns()
        self.tau, self._tau_f = np.array(self._tau_ns) * 1e-9, np.array(self._tau_f_ns) * 1e-9
        self._rotation, self._initial = generator.earth.rotation, nav.initial
        self._gravity = ellipsoid.GRAVITY_TERMS[nav.earth.gravity]
        self._start_s = generator.start_s + nav.initial.after_s
        self._span_s = generator.duration_s - nav.initial.after_s
        self._steps = int(self._span_s / STEP_S)
        if self._steps < 1:
            raise ValueError(f'the run navigates for {self._span_s:g} s; expected more than '
                             f'{STEP_S:g} s')
        self._last_beta, self._swept, self._steepest = None, np.zeros(3), 0.0
        self._fine_s = STEP_S / SUBSAMPLES
        sensor = settings.imu_sensor
        self._held_ns = (round(1e9 * generator.start_s) if sensor.history == 'frozen' else None)
        self._turns = late_turns(settings, motion)
        if self._gyro.model == 'ideal':
            late = LateAttitudeError(self._turns.at, self._fine_s)
            self._beta = lambda truth, omega_in, first: late.advance(truth, omega_in)
        else:
            # Compute the interval as the difference of the instants, with the same rounding.
            count = self._steps * SUBSAMPLES
            step_s = (self._instant_s(count) - self._instant_s(0)) / count
            pair = PairAttitudeError(motion, self._gyro, self.tau, self._start_s, step_s,
                                     self._held_ns)
            self._beta = lambda truth, omega_in, first: pair.advance(first, len(truth) - 1)

    def _instant_s(self, k):
        return self._start_s + self._fine_s * k

    @paused_in_blocks
    def blocks(self):
        """Yield PredictedErrors at steps of STEP_S."""
        initial, last = self._initial, self._steps * SUBSAMPLES
        turned = np.radians(initial.attitude_error_deg)
        model = ErrorModel(self._fine_s, SUBSAMPLES, self._rotation, initial.position_error_m,
                           initial.velocity_error_m_s, self._gravity)
        for first in range(0, last, BLOCK):
            stop = min(first + BLOCK, last)
            # The derivative of the specific force needs an instant on either side.
            before, behind = min(1, first), min(1, last - stop)
            k = np.arange(first - before, stop + behind + 1)
            truth = self._motion.at(_nanoseconds(self._instant_s(k)))
            inside = slice(before, len(k) - behind)
            slope = np.gradient(truth.f_ib_b, self._fine_s, axis=0)[inside]
            truth = truth[inside]
            s, c = elementary.sincos(truth.lat)
            self._steepest = max(self._steepest, float(abs(s / c).max()))
            omega_in = rate_of_n(truth.lat, truth.height, truth.v_n, self._rotation)
            # Attitude error in n, without the effect of the rotation of n.
            beta = self._beta(truth, omega_in, first)
            self._last_beta = beta[-1]
            self._swept += np.add.reduce(
                np.cross(beta[:-1] + turned, np.diff(beta, axis=0)), axis=0)
            df_n = -_to_n(truth, slope * self._tau_f)
            if is_long(self._tau_f_ns):
                df_n = _to_n(truth, late_force(self._motion, truth.t_ns, self._tau_f_ns,
                                               self._held_ns))
            attitude, position = model.advance(truth, omega_in, _to_n(truth, truth.f_ib_b),
                                               beta + turned, df_n)
            # Only for long delays. For short delays published results must not change by a bit;
            # their ``position_bound`` includes this effect.
            if self._turns.long:
                position = _along_parallels(position, truth.lat[::SUBSAMPLES])
            # The first step of a block is the last one of the previous block.
            kept = slice(before, None)
            steps = np.arange(first // SUBSAMPLES, stop // SUBSAMPLES + 1)
            yield PredictedErrors(STEP_S * steps[kept], attitude[kept], position[kept])

    def second_order(self, turned, far):
        """
        Return a bound, m, of the terms of second order in the largest errors, rad and m.

        For a rotation, by the attitude error or by the position error divided by the radius of the
        Earth, they are at most half the rotation times the position error. In addition, position
        errors are measured along parallels and meridians (``_along_parallels``).
        """
        angle = far / ellipsoid.MEAN_RADIUS
        return 0.5 * far * (turned + angle * (1.0 + 2.0 * self._steepest))

    def drift_bound(self, turned):
        """
        Return a bound, rad/s, of the terms of second order in the drift.

        If the attitude error grows by e, its rotation vector grows by e + error x e / 2; the
        second term is the area that the vector sweeps. turned: largest error, rad, for the next
        order.
        """
        return 0.5 * float(length(self._swept)) / self._span_s * (1.0 + turned)

    def drift(self):
        """Return the mean drift (3,), rad/s, after all blocks have been computed."""
        motion, tau = self._motion, self.tau
        if self._gyro.model == 'ideal':
            if self._turns.long and motion.period_s:
                return channel_drift(motion, [delay_response(t) for t in tau], self._start_s)
            return mean_drift(motion, LateTurns(motion, self._tau_ns, 0).at, self._rotation,
                              self._start_s, self._span_s)
        if not motion.period_s:
            return self._last_beta / self._span_s
        response = exact_pair(self._gyro, self._fine_s).response
        return channel_drift(motion, lambda w: delayed(
            response(w), np.multiply.outer(w, tau)[:, None, :]))
