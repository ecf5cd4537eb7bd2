"""The errors of a strapdown over time, as a Chart: position, attitude, drift."""

import numpy as np

from ..charts.chart import Chart, Curve, DASHED, Level, Panel
from ..charts.palette import BLACK, EAST_NORTH_UP
from ..charts.scales import ANGLES, LENGTHS, scale, TIMES
from ..summary import DEG_PER_HOUR
from .curves import history_curves, HistoryDifference, interpolated

NAMES = tuple(EAST_NORTH_UP)
# Measured and predicted coincide where they differ by less than this part of the largest error.
CLOSE = 0.05


def error_chart(title, errors, prediction=None):
    """
    Return the Chart of NavErrors.

    prediction: Prediction that covers all that makes an error in the run, or None. It is drawn
    where it is larger than what the linear theory may leave out.
    """
    curves = history_curves(errors, {
        'position': lambda block: block.position, 'attitude': lambda block: block.attitude,
        'drift': lambda block: block.drift})
    clock = _clock(errors.t_ns)
    prediction = _telling(prediction)
    return Chart('errors', f'{title}: errors of the strapdown', (
        *_positions(curves['position'], clock, prediction),
        _attitude(curves['attitude'], clock), _drift(curves['drift'], clock, prediction)))


def delay_chart(title, errors, twin, prediction=None):
    """
    Return the Chart of what the delays cause: NavErrors less those of the zero-delay twin.

    prediction: Prediction of the difference, or None.
    """
    curves = history_curves(HistoryDifference(errors, twin), {
        'position': lambda block: block.position, 'attitude': lambda block: block.attitude})
    clock = _clock(errors.t_ns)
    return Chart('delays', f'{title}: what the delays cause, run less zero-delay twin', (
        *_positions(curves['position'], clock, _telling(prediction)),
        _attitude(curves['attitude'], clock)))


def _clock(t_ns):
    """Return seconds since the start as a function of ns, a factor from s, and a label."""
    start_ns, last_ns = int(t_ns[0]), int(t_ns[len(t_ns) - 1])
    factor, unit = scale(TIMES, (last_ns - start_ns) * 1e-9)
    return lambda t_ns: (t_ns - start_ns) * 1e-9, factor, f'time [{unit}]'


def _telling(prediction):
    """Return a Prediction, or None where it is no larger than what the theory may leave out."""
    if prediction is None or not prediction.largest.max() > prediction.position_bound:
        return None
    return prediction


def _positions(curves, clock, prediction):
    """Return the panels of a position error: it and its prediction, and what this leaves."""
    predicted = [] if prediction is None else [
        interpolated(clock[0](t), prediction.t_s, prediction.position, axis)
        for axis, (t, _) in enumerate(curves[:2])]
    return [_position(curves, clock, predicted), *_residual(curves, clock, predicted)]


def _shown(curves):
    """Return the axes of a position error that are drawn: up is zero where a height is given."""
    return [axis for axis, (_, values) in enumerate(curves) if axis < 2 or np.any(values)]


def largest(curves):
    """Return the largest magnitude in curves [(t, values), ...], or 0."""
    return max((float(np.abs(values).max()) for _, values in curves if len(values)), default=0.0)


def _position(curves, clock, predicted):
    seconds, per, label = clock
    shown = _shown(curves)
    factor, unit = scale(LENGTHS, largest([curves[axis] for axis in shown]))
    marks = [Curve(seconds(t) * per, values * factor, NAMES[axis], EAST_NORTH_UP[NAMES[axis]])
             for axis, (t, values) in enumerate(curves) if axis in shown]
    for axis, values in enumerate(predicted):
        marks.append(Curve(seconds(curves[axis][0]) * per, values * factor,
                           None if axis else 'linear prediction', BLACK, DASHED, 1.0))
    return Panel(tuple(marks), label, f'position error [{unit}]')


def _residual(curves, clock, predicted):
    """Return the panel of what the prediction leaves, unless this can be seen above."""
    seconds, per, label = clock
    left = [(t[np.isfinite(expected)], (values - expected)[np.isfinite(expected)])
            for (t, values), expected in zip(curves, predicted)]
    most = largest(left)
    if not 0.0 < most < CLOSE * largest(curves[:2]):
        return []
    factor, unit = scale(LENGTHS, most)
    return [Panel(tuple(
        Curve(seconds(t) * per, values * factor, name, EAST_NORTH_UP[name])
        for name, (t, values) in zip(NAMES, left)), label, f'less prediction [{unit}]',
        height=0.7)]


def _attitude(curves, clock):
    seconds, per, label = clock
    factor, unit = scale(ANGLES, largest(curves))
    return Panel(tuple(
        Curve(seconds(t) * per, values * factor, name, EAST_NORTH_UP[name])
        for name, (t, values) in zip(NAMES, curves)), label, f'inertial attitude error [{unit}]')


def _drift(curves, clock, prediction):
    seconds, per, label = clock
    marks, settled = [], []
    for name, (t, values) in zip(NAMES, curves):
        values = values * DEG_PER_HOUR
        marks.append(Curve(seconds(t) * per, values, name, EAST_NORTH_UP[name]))
        # The slope of the first seconds is no drift yet: the scale is that of what follows.
        settled.append(values[seconds(t) >= 0.05 * seconds(t[-1])])
    if prediction is not None:
        for axis, value in enumerate(prediction.drift * DEG_PER_HOUR):
            marks.append(Level(y=float(value), label=None if axis else 'linear prediction',
                               colour=BLACK, dash=DASHED))
            settled.append([value])
    settled = np.concatenate(settled)
    low, high = float(settled.min()), float(settled.max())
    margin = 0.15 * (high - low) or 1e-9
    return Panel(tuple(marks), label, 'drift since the start [deg/h]',
                 y_range=(low - margin, high + margin))
