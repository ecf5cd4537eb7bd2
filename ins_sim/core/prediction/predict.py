"""Predicted drift and position error of a run, by the linear theory."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.earth.rates import rate_of_n
from ins_sim.core.motion.motion import check_length
from .drift import (_nanoseconds, _to_n, channel_drift, exact_pair, late_attitude_error,
                    mean_drift, pair_attitude_error, STEP_S, SUBSAMPLES, two_axis_resonances)
from .error_model import propagate_errors


@dataclass(frozen=True)
class Prediction:
    """
    What the linear theory expects of a run.

    drift (3,) rad/s, East, North, Up; t_s (n,) since the start; position (n, 3) and attitude
    (n, 3): error histories, m and rad; resonances: list of (name, rate of psi rad/s, drift there
    (3,) rad/s).
    """

    drift: np.ndarray
    t_s: np.ndarray
    attitude: np.ndarray
    position: np.ndarray
    resonances: list


def predict(settings, motion) -> Prediction:
    """
    Return the Prediction of SimulationSettings.

    motion: that of settings.motion_generator.  Raises ValueError where the settings name no run
    of finite length, NoPrediction for rotors that only RK4 damps.
    """
    generator, sensor, nav = (settings.motion_generator, settings.imu_sensor, settings.strapdown)
    check_length(generator, motion)
    rotation = generator.earth.rotation
    tau = np.array(sensor.gyro.delay_us.in_ns()) * 1e-9
    tau_f = np.array(sensor.accelerometer.delay_us.in_ns()) * 1e-9
    start_s = generator.start_s + nav.initial.after_s
    span_s = generator.duration_s - nav.initial.after_s
    steps = int(span_s / STEP_S)
    if steps < 1:
        raise ValueError(f'the run navigates for {span_s:g} s; expected more than {STEP_S:g} s')
    fine_s = STEP_S / SUBSAMPLES
    t = start_s + fine_s * np.arange(steps * SUBSAMPLES + 1)
    truth = motion.at(_nanoseconds(t))
    omega_in = rate_of_n(truth.lat, truth.height, truth.v_n, rotation)
    # attitude error in n without the turning of n
    if sensor.gyro.model == 'ideal':
        beta = late_attitude_error(truth, omega_in, tau, fine_s)
        drift = mean_drift(motion, tau, rotation, start_s, span_s)
    else:
        beta = pair_attitude_error(motion, sensor.gyro, tau, t)
        drift = beta[-1] / span_s
        if motion.period_s:
            response = exact_pair(sensor.gyro, fine_s).response
            drift = channel_drift(motion, lambda w: response(w) * np.exp(
                -1j * np.multiply.outer(w, tau))[:, None, :])
    beta += np.radians(nav.initial.attitude_error_deg)
    f_n = _to_n(truth, truth.f_ib_b)
    df_n = -_to_n(truth, np.gradient(truth.f_ib_b, fine_s, axis=0) * tau_f)
    errors = propagate_errors(truth, omega_in, f_n, beta, df_n, fine_s, SUBSAMPLES, rotation,
                              nav.initial.position_error_m, nav.initial.velocity_error_m_s)
    return Prediction(drift, STEP_S * np.arange(steps + 1), *errors,
                      two_axis_resonances(generator.motion, tau))
