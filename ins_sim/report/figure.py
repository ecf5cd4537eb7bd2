"""The figure of a run: position, attitude and drift errors over time."""

import numpy as np

from .plotting import (COLOURS, finish_panel, MOST_POINTS, new_figure, save_png,
                       thinned)
from .summary import DEG_PER_HOUR

MARGINS = {'left': 0.12, 'right': 0.98, 'bottom': 0.06, 'top': 0.94, 'hspace': 0.08}


def save_figure(path, title, errors, prediction=None):
    """Save the figure as PNG; errors: NavErrors, prediction: Prediction or None."""
    errors = thinned(errors)
    t_min = (errors.t_ns - errors.t_ns[0]) * 1e-9 / 60.0
    if prediction is not None:
        every = max(20, len(prediction.t_s) // MOST_POINTS)
        t_predicted, predicted = prediction.t_s[::every] / 60.0, prediction.position[::every]
    figure = new_figure(9, 9, MARGINS)
    top, middle, bottom = figure.subplots(3, 1, sharex=True)
    for axis, name in enumerate(('east', 'north')):
        top.plot(t_min, errors.position[:, axis], color=COLOURS[name], label=f'{name}, measured')
        if prediction is not None:
            top.plot(t_predicted, predicted[:, axis], 'k--', lw=1,
                     label='linear prediction' if axis else None)
    for axis, name in enumerate(COLOURS):
        middle.plot(t_min, np.degrees(errors.attitude[:, axis]) * 3600.0, color=COLOURS[name],
                    label=name)
        bottom.plot(t_min, errors.drift[:, axis] * DEG_PER_HOUR, color=COLOURS[name], label=name)
        if prediction is not None:
            bottom.axhline(prediction.drift[axis] * DEG_PER_HOUR, color='k', ls='--', lw=1,
                           label='prediction' if axis == 2 else None)
    # the slope of the first seconds is no drift yet: scale by what follows
    settled = errors.drift[len(errors.t_ns) // 20:] * DEG_PER_HOUR
    if prediction is not None:
        settled = np.concatenate([settled, prediction.drift[None] * DEG_PER_HOUR])
    low, high = float(settled.min()), float(settled.max())
    margin = 0.15 * (high - low) or 1e-9
    bottom.set_ylim(low - margin, high + margin)
    for axes, label in ((top, 'position error [m]'),
                        (middle, 'inertial attitude error [arcsec]'),
                        (bottom, 'drift since the start [deg/h]')):
        finish_panel(axes, label)
    bottom.set_xlabel('time [min]')
    figure.suptitle(title)
    save_png(figure, path)
