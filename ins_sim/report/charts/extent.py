"""Ranges of the axes of a panel."""

import numpy as np

from .chart import Band, Bars, Curve, Level, LOG, Map, Stack, Stretch

# Part of the range that is left free on either side.
MARGIN = 0.04


def positive(values, scale):
    """Return values as floats; on a logarithmic axis values that are not positive become NaN."""
    values = np.asarray(values, dtype=float)
    return np.where(values > 0.0, values, np.nan) if scale == LOG else values


def horizontal_range(panels):
    """Return (left, right) of the data of panels with a common horizontal axis."""
    given = next((panel.x_range for panel in panels if panel.x_range), None)
    if given:
        return given
    scale = panels[0].x_scale
    found = [_horizontal(mark) for panel in panels for mark in panel.marks]
    margin = 0.0 if any(isinstance(mark, (Curve, Band, Stack, Map))
                        for panel in panels for mark in panel.marks) else MARGIN
    return _padded(found, scale, margin)


def vertical_range(panel):
    """Return (bottom, top) of a panel."""
    if panel.y_range:
        return panel.y_range
    found = [_vertical(mark) for mark in panel.marks]
    only_map = any(isinstance(mark, Map) for mark in panel.marks)
    return _padded(found, panel.y_scale, 0.0 if only_map else MARGIN)


def equal_ranges(panel, shape):
    """
    Return (left, right) and (bottom, top) of a panel whose axes have the same scale.

    ``shape`` is the width of the panel divided by its height.
    """
    x_range, y_range = horizontal_range((panel,)), vertical_range(panel)
    per_height = max((x_range[1] - x_range[0]) * (1.0 + 2.0 * MARGIN) / shape,
                     y_range[1] - y_range[0])
    return tuple((middle - half, middle + half) for middle, half in (
        (0.5 * sum(x_range), 0.5 * shape * per_height), (0.5 * sum(y_range), 0.5 * per_height)))


def _horizontal(mark):
    if isinstance(mark, Level):
        return [] if mark.x is None else [mark.x]
    if isinstance(mark, Stretch):
        return []
    if isinstance(mark, Bars):
        return np.append(mark.values, 0.0)
    return map_edges(mark.x) if isinstance(mark, Map) else mark.x


def _vertical(mark):
    if isinstance(mark, Level):
        return [] if mark.y is None else [mark.y]
    if isinstance(mark, Stretch):
        return []
    if isinstance(mark, Bars):
        return [-0.6, len(mark.values) - 0.4]
    if isinstance(mark, Map):
        return map_edges(mark.y)
    if isinstance(mark, Band):
        return np.concatenate([mark.low, mark.high])
    if isinstance(mark, Stack):
        return np.append(np.sum(mark.parts, axis=1), 0.0)
    return mark.y


def map_edges(centres):
    """Return the outer edges (2,) of cells with evenly spaced centres."""
    centres = np.asarray(centres, dtype=float)
    half = 0.5 * (centres[1] - centres[0]) if len(centres) > 1 else 0.5
    return np.array([centres[0] - half, centres[-1] + half])


def _padded(found, scale, margin):
    low, high = np.inf, -np.inf
    for values in found:
        values = positive(values, scale)
        values = values[np.isfinite(values)]
        if values.size:
            low, high = min(low, float(values.min())), max(high, float(values.max()))
    if low > high:
        return (0.1, 10.0) if scale == LOG else (0.0, 1.0)
    if scale == LOG:
        factor = (high / low) ** margin if high > low else 2.0
        return low / factor, high * factor
    room = margin * (high - low) if high > low else 0.5 * abs(low) or 1.0
    return low - room, high + room
