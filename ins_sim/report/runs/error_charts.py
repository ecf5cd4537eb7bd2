"""The errors of a strapdown over time, as a Chart: position, attitude, drift."""

import numpy as np

from ..charts.chart import Chart, Curve, DASHED, Level, Panel
from ..charts.palette import BLACK, EAST_NORTH_UP
from ..charts.scales import ANGLES, LENGTHS, scale, TIMES
from ..summary import DEG_PER_HOUR
from .curves import history_curves, interpolated

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
    start_ns = int(errors.t_ns[0])
    factor, unit = scale(TIMES, (int(errors.t_ns[len(errors) - 1]) - start_ns) * 1e-9)

    def seconds(t_ns):
        return (t_ns - start_ns) * 1e-9

    clock = (seconds, factor, f'time [{unit}]')
    if prediction is not None and not prediction.largest.max() > prediction.position_bound:
        prediction = None
    position = curves['position']
    predicted = [] if prediction is None else [
        interpolated(seconds(t), prediction.t_s, prediction.position, axis)
        for axis, (t, _) in enumerate(position[:2])]
    panels = [_position(position, clock, predicted), *_residual(position, clock, predicted)]
    panels += [_attitude(curves['attitude'], clock), _drift(curves['drift'], clock, prediction)]
    return Chart('errors', f'{title}: errors of the strapdown', tuple(panels))


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
