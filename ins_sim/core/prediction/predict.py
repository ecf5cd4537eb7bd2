"""Predicted drift and position error of a run, by the linear theory."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.rates import rate_of_n
from ins_sim.core.motion.motion import check_length
from ins_sim.core.numerics.garbage_collection import paused_in_blocks
from ins_sim.core.timeseries.collecting import Collected
from ins_sim.core.timeseries.histories import History
from .drift import (_nanoseconds, _to_n, BLOCK, channel_drift, delayed, exact_pair,
                    LateAttitudeError, mean_drift, PairAttitudeError, STEP_S, SUBSAMPLES,
                    two_axis_resonances)
from .error_model import ErrorModel


@dataclass(frozen=True, eq=False)
class PredictedErrors(History):
    """Predicted errors: t_s (n,) since the start; attitude (n, 3), rad; position (n, 3), m."""

    t_s: np.ndarray
    attitude: np.ndarray
    position: np.ndarray

    def __len__(self):
        return len(self.t_s)


@dataclass(frozen=True)
class Prediction:
    """
    What the linear theory expects of a run.

    drift (3,) rad/s, East, North, Up; t_s (n,) since the start; position (n, 3) and attitude
    (n, 3): error histories, m and rad; largest (3,): the largest |position|, m; resonances: list
    of (name, rate of psi rad/s, drift there (3,) rad/s).
    """

    drift: np.ndarray
    t_s: np.ndarray
    attitude: np.ndarray
    position: np.ndarray
    largest: np.ndarray
    resonances: list


def predict(settings, motion, collect=Collected) -> Prediction:
    """
    Return the Prediction of SimulationSettings.

    motion: that of settings.motion_generator; collect: as of ``core.simulation.inertial``, or None
    to do without t_s, attitude and position, which then are None.  Raises ValueError where the
    settings name no run of finite length, NoPrediction for rotors that only RK4 damps.
    """
    check_length(settings.motion_generator, motion)
    run = _FineRun(settings, motion)
    store, largest = None if collect is None else collect(), np.zeros(3)
    for block in run.blocks():
        largest = np.maximum(largest, np.abs(block.position).max(axis=0))
        if store is not None:
            store.append(block)
    errors = PredictedErrors(None, None, None) if store is None else store.history()
    return Prediction(run.drift(), errors.t_s, errors.attitude, errors.position, largest,
                      two_axis_resonances(settings.motion_generator.motion, run.tau))


class _FineRun:
    """The errors on a fine grid over the run, block by block."""

    def __init__(self, settings, motion):
        generator, nav = settings.motion_generator, settings.strapdown
        self._motion, self._gyro = motion, settings.imu_sensor.gyro
        self.tau = np.array(self._gyro.delay_us.in_ns()) * 1e-9
        self._tau_f = np.array(settings.imu_sensor.accelerometer.delay_us.in_ns()) * 1e-9
        self._rotation, self._initial = generator.earth.rotation, nav.initial
        self._gravity = ellipsoid.GRAVITY_TERMS[nav.earth.gravity]
        self._start_s = generator.start_s + nav.initial.after_s
        self._span_s = generator.duration_s - nav.initial.after_s
        self._steps = int(self._span_s / STEP_S)
        if self._steps < 1:
            raise ValueError(f'the run navigates for {self._span_s:g} s; expected more than '
                             f'{STEP_S:g} s')
        self._last_beta = None
        self._fine_s = STEP_S / SUBSAMPLES
        if self._gyro.model == 'ideal':
            late = LateAttitudeError(self.tau, self._fine_s)
            self._beta = lambda truth, omega_in, first: late.advance(truth, omega_in)
        else:
            # The interval as the difference of the instants has it.
            count = self._steps * SUBSAMPLES
            step_s = (self._instant_s(count) - self._instant_s(0)) / count
            pair = PairAttitudeError(motion, self._gyro, self.tau, self._start_s, step_s)
            self._beta = lambda truth, omega_in, first: pair.advance(first, len(truth) - 1)

    def _instant_s(self, k):
        return self._start_s + self._fine_s * k

    @paused_in_blocks
    def blocks(self):
        """Yield PredictedErrors at the steps of STEP_S."""
        initial, last = self._initial, self._steps * SUBSAMPLES
        turned = np.radians(initial.attitude_error_deg)
        model = ErrorModel(self._fine_s, SUBSAMPLES, self._rotation, initial.position_error_m,
                           initial.velocity_error_m_s, self._gravity)
        for first in range(0, last, BLOCK):
            stop = min(first + BLOCK, last)
            # The slope of the specific force needs an instant on either side.
            before, behind = min(1, first), min(1, last - stop)
            k = np.arange(first - before, stop + behind + 1)
            truth = self._motion.at(_nanoseconds(self._instant_s(k)))
            inside = slice(before, len(k) - behind)
            slope = np.gradient(truth.f_ib_b, self._fine_s, axis=0)[inside]
            truth = truth[inside]
            omega_in = rate_of_n(truth.lat, truth.height, truth.v_n, self._rotation)
            # Attitude error in n without the turning of n.
            beta = self._beta(truth, omega_in, first)
            self._last_beta = beta[-1]
            attitude, position = model.advance(truth, omega_in, _to_n(truth, truth.f_ib_b),
                                               beta + turned, -_to_n(truth, slope * self._tau_f))
            # The first step of a block is the last of the one before.
            kept = slice(before, None)
            steps = np.arange(first // SUBSAMPLES, stop // SUBSAMPLES + 1)
            yield PredictedErrors(STEP_S * steps[kept], attitude[kept], position[kept])

    def drift(self):
        """Return the mean drift (3,), rad/s, once the blocks have been made."""
        motion, tau = self._motion, self.tau
        if self._gyro.model == 'ideal':
            return mean_drift(motion, tau, self._rotation, self._start_s, self._span_s)
        if not motion.period_s:
            return self._last_beta / self._span_s
        response = exact_pair(self._gyro, self._fine_s).response
        return channel_drift(motion, lambda w: delayed(
            response(w), np.multiply.outer(w, tau)[:, None, :]))
