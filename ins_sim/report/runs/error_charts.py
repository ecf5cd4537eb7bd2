"""Charts of the errors of a strapdown over time: position, attitude, drift."""

import numpy as np

from ..charts.chart import Chart, Curve, DASHED, Level, Panel
from ..charts.palette import BLACK, EAST_NORTH_UP
from ..charts.scales import ANGLES, LENGTHS, scale, TIMES
from ..summary import DEG_PER_HOUR
from .curves import history_curves, HistoryDifference, interpolated

NAMES = tuple(EAST_NORTH_UP)
# Measured and predicted curves that differ by less than this part of the largest error look equal.
CLOSE = 0.05


def error_chart(title, errors, prediction=None):
    """
    Return the Chart of NavErrors.

    ``prediction`` is a Prediction that covers all error sources of the run, or None. It is drawn
    if it is larger than the bound of the neglected second-order terms.
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
    Return the Chart of the effect of the delays: NavErrors minus those of the zero-delay twin.

    ``prediction`` is the Prediction of this difference, or None.
    """
    curves = history_curves(HistoryDifference(errors, twin), {
        'position': lambda block: block.position, 'attitude': lambda block: block.attitude})
    clock = _clock(errors.t_ns)
    return Chart('delays', f'{title}: effect of the delays, run minus zero-delay twin', (
        *_positions(curves['position'], clock, _telling(prediction)),
        _attitude(curves['attitude'], clock)))


def _clock(t_ns):
    """Return a function from ns to seconds since the start, a factor from s, and a label."""
    start_ns, last_ns = int(t_ns[0]), int(t_ns[len(t_ns) - 1])
    factor, unit = scale(TIMES, (last_ns - start_ns) * 1e-9)
    return lambda t_ns: (t_ns - start_ns) * 1e-9, factor, f'time [{unit}]'


def _telling(prediction):
    """Return a Prediction, or None if it is below the bound of the neglected terms."""
    if prediction is None or not prediction.largest.max() > prediction.position_bound:
        return None
    return prediction


def _positions(curves, clock, prediction):
    """Return the panels of a position error: measured and predicted, and their difference."""
    predicted = [] if prediction is None else [
        interpolated(clock[0](t), prediction.t_s, prediction.position, axis)
        for axis, (t, _) in enumerate(curves[:2])]
    return [_position(curves, clock, predicted), *_residual(curves, clock, predicted)]


def _shown(curves):
    """Return the axes of a position error to draw; up is omitted if it is always zero."""
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
    """Return the panel of measured minus predicted, unless the difference is visible above."""
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
        # The slope of the first seconds is not a drift yet; do not scale the axis to it.
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
