"""Offline simulation, and prediction by linear theory."""

from __future__ import annotations

from collections.abc import Callable
from typing import Optional

import numpy as np

from ins_sim.core.motion.motion import Motion
from ins_sim.core.prediction.predict import predict as predict_errors, Prediction
from ins_sim.core.simulation import aided as aided_simulation, guided_flight, inertial
from ins_sim.io.motion import read_motion
from ins_sim.settings.simulation import AidedSimulationSettings, SimulationSettings
from .results import AidedRun, Run

Progress = Optional[Callable[[float], None]]


def simulate(settings: SimulationSettings, twin: bool = True, progress: Progress = None,
             motion: Motion | None = None) -> Run:
    """
    Simulate a motion, the IMU and the strapdown navigation, and compare it with the truth.

    Parameters
    ----------
    settings : SimulationSettings
        From ``read_settings``.
    twin : bool, optional
        Whether to repeat the run with all channel delays set to zero, if there are any. The
        difference shows what the delays alone cause.
    progress : callable, optional
        Called with the fraction done, 0 to 1.
    motion : Motion, optional
        A motion of your own, used instead of the one in the settings.

    Returns
    -------
    Run

    Raises
    ------
    ValueError
        If the settings describe no run of finite length or no valid motion, or if your motion
        returns arrays of a wrong shape or values that are not finite.

    Examples
    --------
    >>> import ins_sim
    >>> settings = ins_sim.read_settings(['motion_2', 'delay_y_1us'], {'duration_s': 10.0})
    >>> run = ins_sim.simulate(settings)
    >>> run.errors.position.shape
    (1001, 3)
    >>> bool(abs(run.twin.position).max() < abs(run.errors.position).max())
    True
    """
    check_settings(settings, SimulationSettings)
    return _simulate(settings, None, twin, progress, motion)


def _simulate(settings: SimulationSettings, aided: AidedSimulationSettings | None, twin: bool,
              progress: Progress, motion: Motion | None) -> Run:
    """Steer a guided motion by the aided solution, or by the strapdown, and simulate it."""
    flown = given_motion(settings, motion)
    steered = guided_flight.fly(settings, flown, aided, progress)
    result = inertial.simulate(settings, flown, twin, progress)
    return Run(settings, flown, result, motion is not None, steered)


def predict(settings: SimulationSettings, motion: Motion | None = None) -> Prediction:
    """
    Predict drift and errors that gyro channel delays cause, by linear theory.

    Nothing is simulated. Instrument errors are not included.

    Parameters
    ----------
    settings : SimulationSettings
        From ``read_settings``.
    motion : Motion, optional
        A motion of your own, used instead of the one in the settings.

    Returns
    -------
    Prediction
        Its attributes include ``drift`` (3,), rad/s; ``t_s`` (n,), s; ``attitude`` (n, 3), rad;
        ``position`` (n, 3), m, in the order East, North, Up; and ``drift_bound``, rad/s, and
        ``position_bound``, m, the bounds of the terms that the theory neglects.

    Raises
    ------
    ValueError
        If the settings describe no run of finite length, or no prediction is possible.

    Examples
    --------
    >>> import ins_sim
    >>> settings = ins_sim.read_settings(['motion_2', 'delay_y_1us'], {'duration_s': 60.0})
    >>> east, north, up = ins_sim.predict(settings).drift
    >>> f'{east * 180 / 3.141592653589793 * 3600:.4f} deg/h'
    '0.0335 deg/h'
    """
    check_settings(settings, SimulationSettings)
    return predict_errors(settings, given_motion(settings, motion))


def simulate_aided(settings: AidedSimulationSettings, twin: bool = True,
                   progress: Progress = None, motion: Motion | None = None) -> AidedRun:
    """
    Simulate motion, IMU, strapdown, velocity meter, GNSS and the aided navigator.

    Parameters
    ----------
    settings : AidedSimulationSettings
        From ``read_settings(..., aided=True)``.
    twin : bool, optional
        Whether to repeat the unaided part with all channel delays set to zero, if there are any.
    progress : callable, optional
        Called with the fraction done, 0 to 1, for each part in turn: steering (guided motions
        only), unaided part, aided part.
    motion : Motion, optional
        A motion of your own, used instead of the one in the settings.

    Returns
    -------
    AidedRun

    Raises
    ------
    ValueError
        As ``simulate``, and if the settings of an aiding sensor contradict others.

    Examples
    --------
    >>> import ins_sim
    >>> settings = ins_sim.read_settings(['route_flight', 'grade_mid'],
    ...                                  {'duration_s': 3.0, 'window.cycles': 100}, aided=True)
    >>> run = ins_sim.simulate_aided(settings)
    >>> len(run.velocity_fixes), run.errors.position_sigma.shape[1]
    (3, 3)
    """
    check_settings(settings, AidedSimulationSettings)
    instruments = aided_simulation.make_instruments(settings)
    run = _simulate(settings.simulation, settings, twin, progress, motion)
    result = aided_simulation.simulate_aided(settings, instruments, run.motion, run.result,
                                             progress)
    return AidedRun(settings, run, result)


def check_settings(settings: object, expected: type) -> None:
    """Raise ValueError unless settings are of the expected class."""
    if not isinstance(settings, expected):
        aided = expected is AidedSimulationSettings
        raise ValueError(f'settings are {type(settings).__name__}; expected {expected.__name__} '
                         f'of read_settings(..., aided={aided})')


def given_motion(settings: SimulationSettings, motion: Motion | None) -> Motion:
    """Return the motion of the settings or, after a check, the given one."""
    generator = settings.motion_generator
    if motion is None:
        return read_motion(generator)
    if not isinstance(motion, Motion):
        raise ValueError(f'motion is {type(motion).__name__}; expected an object of a subclass '
                         'of ins_sim.Motion')
    truth = motion.at(np.array([round(generator.start_s * 1e9)], dtype=np.int64))
    for name, values in truth.arrays().items():
        size = {'v_n': (3,), 'q_nb': (4,), 'omega_ib_b': (3,), 'f_ib_b': (3,)}.get(name, ())
        if np.shape(values) != (1, *size):
            raise ValueError(f'motion.at gives {name} of shape {np.shape(values)} for one '
                             f'instant; expected {(1, *size)}')
        if not np.isfinite(values).all():
            raise ValueError(f'motion.at gives {name} {values[0]} at {generator.start_s:g} s; '
                             'expected finite numbers')
    return motion
