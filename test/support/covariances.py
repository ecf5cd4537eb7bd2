"""Covariance of a free INS compared with Monte Carlo: settings, prediction, ensemble."""

from dataclasses import replace

import numpy as np

from ins_sim import parameter_files, resources
from ins_sim.core.ensemble.many_runs import simulate_runs
from ins_sim.core.navigation.error_dynamics import GROWING, turn_by_position
from ins_sim.core.simulation.free_covariance import free_covariance
from ins_sim.core.simulation.inertial import imu_blocks, navigate_blocks
from ins_sim.io.motion import read_motion

FILES = {'rest': [], 'racetrack': ['racetrack', 'delays_2_1_3us'],
         'motion_2': ['motion_2', 'delay_y_1us']}
REST = {'motion.kind': 'static', 'motion.theta_deg': 0.0}
SIGMAS = {'initial.position_sigma_m': 1.0, 'initial.velocity_sigma_m_s': 0.05,
          'initial.tilt_sigma_mrad': 0.3, 'initial.azimuth_sigma_mrad': 1.5}


def settings_of(motion, instrument, seconds, **values):
    """Return SimulationSettings of a motion (key of FILES), an instrument file and a duration."""
    files = [resources.parameter_file(name) for name in (*FILES[motion], instrument)]
    return parameter_files.read(files, {
        'duration_s': seconds, **(REST if motion == 'rest' else {}), **values})


def without_errors(settings):
    """Return the settings with a perfect sensor; the error model of the strapdown is kept."""
    sensor = settings.imu_sensor
    perfect = {name: replace(getattr(sensor, name), errors=type(getattr(sensor, name).errors)())
               for name in ('gyro', 'accelerometer')}
    return replace(settings, imu_sensor=replace(sensor, **perfect))


def steps_of(settings, cut=lambda imu: [imu], loop=navigate_blocks):
    """
    Return [(t_ns, P, mean, solution)] of a run; cut: function that divides each block of samples.
    """
    found = []
    free = free_covariance(settings.strapdown, lambda free: found.append(
        (free.t_ns, free.p, free.mean, free.solution)))
    motion = read_motion(settings.motion_generator)
    for _ in loop(settings.strapdown, motion,
                  (part for imu in imu_blocks(settings, motion) for part in cut(imu)),
                  covariance=free):
        pass
    return found


def sigmas_at(step):
    """
    Return the standard deviations (9,) of inertial attitude, velocity and position at a step.
    """
    _, p, mean, (lat, _, height, _, _) = step
    turn = np.eye(GROWING)
    turn[6, 1], turn[7, 0], turn[8, 0] = turn_by_position(lat, height)
    whole = turn @ (p[:GROWING, :GROWING] + np.outer(mean, mean)) @ turn.T
    return np.sqrt(np.diag(whole))[[6, 7, 8, 3, 4, 5, 0, 1, 2]]


def drawn_initial(settings):
    """Return a function of the run number that draws initial errors from the sigmas of Initial."""
    initial = settings.strapdown.initial

    def drawn(run):
        place, velocity, turn = np.random.default_rng(run).normal(size=(3, 3))
        turn *= 1e-3 * np.array([initial.tilt_sigma_mrad] * 2 + [initial.azimuth_sigma_mrad])
        return replace(initial, attitude_error_deg=tuple(np.degrees(turn).tolist()),
                       velocity_error_m_s=tuple((initial.velocity_sigma_m_s * velocity).tolist()),
                       position_error_m=tuple((initial.position_sigma_m * place).tolist()))

    return drawn


def ratios(settings, instants_s, runs=60):
    """
    Return predicted sigma divided by Monte Carlo sigma, (instants, 9): attitude, velocity,
    position.

    The errors of the runs are rms values about the truth, not about their mean.
    """
    ensemble = simulate_runs(settings, read_motion(settings.motion_generator), range(runs),
                             instants_s, initial=drawn_initial(settings))
    statistics = ensemble.statistics
    assert statistics.count.tolist() == [runs] * len(instants_s)
    variance = np.diagonal(statistics.covariance, axis1=1, axis2=2) * (runs - 1.0) / runs
    rms = np.sqrt(variance + statistics.mean ** 2)
    steps = steps_of(without_errors(settings))
    stamps = np.array([step[0] for step in steps])
    last = np.searchsorted(stamps, 1e9 * np.array(instants_s) + 0.5) - 1
    with np.errstate(divide='ignore'):
        # A held vertical channel has no error, so the divisor may be zero.
        return np.array([sigmas_at(steps[k]) for k in last]) / rms
