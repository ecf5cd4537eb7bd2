"""One run of the delay study: simulated with its zero-delay twin, and predicted."""

from dataclasses import dataclass, replace

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.navigation import whole_run
from ins_sim.core.navigation.errors import NO_DRIFT
from ins_sim.core.numerics import compilation, elementary
from ins_sim.core.prediction.predict import predict
from ins_sim.core.simulation.inertial import simulate
from ins_sim.settings.imu import DelaysUs
from ins_sim.settings.simulation import SimulationSettings

# One instant a second for an hour.
MOST_INSTANTS = 3601
AXES = ('x', 'y', 'z')


@dataclass(frozen=True, eq=False)
class ErrorFigures:
    """
    Summary of an error history.

    Attributes
    ----------
    drift : (3,) least-squares slope of the inertial attitude error, East, North, Up, rad/s
    mean_drift : (3,) growth of this error over the run divided by the time, rad/s
    largest : (3,) largest |position error|, East, North, Up, m
    """

    drift: np.ndarray
    mean_drift: np.ndarray
    largest: np.ndarray


@dataclass(frozen=True, eq=False)
class DelaySensitivity:
    """
    Error due to one second of delay of each gyro channel, by the linear theory.

    The last axis of each array is the delayed channel, x, y, z.

    Attributes
    ----------
    position : (n, 2, 3) position error East, North at the instants of the run, m/s
    drift : (3, 3) slope of the attitude error, East, North, Up, 1/s^2
    largest : (2, 3) largest |position error|, East, North, m/s
    """

    position: np.ndarray
    drift: np.ndarray
    largest: np.ndarray


@dataclass(frozen=True, eq=False)
class DelayRun:
    """
    One run with delays.

    Attributes
    ----------
    settings : SimulationSettings of the run
    t_s : (n,) at most MOST_INSTANTS instants since the start of the navigation, s
    track : (n, 3) true latitude and longitude, rad, and height, m
    angles : (n, 2) computed minus true latitude and longitude, rad
    predicted_angles : (n, 2) the same by the linear theory, rad
    apart : (n, 3) position error minus that of the twin, East, North, Up, m
    predicted : (n, 3) the same by the linear theory, m
    measured : ErrorFigures of the run, with its position error minus that of the twin
    twin : ErrorFigures of the twin
    prediction : ErrorFigures of the linear theory
    sensitivity : DelaySensitivity or None
    """

    settings: SimulationSettings
    t_s: np.ndarray
    track: np.ndarray
    angles: np.ndarray
    predicted_angles: np.ndarray
    apart: np.ndarray
    predicted: np.ndarray
    measured: ErrorFigures
    twin: ErrorFigures
    prediction: ErrorFigures
    sensitivity: DelaySensitivity | None = None


def fly_run(settings, motion=None, with_sensitivity=False):
    """
    Simulate and predict a run of SimulationSettings and return the DelayRun.

    motion: a recorded one, or None for that of the settings; with_sensitivity: whether to predict
    the error of each channel alone too.
    """
    generator = settings.motion_generator
    motion = motion or make_motion(generator.motion, generator.datum, generator.earth)
    flown = simulate(settings, motion)
    truth, errors, twin = flown.truth, flown.errors, flown.twin
    if len(errors) < 2:
        raise ValueError(f'strapdown: output_every is {settings.strapdown.output_every}, which '
                         'leaves one instant of the run; expected at least two')
    t_s = (errors.t_ns - errors.t_ns[0]) * 1e-9
    growth = _Growth(t_s, truth, ellipsoid.rotation_rate(generator.earth.rotation))
    predicted = _at(t_s, predict(settings, motion))
    apart = errors.position - twin.position
    angles = np.stack([flown.states.lat - truth.lat, flown.states.lon - truth.lon], axis=-1)
    kept = np.unique(np.round(np.linspace(0, len(t_s) - 1, min(len(t_s), MOST_INSTANTS))
                              ).astype(int))
    sensitivity = None
    if with_sensitivity:
        sensitivity = _sensitivity(settings, motion, t_s, growth, kept)
    return DelayRun(
        settings, t_s[kept], np.stack([truth.lat, truth.lon, truth.height], -1)[kept],
        angles[kept], _as_angles(truth, predicted.position)[kept], apart[kept],
        predicted.position[kept], growth.figures(errors.attitude, apart),
        growth.figures(twin.attitude, twin.position),
        growth.figures(predicted.attitude, predicted.position), sensitivity)


@dataclass(frozen=True, eq=False)
class _Histories:
    """Attitude and position errors (n, 3)."""

    attitude: np.ndarray
    position: np.ndarray


def _at(t_s, prediction):
    """Interpolate the histories of a Prediction, which are smooth, at other instants."""
    return _Histories(*(np.stack([np.interp(t_s, prediction.t_s, column) for column in values.T],
                                 axis=-1)
                        for values in (prediction.attitude, prediction.position)))


def _as_angles(truth, position):
    """Convert position errors (n, 3) to latitude and longitude (n, 2), rad."""
    s, c = elementary.sincos(truth.lat)
    return np.stack(ellipsoid.level_angles(position[:, 0], position[:, 1], s, c, truth.height)[:2],
                    axis=-1)


class _Growth:
    """Growth of attitude errors at the instants t_s (n,) of a Truth; spin: rate of the Earth."""

    def __init__(self, t_s, truth, spin):
        self._t_s, self._truth, self._spin = t_s, truth, spin

    def figures(self, attitude, position):
        """Return the ErrorFigures of attitude and position errors (n, 3)."""
        rows = np.zeros((len(self._t_s), whole_run.JUDGED))
        rows[:, 4:7] = attitude
        slopes = np.empty((len(self._t_s), 3))
        carry = compilation.run(
            whole_run.drifts, len(self._t_s),
            (NO_DRIFT, self._spin, self._t_s, self._truth.lat, self._truth.lon, rows), slopes)
        return ErrorFigures(slopes[-1], np.array(carry[1]) / self._t_s[-1],
                            np.abs(position).max(axis=0))


def _sensitivity(settings, motion, t_s, growth, kept):
    """Return the DelaySensitivity, from the prediction for one microsecond on each channel."""
    sensor, found = settings.imu_sensor, []
    for axis in AXES:
        alone = replace(settings, imu_sensor=replace(
            sensor, gyro=replace(sensor.gyro, delay_us=DelaysUs(**{axis: 1.0}))))
        histories = _at(t_s, predict(alone, motion))
        found.append((histories.position, growth.figures(histories.attitude, histories.position)))
    per_s = 1e6
    return DelaySensitivity(
        per_s * np.stack([position[kept, :2] for position, _ in found], axis=-1),
        per_s * np.stack([figures.drift for _, figures in found], axis=-1),
        per_s * np.stack([figures.largest[:2] for _, figures in found], axis=-1))
